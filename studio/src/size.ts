// The chip on the board that says how wide the path is; another width makes the drawing another size, and leaves the
// picture as it is.

import { element, figure } from "../../src/report/html/player/svg.mjs";
import type { Point, Task } from "./messages";
import { boxOf } from "./task";

/** Pixels from the rim of the board, around what it keeps clear of, above the scale at the bottom, and of offers at the top. */
const [RIM, ROOM, LOWEST, OFFERS] = [9, 14, 34, 60];
/** Pixels from one place that is tried to the next; so many places of links weigh as much as a corner or a word. */
const [STEP, HEAVY] = [22, 20];

export class SizeChip {
  private field = element("input", {
    type: "number",
    min: "0",
    step: "any",
    id: "path-width",
    "aria-label": "Width of the path: another one makes the drawing larger or smaller",
  }) as HTMLInputElement;
  private words = element("span");
  private node = element("label", { class: "size-chip", hidden: "" }, [this.field, this.words]);
  private length = 0;

  /** `change` makes all lengths so many times as long. */
  constructor(
    private place: HTMLElement,
    change: (by: number) => void,
  ) {
    place.append(this.node);
    this.field.addEventListener("change", () => {
      const by = this.field.valueAsNumber / this.length;
      if (by > 1e-6 && by < 1e6) change(by);
      else this.field.value = figure(this.length, 4);
    });
  }

  /** Stands where the fewest of these pixels lie beneath, `marks` before `links`: in the corner where that is free, else
   * where it stands, if no place is better. */
  clearOf(marks: Point[], links: Point[]) {
    const { offsetLeft, offsetTop, offsetWidth: wide, offsetHeight: high } = this.node;
    const { clientWidth, clientHeight } = this.place;
    const within = (spots: Point[], [left, top]: Point, room: number) =>
      spots.filter(([x, y]) => x > left - room && x < left + wide + room && y > top - room && y < top + high + room)
        .length;
    const covered = (at: Point) => HEAVY * within(marks, at, ROOM) + within(links, at, ROOM / 2);
    const isDrawn = marks.length + links.length > 0 && wide > 0;
    const home: Point = [RIM, RIM];
    let best = isDrawn && covered(home) > 0 ? ([offsetLeft, offsetTop] as Point) : home;
    let least = isDrawn ? covered(best) : 0;
    const right = clientWidth - wide - RIM;
    for (const left of [RIM, right, right / 2])
      for (let top = RIM; least > 0 && top + high < clientHeight - (left > RIM ? RIM : LOWEST); top += STEP) {
        // The upper right corner is that of what the page offers.
        const count = left > RIM && top < OFFERS ? least : covered([left, top]);
        if (count < least) [best, least] = [[left, top], count];
      }
    Object.assign(this.node.style, { left: `${best[0]}px`, top: `${best[1]}px` });
  }

  show(task: Task) {
    const [left, low, right, high] = boxOf(task.points) ?? [0, 0, 0, 0];
    const isWide = right - left >= 1e-3 * (high - low);
    this.length = isWide ? right - left : high - low;
    this.node.hidden = task.function !== undefined || task.points.length < 2 || !(this.length > 0);
    if (document.activeElement !== this.field) this.field.value = String(Number(this.length.toPrecision(4)));
    this.words.textContent = `${task.unit ? `${task.unit} ` : ""}${isWide ? "wide" : "high"}`;
  }
}
