// The chip on the board that says how wide the path is; another width makes the drawing another size, and leaves the
// picture as it is.

import { element, figure } from "../../src/report/html/player/svg.mjs";
import type { Task } from "./messages";
import { boxOf } from "./task";

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

  show(task: Task) {
    const [left, low, right, high] = boxOf(task.points) ?? [0, 0, 0, 0];
    const isWide = right - left >= 1e-3 * (high - low);
    this.length = isWide ? right - left : high - low;
    this.node.hidden = task.points.length < 2 || !(this.length > 0);
    if (document.activeElement !== this.field) this.field.value = String(Number(this.length.toPrecision(4)));
    this.words.textContent = `${task.unit ? `${task.unit} ` : ""}${isWide ? "wide" : "high"}`;
  }
}
