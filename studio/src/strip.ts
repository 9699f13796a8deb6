// The strip of candidates: small pictures that move, with their figures.

import { element, figure, setAll, shape } from "../../src/report/html/player/svg.mjs";
import { Figure, Moving } from "./figures";
import type { Point, Shown } from "./messages";

const [W, H] = [150, 96];

const WORDS: Record<string, string> = {
  type: "type",
  transmission_deg_min: "transmission angle",
  link_ratio_max: "link ratio",
  pivots_in: "pivots",
  tolerance: "tolerance",
  order: "order of the points",
  branch: "toggle between the points",
  circuit: "two circuits",
};

export const inWords = (shown: Shown) => (shown.accepted ? "meets everything" : `not met: ${shown.unmet.map((key) => WORDS[key] ?? key).join(", ") || "a defect"}`);

/** One card of the strip. */
class Card {
  private picture = new Figure(0.55);
  private svg = shape("svg", { class: "stage", viewBox: `0 0 ${W} ${H}`, width: W, height: H, "aria-hidden": "true" });
  private target = shape("path", { class: "target-line" });
  private title = element("strong");
  private figures = element("span", { class: "figures" });
  private verdict = element("span", { class: "verdict" });
  readonly pick = element("button", { type: "button", class: "pick" }, [this.svg, this.title, this.figures, this.verdict]);
  readonly pin = element("button", { type: "button", class: "pin-button" });
  readonly node = element("li", {}, [this.pick, this.pin]);

  constructor(onPick: () => void, onPin: () => void) {
    this.svg.append(this.target, this.picture.group);
    this.pick.addEventListener("click", onPick);
    this.pin.addEventListener("click", onPin);
  }

  show(moving: Moving, name: string, unit: string | undefined, chosen: boolean, pinned: boolean, points: Point[], closed: boolean) {
    const { shown } = moving;
    const box = moving.box();
    const [w, h] = [box[2] - box[0] || 1, box[3] - box[1] || 1];
    const scale = Math.min((W - 16) / w, (H - 16) / h);
    const toward = ([x, y]: Point): Point => [W / 2 + (x - (box[0] + box[2]) / 2) * scale, H / 2 - (y - (box[1] + box[3]) / 2) * scale];
    const line = points.map(toward);
    setAll(this.target, { d: line.length === 0 ? "" : `M${line.map((p) => `${p[0].toFixed(1)} ${p[1].toFixed(1)}`).join("L")}${closed ? "Z" : ""}` });
    this.picture.show(moving, toward);
    const length = unit ? ` ${unit}` : "";
    this.title.textContent = name;
    this.figures.textContent = `rms ${figure(shown.rms, 3)}${length}, at most ${figure(shown.max, 3)}${length}; ${shown.type}, ${figure(shown.transmission_deg, 3)}°`;
    this.verdict.textContent = inWords(shown);
    this.verdict.classList.toggle("good", shown.accepted);
    setAll(this.pick, { "aria-pressed": String(chosen) });
    this.pin.textContent = pinned ? "Unpin" : "Pin";
    setAll(this.pin, { "aria-label": `${pinned ? "Unpin" : "Pin"} ${name.toLowerCase()}` });
  }

  pose(part: number) {
    this.picture.pose(part);
  }
}

export class Strip {
  private cards: Card[] = [];
  private count = 0;

  constructor(private list: HTMLElement, private pick: (index: number) => void, private pin: (index: number) => void) {}

  /** Shows candidates, then what is pinned. */
  show(all: Moving[], found: number, chosen: number, unit: string | undefined, points: Point[], closed: boolean) {
    while (this.cards.length < all.length) {
      const i = this.cards.length;
      this.cards.push(new Card(() => this.pick(i), () => this.pin(i)));
    }
    all.forEach((moving, i) => {
      const name = i < found ? `Linkage ${i + 1}` : `Pinned ${i - found + 1}`;
      this.cards[i].show(moving, name, unit, i === chosen, i >= found, points, closed);
    });
    if (this.count !== all.length || this.list.childElementCount !== all.length) {
      this.list.replaceChildren(...this.cards.slice(0, all.length).map((card) => card.node));
    }
    this.count = all.length;
  }

  pose(part: number) {
    for (let i = 0; i < this.count; i += 1) this.cards[i].pose(part);
  }
}
