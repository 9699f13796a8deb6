// What turns the linkage: a weight at P, springs that two clicks draw, and under the board the torque on the crank.

import { inputAt } from "../../src/report/html/player/drive.mjs";
import { element, pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import type { Host } from "./desk";
import { ticks } from "./graph";
import type { Page } from "./kit";
import { type Point, pivotsOf } from "./messages";
import type { Loaded, SpringAsk } from "./wire";

type End = SpringAsk["ends"][number];

const DEGREES = 180 / Math.PI;
/** Pixels beside the chart. */
const [LEFT, RIGHT, TOP, BOTTOM] = [58, 14, 22, 24];
/** A click as near to a joint takes it, pixels. */
const NEAR = 16;
/** The distance of the turns of a spring as it is drawn, and half their width, pixels. */
const [TURN, WIDTH] = [7, 6];
/** The number fields: under which they are kept, their labels and units. */
const FIELDS = [
  ["weight_kg", "Weight at P", "kg"],
  ["rpm", "Crank turns", "1/min"],
] as const;

export class LoadsPanel {
  readonly place = element("details", { id: "loads" }, [element("summary", {}, ["Weight, springs, torque"])]);
  private fields = FIELDS.map(
    ([id]) => element("input", { type: "number", id, step: "any", placeholder: "0" }) as HTMLInputElement,
  );
  private rows = element("div");
  private add = element("button", { id: "add-spring" }, ["Add a spring"]) as HTMLButtonElement;
  private words = element("p", { id: "torque-words", class: "note" });
  private svg = shape("svg", {
    class: "stage graph",
    role: "img",
    "aria-label": "The torque on the crank over its angle",
  });
  private chart = element("div", { id: "torque" }, [this.svg]);
  private cursor = shape("path", { class: "cursor" });
  private drawn = shape("g", { class: "springs" });
  private springs: SpringAsk[] = [];
  private torque: Point[][] = [];
  private range: [number, number] = [0, 360];
  private part = 0;
  private key = "";
  /** The first end of a spring that is being drawn. */
  private first: End | null = null;
  private isPicking = false;

  constructor(
    private host: Host,
    private page: Page,
    private changed: () => void,
  ) {
    const rows = FIELDS.map(([, label, unit], i) =>
      element("label", {}, [
        label,
        " ",
        element("span", { class: "field" }, [this.fields[i], element("span", {}, [unit])]),
      ]),
    );
    this.place.append(element("div", { class: "sizes" }, rows), this.rows, this.add, this.words);
    for (const field of this.fields) field.addEventListener("input", () => this.changed());
    this.place.addEventListener("toggle", () => this.changed());
    this.add.addEventListener("click", () => this.pick(!this.isPicking));
    const { board } = page;
    board.svg.append(this.drawn);
    // Before the tools of the board, which take every other click.
    const take = (event: PointerEvent) => this.isPicking && this.take(event);
    board.svg.addEventListener("pointerdown", take, true);
    document.addEventListener("keydown", (event: KeyboardEvent) => event.key === "Escape" && this.pick(false));
    new ResizeObserver(() => this.draw()).observe(this.chart);
  }

  /** What is kept with the sizes. */
  get kept(): Record<string, string> {
    const numbers = FIELDS.map(([id], i) => [id, this.fields[i].value]);
    return { ...Object.fromEntries(numbers), springs: this.springs.length > 0 ? JSON.stringify(this.springs) : "" };
  }

  set kept(kept: Record<string, string>) {
    FIELDS.forEach(([id], i) => {
      this.fields[i].value = kept[id] ?? "";
    });
    try {
      this.springs = JSON.parse(kept.springs || "[]") as SpringAsk[];
    } catch {
      this.springs = [];
    }
    (this.place as HTMLDetailsElement).open = Object.keys(kept).some(
      (id) => kept[id] && (id === "springs" || id === "weight_kg"),
    );
    this.list();
  }

  private get isOpen(): boolean {
    return (this.place as HTMLDetailsElement).open && this.place.isConnected && this.place.offsetParent !== null;
  }

  /** Asks for the torque of the linkage that is chosen, if the panel is in sight. */
  async show() {
    const chosen = this.host.chosen();
    this.place.hidden = !chosen;
    if (!(this.isOpen && chosen)) this.chart.remove();
    this.pose();
    if (!chosen || !this.isOpen) return;
    const [weight_kg, rpm] = this.fields.map(({ valueAsNumber }) => valueAsNumber || 0);
    const ask = { of: api.drawn(chosen), weight_kg, rpm, springs: this.springs };
    const key = JSON.stringify(ask);
    if (key === this.key) return this.placeChart();
    this.key = key;
    let found: Loaded = { words: "", torque: [] };
    try {
      found = await api.loaded(ask);
    } catch (error) {
      found.words = api.wordsOf(error);
    }
    if (this.key !== key) return;
    this.words.textContent = found.words;
    this.torque = found.torque as Point[][];
    this.placeChart();
    this.draw();
  }

  /** The chart stands under the board while there is a torque to see: nobody else meets a second drawing there. */
  private placeChart() {
    if (this.torque.length === 0 || !this.isOpen) return this.chart.remove();
    if (!this.chart.isConnected) document.getElementById("stage")?.after(this.chart);
  }

  /** Begins a spring, or gives it up. */
  private pick(on: boolean) {
    this.isPicking = on;
    this.first = null;
    this.add.textContent = on ? "Click its two ends on the board (Esc: no spring)" : "Add a spring";
    this.add.setAttribute("aria-pressed", String(on));
  }

  private take(event: PointerEvent) {
    if (event.button !== 0) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const end = this.endAt(this.page.board.at(event));
    if (!this.first) {
      this.first = end;
      return;
    }
    const ends: [End, End] = [this.first, end];
    this.pick(false);
    const [one, other] = ends.map((of) => this.placeOf(of));
    if (!one || !other || JSON.stringify(ends[0]) === JSON.stringify(ends[1])) return;
    const length = Number(Math.hypot(one[0] - other[0], one[1] - other[1]).toPrecision(3));
    this.springs = [...this.springs, { ends, rate_N_per_mm: 1, free_length: length }];
    this.list();
    this.changed();
  }

  /** The joints by their names, where they stand now. */
  private joints(): [string, Point][] {
    const { moving } = this.page.board;
    const joints = moving?.cycle.at(moving.at(this.part));
    if (!moving || !joints) return [];
    const { linkage, track } = moving.shown;
    const pivots = pivotsOf(linkage);
    const places = (joints as { places?: Point[] }).places;
    if (track && places) return track.names.map((name, i): [string, Point] => [name, places[i]]);
    const { C, D, P } = joints as unknown as Record<string, Point>;
    const fixed = pivots.map((at, i): [string, Point] => ["AB"[i], at]);
    return [...fixed, ["C", C], ["D", D], ["P", P]];
  }

  private endAt(point: Point): End {
    const { board } = this.page;
    const [x, y] = board.toPixel(point);
    const far = ([, at]: [string, Point]) => {
      const [px, py] = board.toPixel(at);
      return Math.hypot(px - x, py - y);
    };
    const nearest = this.joints().sort((one, other) => far(one) - far(other))[0];
    return nearest && far(nearest) < NEAR ? { joint: nearest[0] } : { point };
  }

  private placeOf(end: End): Point | undefined {
    if ("point" in end) return end.point as Point;
    return this.joints().find(([name]) => name === end.joint)?.[1];
  }

  /** The rows of the springs. */
  private list() {
    const unit = this.host.task().unit ?? "";
    const name = (end: End) =>
      "joint" in end ? end.joint : `(${(end.point as Point).map((x) => Number(x.toPrecision(3))).join(", ")})`;
    this.rows.replaceChildren(
      ...this.springs.map((spring, i) => {
        const field = (key: "rate_N_per_mm" | "free_length", label: string, of: string) => {
          const input = element("input", {
            type: "number",
            min: "0",
            step: "any",
            "aria-label": label,
          }) as HTMLInputElement;
          input.value = String(spring[key]);
          input.addEventListener("input", () => {
            if (!(input.valueAsNumber >= 0)) return;
            spring[key] = input.valueAsNumber;
            this.changed();
          });
          return element("span", { class: "field" }, [input, element("span", {}, [of])]);
        };
        const drop = element("button", { class: "drop", "aria-label": `Take spring ${i + 1} away` }, ["×"]);
        drop.addEventListener("click", () => {
          this.springs = this.springs.filter((one) => one !== spring);
          this.list();
          this.changed();
        });
        return element("div", { class: "row spring" }, [
          `${spring.ends.map(name).join(" to ")}: `,
          field("rate_N_per_mm", `Rate of spring ${i + 1}`, "N/mm"),
          field("free_length", `Free length of spring ${i + 1}`, `${unit} free`),
          drop,
        ]);
      }),
    );
    this.pose();
  }

  /** Another pose of the linkage: the springs and the cursor follow. */
  posed(part: number) {
    this.part = part;
    this.pose();
  }

  private pose() {
    const isSeen = this.isOpen;
    if (!isSeen) {
      this.drawn.replaceChildren();
      return;
    }
    const { board } = this.page;
    const lines = this.springs.flatMap(({ ends }) => {
      const [from, to] = ends.map((end) => this.placeOf(end));
      return from && to ? [pathThrough(coils(board.toPixel(from), board.toPixel(to)))] : [];
    });
    this.drawn.replaceChildren(...lines.map((d) => shape("path", { d })));
    const { moving } = board;
    if (!moving || this.torque.length === 0) return setAll(this.cursor, { d: "" });
    const deg = inputAt(moving.cycle.drive, moving.at(part(this.part))).angle * DEGREES;
    const [low, high] = this.range;
    const turned = deg - 360 * Math.floor((deg - low) / 360);
    const x = px(this.x(turned));
    return setAll(this.cursor, { d: turned <= high ? `M${x} ${TOP}V${px(this.chart.clientHeight - BOTTOM)}` : "" });
  }

  private x(deg: number): number {
    const [low, high] = this.range;
    return LEFT + ((deg - low) / (high - low)) * (this.chart.clientWidth - LEFT - RIGHT);
  }

  private draw() {
    const [width, height] = [this.chart.clientWidth, this.chart.clientHeight];
    if (width < 80 || height < 60) return;
    setAll(this.svg, { viewBox: `0 0 ${width} ${height}`, width, height });
    const all = this.torque.flat();
    const [degs, values] = [all.map(([deg]) => deg), [0, ...all.map(([, torque]) => torque)]];
    this.range = all.length > 0 ? [Math.min(...degs), Math.max(...degs)] : [0, 360];
    const [least, most] = [Math.min(...values), Math.max(...values)];
    const room = Math.max(0.06 * (most - least), 1e-9);
    const [low, high] = [least - room, most + room];
    const y = (torque: number) => TOP + ((high - torque) / (high - low)) * (height - TOP - BOTTOM);
    const words = (x: number, at: number, text: string, kind: string) =>
      shape("text", { class: `tick ${kind}`, x: px(x), y: px(at) }, [text]);
    const rule = (at: number, name: string) =>
      shape("path", { class: name, d: `M${LEFT} ${px(y(at))}H${width - RIGHT}` });
    this.svg.replaceChildren(
      ...ticks(low, high, Math.max((height - TOP - BOTTOM) / 22, 2)).flatMap((value) => [
        rule(value, value === 0 ? "zero" : "grid"),
        words(LEFT - 6, y(value) + 4, String(value), "left"),
      ]),
      ...ticks(...this.range, Math.max((width - LEFT - RIGHT) / 70, 2)).map((deg) =>
        words(this.x(deg), height - 8, `${deg}°`, "middle"),
      ),
      words(LEFT, TOP - 8, "torque on the crank, N m", ""),
      ...this.torque.map((strand) =>
        shape("path", { class: "curve", d: pathThrough(strand.map(([deg, torque]) => [this.x(deg), y(torque)])) }),
      ),
      this.cursor,
    );
    this.pose();
  }
}

const part = (of: number) => ((of % 1) + 1) % 1;

/** A spring between two places, pixels. */
function coils([x, y]: Point, [toX, toY]: Point): Point[] {
  const length = Math.hypot(toX - x, toY - y) || 1;
  const [ux, uy] = [(toX - x) / length, (toY - y) / length];
  const at = (along: number, across: number): Point => [
    x + ux * along * length - uy * across,
    y + uy * along * length + ux * across,
  ];
  const turns = Math.max(Math.round((0.6 * length) / TURN), 5);
  const zigzag = Array.from({ length: turns }, (_, i) =>
    at(0.2 + (0.6 * (i + 0.5)) / turns, i % 2 === 0 ? WIDTH : -WIDTH),
  );
  return [at(0, 0), at(0.2, 0), ...zigzag, at(0.8, 0), at(1, 0)];
}
