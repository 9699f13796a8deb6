// The keys of the board: a point or a corner is chosen, moved and removed, the view and the tolerance changed.

import { figure } from "../../src/report/html/player/svg.mjs";
import { inWords as cornerInWords, cornerOf, LEAST, nextCorner, resized } from "./boxes";
import { more } from "./kit";
import { unitAfter } from "./labels";
import type { Hand, Surface } from "./surface";
import { sizeOf, toleranceAt } from "./task";

export class Keys {
  constructor(
    private on: Surface,
    private hand: Hand,
    private say: (text: string) => void,
  ) {}

  press(event: KeyboardEvent) {
    const { task } = this.on;
    if (!task || event.ctrlKey || event.metaKey || event.altKey) return;
    const n = task.points.length;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
    const step = (event.shiftKey ? 20 : 4) / this.on.looking.scale;
    if (event.key === "," || event.key === ".") {
      this.on.corner = null;
      this.on.selected = n === 0 ? -1 : (this.on.selected + (event.key === "." ? 1 : -1) + n) % n;
      this.on.redraw();
      this.tellPoint();
    } else if (event.key === "b" || event.key === "B") {
      this.on.corner = nextCorner(task, this.on.corner) ?? nextCorner(task, null);
      this.on.selected = -1;
      this.on.redraw();
      this.tellCorner();
    } else if ((event.key === "Delete" || event.key === "Backspace") && this.on.corner) {
      this.hand.grasp();
      this.say(`${cornerInWords(this.on.corner).replace(/,.*/, "")} removed.`);
      this.hand.box(this.on.corner.kind, null, true);
    } else if ((event.key === "Delete" || event.key === "Backspace") && this.on.selected >= 0) {
      this.say(`Point ${this.on.selected} removed; ${n - 1} are left.`);
      this.hand.remove(this.on.selected);
    } else if (event.key === "+" || event.key === "-") {
      this.on.zoom(event.key === "+" ? 1.25 : 0.8);
    } else if ((event.key === "[" || event.key === "]") && n > 0) {
      const index = Math.max(this.on.selected, 0);
      const now = toleranceAt(task, index) || 0.01 * sizeOf(task.points);
      if (event.key === "[" && toleranceAt(task, index) === 0) return;
      this.hand.grasp();
      this.hand.tolerance(index, now * (event.key === "]" ? 1.25 : 0.8), true);
      this.tellTolerance(index);
    } else if (way && this.on.corner) {
      const box = task[this.on.corner.kind];
      if (!box) return;
      const [x, y] = cornerOf(box, this.on.corner.corner);
      this.hand.grasp();
      this.hand.box(
        this.on.corner.kind,
        resized(box, this.on.corner.corner, [x + way[0] * step, y + way[1] * step], LEAST / this.on.looking.scale),
        true,
      );
      this.tellCorner();
    } else if (way && this.on.selected >= 0) {
      const [x, y] = task.points[this.on.selected];
      this.hand.grasp();
      this.hand.drag(this.on.selected, [x + way[0] * step, y + way[1] * step], true);
      this.tellPoint();
    } else if (!more.kit?.press(event)) return;
    event.preventDefault();
  }

  private tellCorner() {
    const box = this.on.corner && this.on.task?.[this.on.corner.kind];
    if (!this.on.corner || !box) return this.say("There is no box: tick one among the requirements.");
    const [x, y] = cornerOf(box, this.on.corner.corner);
    return this.say(`${cornerInWords(this.on.corner)} at ${figure(x, 4)}, ${figure(y, 4)}`);
  }

  private tellTolerance(index: number) {
    const { task } = this.on;
    if (!task) return;
    const where = task.tolerances ? `at point ${index}` : "at every point";
    this.say(`Largest error ${where}: ${figure(toleranceAt(task, index) ?? 0, 3)}${unitAfter(task.unit)}`);
  }

  private tellPoint() {
    const p = this.on.task?.points[this.on.selected];
    if (p) this.say(`Point ${this.on.selected} at ${figure(p[0], 4)}, ${figure(p[1], 4)}`);
  }
}
