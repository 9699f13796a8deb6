// The linkage that the hand has changed: what it is now, its figures, its locks, and what can be done with it.

import { element, figure } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import {
  dragged,
  groundAngle,
  type Joint,
  keptBy,
  LENGTHS,
  type Linkage,
  type Lock,
  lengthOf,
  ofPose,
  type Pose,
  roundedTo,
} from "./grab";
import { fourBarOf, type Shown, type Solution, type Task } from "./messages";
import { inWords } from "./strip";
import { sizeOf } from "./task";
import { nearnessInWords, SIGNS, transmissionInWords } from "./words";

const NAMES: Record<Lock, string> = {
  a: "a, crank AC",
  b: "b, coupler CD",
  c: "c, follower BD",
  d: "d, C to P",
  e: "e, D to P",
  ground: "ground AB",
  A: "pivot A",
  B: "pivot B",
  ground_angle_deg: "direction of AB",
};
/** Half a millimetre in the units of lengths; without a unit a length counts as one of a millimetre. */
const HALVES: Record<string, number> = { mm: 0.5, cm: 0.05, m: 0.0005, in: 1 / 64 };

export interface HandHost {
  task(): Task;
  /** What is in the hand has changed: another linkage, or none any more. */
  changed(): void;
  /** A step that can be undone is about to be made. */
  note(): void;
  /** Searches anew with what is locked. */
  fit(kept: Record<string, string>, from: Linkage): void;
  say(text: string): void;
}

export class ByHand {
  shown: Shown | null = null;
  private locks = new Set<Lock>();
  private wanted: Linkage | null = null;
  private isAsking = false;
  /** Counts what was taken into the hand: an answer about the one before is late. */
  private taken = 0;
  private title = element("strong");
  /** Whether it is another one than was taken. */
  isChanged = false;
  private quality = element("p", { class: "quality" });
  private rows = new Map<Lock, { field: HTMLInputElement | null; lock: HTMLInputElement }>();
  private round = element("button", { id: "hand-round" }, ["Round to 0.5 mm"]);

  constructor(
    private place: HTMLElement,
    private host: HandHost,
  ) {
    const head = ["", "", "lock"].map((text) => element("th", { scope: "col" }, [text]));
    const table = element("table", { class: "lengths" }, [
      element("thead", {}, [element("tr", {}, head)]),
      element("tbody", {}, this.makeRows()),
    ]);
    const button = (id: string, text: string, act: () => void) => {
      const made = element("button", { id }, [text]);
      made.addEventListener("click", act);
      return made;
    };
    this.round.addEventListener("click", () => this.toHalves());
    const buttons = element("div", { class: "row" }, [
      this.round,
      button("hand-fit", "Fit the rest again", () => this.fit()),
      button("hand-drop", "Let go", () => {
        host.note();
        this.take(null);
      }),
    ]);
    place.append(this.title, this.quality, table, buttons);
  }

  private makeRows() {
    return (["A", "B", ...LENGTHS, "ground_angle_deg"] as Lock[]).map((name) => {
      const lock = element("input", { type: "checkbox", "aria-label": `Lock ${NAMES[name]}` }) as HTMLInputElement;
      lock.addEventListener("change", () => {
        if (lock.checked) this.locks.add(name);
        else this.locks.delete(name);
      });
      const isLength = name.length === 1 && name >= "a";
      const field = isLength
        ? (element("input", { type: "number", min: "0", step: "any", "aria-label": NAMES[name] }) as HTMLInputElement)
        : null;
      field?.addEventListener("change", () => {
        if (!this.linkage || !(field.valueAsNumber > 0)) return this.show();
        this.host.note();
        return this.ask({ ...this.linkage, [name]: field.valueAsNumber });
      });
      const figures = field ?? element("span", { "data-figures": name });
      this.rows.set(name, { field, lock });
      return element("tr", {}, [
        element("th", { scope: "row" }, [NAMES[name]]),
        element("td", {}, [figures]),
        element("td", {}, [lock]),
      ]);
    });
  }

  /** The four-bar in the hand: no other kind is taken. */
  private get linkage(): Linkage | null {
    return this.shown && fourBarOf(this.shown.linkage);
  }

  /** Takes a linkage into the hand; null lets it go. */
  take(shown: Shown | null, isChanged = false) {
    this.shown = shown;
    this.wanted = null;
    this.taken += 1;
    this.isChanged = isChanged;
    if (!shown) {
      this.locks.clear();
      for (const { lock } of this.rows.values()) lock.checked = false;
    }
    this.show();
    this.host.changed();
    if (shown) this.place.scrollIntoView({ block: "nearest" });
  }

  /** A joint is dragged from a pose to a place. */
  drag(pose: Pose, joint: Joint, to: [number, number]) {
    this.ask(ofPose(dragged(pose, joint, to, this.locks)));
  }

  /** The target or what is asked has changed: it is judged anew. */
  again() {
    if (this.linkage) this.ask(this.linkage);
  }

  /** Asks the studio what it makes of a linkage; of several that wait the latest counts. */
  private ask(linkage: Linkage) {
    this.wanted = linkage;
    if (!this.isAsking) void this.answer();
  }

  private async answer() {
    this.isAsking = true;
    while (this.wanted) {
      const linkage: Linkage = this.wanted;
      this.wanted = null;
      const { taken } = this;
      try {
        const shown = await api.judged(this.host.task(), linkage);
        if (taken !== this.taken || !this.shown) continue;
        this.isChanged ||= JSON.stringify(shown.linkage) !== JSON.stringify(this.shown.linkage);
        this.shown = shown;
        this.show();
        this.host.changed();
      } catch (error) {
        this.host.say(`So it is no linkage: ${api.wordsOf(error)}.`);
        this.show();
      }
    }
    this.isAsking = false;
  }

  private toHalves() {
    if (!this.linkage) return;
    this.host.note();
    this.ask(roundedTo(this.linkage, HALVES[this.host.task().unit ?? "mm"], this.locks));
  }

  private fit() {
    const { linkage } = this;
    if (!linkage) return;
    if (this.host.task().mechanism?.includes("four-bar") === false)
      return this.host.say("Four-bars are not asked for: choose them under Kind of linkage first.");
    if (this.locks.size === 0) return this.host.say("Lock what is to stay: the rest is fitted again around it.");
    const kept = keptBy(linkage, this.locks);
    this.host.note();
    this.take(null);
    this.host.fit(kept, linkage);
  }

  private show() {
    const { shown, linkage } = this;
    this.place.hidden = !shown;
    if (!shown || !linkage) return;
    const { unit, points } = this.host.task();
    this.title.textContent = this.isChanged ? "Changed by hand" : "In your hand";
    this.round.textContent = unit === "in" ? "Round to 1/64 in" : "Round to 0.5 mm";
    const graded = [nearnessInWords(shown, sizeOf(points)), transmissionInWords(shown.transmission_deg)];
    this.quality.replaceChildren(
      ...graded.map(({ grade, text }) => element("span", { class: grade }, [`${SIGNS[grade]} ${text}`])),
      element("span", {}, [`${shown.type}; ${inWords(shown)}`]),
    );
    for (const [name, { field }] of this.rows) {
      if (field && document.activeElement !== field) field.value = String(Number(linkage[name as "a"].toPrecision(5)));
    }
    for (const span of this.place.querySelectorAll<HTMLElement>("[data-figures]"))
      span.textContent = figuresOf(linkage, span.dataset.figures as Lock);
  }

  solution(): Solution | null {
    return this.shown && { shown: this.shown, task: this.host.task() };
  }
}

/** What has no field of its own, in figures: a place, the distance of the pivots, their direction. */
function figuresOf(linkage: Linkage, name: Lock): string {
  if (name === "A" || name === "B") return linkage[name].map((x) => figure(x, 5)).join(", ");
  return name === "ground_angle_deg" ? `${figure(groundAngle(linkage), 4)}°` : figure(lengthOf(linkage, "ground"), 5);
}
