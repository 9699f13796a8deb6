// The chip on the board that says how wide the path is; another width makes the drawing another size, and leaves the
// picture as it is.

import { element, figure } from "../../src/report/html/player/svg.mjs";
import type { Point, Task } from "./messages";
import { boxOf } from "./task";

/** Pixels from the upper rim of the board, and around what it keeps clear of. */
const [TOP, ROOM] = [9, 14];

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
  constructor(place: HTMLElement, change: (by: number) => void) {
    place.append(this.node);
    this.field.addEventListener("change", () => {
      const by = this.field.valueAsNumber / this.length;
      if (by > 1e-6 && by < 1e6) change(by);
      else this.field.value = figure(this.length, 4);
    });
  }

  /** Stands at the rim of the board where none of these pixels lies beneath; at the top if there is no such place. */
  clearOf(spots: Point[]) {
    const { offsetLeft: left, offsetWidth: wide, offsetHeight: high } = this.node;
    const isClear = (top: number) =>
      spots.every(([x, y]) => x < left - ROOM || x > left + wide + ROOM || y < top - ROOM || y > top + high + ROOM);
    const steps = spots.length > 0 && wide > 0 ? [0, 1, 2, 3, 4, 5] : [];
    const step = steps.find((i) => isClear(TOP + i * (high + ROOM))) ?? 0;
    this.node.style.top = step > 0 ? `${TOP + step * (high + ROOM)}px` : "";
  }

  show(task: Task) {
    const [left, low, right, high] = boxOf(task.points) ?? [0, 0, 0, 0];
    const isWide = right - left >= 1e-3 * (high - low);
    this.length = isWide ? right - left : high - low;
    this.node.hidden = task.points.length < 2 || !(this.length > 0);
    if (document.activeElement !== this.field) this.field.value = String(Number(this.length.toPrecision(4)));
    this.words.textContent = `${task.unit ? `${task.unit} ` : ""}${isWide ? "wide" : "high"}`;
  }
}
