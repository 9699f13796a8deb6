// The report's player with one chart more, of the angles of the links: what the details show of a linkage of any kind.

import { CycleChart } from "../../src/report/html/player/chart.mjs";
import type { Cycle } from "../../src/report/html/player/cycle.mjs";
import { LoopsStage } from "../../src/report/html/player/loops.mjs";
import { Player } from "../../src/report/html/player/player.mjs";
import { element, figure, shape } from "../../src/report/html/player/svg.mjs";
import type { Linkage } from "./messages";

interface Sample {
  q: number;
  joints: { C: number[]; D: number[]; u?: number[] };
  coupler?: number;
  follower?: number;
}

const degrees = (from: number[], to: number[]) => (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI;
const near = (angle: number, other: number) => angle + 360 * Math.round((other - angle) / 360);

/** The player of a linkage of any kind. */
export class AnglesPlayer extends Player {
  declare angles: CycleChart;
  /** What the chart calls the follower, which a linkage with a slider has not. */
  declare followerKey: Element;

  constructor(stage: HTMLElement, charts: HTMLElement, options: object) {
    super(stage, charts, { ...options, Stage: LoopsStage } as never);
  }

  makeCharts(place: HTMLElement, unit: string | null) {
    super.makeCharts(place, unit);
    const read = (s: Sample) => {
      this.place(s);
      return [s.follower, s.coupler].flatMap((deg) => (Number.isFinite(deg) ? `${figure(deg, 4)}°` : [])).join(", ");
    };
    const line = (kind: string, of: (s: Sample) => number | undefined) => ({ name: kind, kind, of });
    this.angles = new CycleChart(place, {
      title: "Angles of the links",
      height: 150,
      onPick: (q: number) => {
        this.pause();
        this.moveTo(q);
      },
      lines: [
        line("main", (s) => s.follower),
        line("along-x", (s) => s.coupler),
        line("along-y", (s) => (this.cycle as Cycle).crankDeg(s.q)),
      ],
      read,
    } as never);
    const key = (kind: string, text: string) =>
      element("span", { class: "key" }, [
        shape("svg", { class: "chart", width: 18, height: 8, "aria-hidden": "true" }, [
          shape("path", { class: `line ${kind}`, d: "M0 4h18" }),
        ]),
        text,
      ]);
    this.followerKey = key("main", "follower");
    place.append(
      element("p", { class: "chart-note" }, [
        element("span", { class: "keys" }, [this.followerKey, key("along-x", "coupler"), key("along-y", "input")]),
      ]),
    );
  }

  show(mechanism: unknown) {
    super.show(mechanism as never);
    let last: Sample | null = null;
    for (const sample of this.samples as unknown as (Sample | null)[]) {
      if (sample) this.turn(sample, last);
      last = sample ?? last;
    }
    this.followerKey.classList.toggle("absent", this.linkage.kind !== undefined);
    this.angles.show(this.cycle as Cycle, this.samples as never);
    this.moveTo(this.q);
  }

  private get linkage(): Linkage {
    return (this.cycle as Cycle).mechanism.linkage as Linkage;
  }

  /** The angles at a sample, without a jump from the one before. */
  private turn(sample: Sample, before: Sample | null) {
    const { kind, B } = this.linkage;
    const { C, D, u } = sample.joints;
    const coupler = u ? degrees([0, 0], u) : degrees(C, D);
    const follower = kind || !B ? Number.NaN : degrees(B, D);
    sample.coupler = before ? near(coupler, before.coupler as number) : coupler;
    sample.follower = before ? near(follower, before.follower as number) : follower;
  }

  moveTo(q: number) {
    super.moveTo(q);
    if (!this.angles || !this.cycle) return;
    const sample = this.cycle.sample(this.q) as unknown as Sample | null;
    if (sample && this.place(sample)) this.angles.at(this.q, sample);
  }

  /** The angles of a sample, as they lie on the curves of the chart; false where there are none. */
  private place(sample: Sample): boolean {
    const around = (this.samples as unknown as (Sample | null)[]).filter(
      (s) => s && s.coupler !== undefined,
    ) as Sample[];
    if (around.length === 0) return false;
    this.turn(
      sample,
      around.reduce((best, s) => (Math.abs(s.q - sample.q) < Math.abs(best.q - sample.q) ? s : best)),
    );
    return true;
  }
}
