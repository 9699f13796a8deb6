// The board: the target under the hand, the linkage over it.

import { figure, pathThrough, px, roundLength, setAll, shape } from "../../src/report/html/player/svg.mjs";
import {
  type BoxKind,
  between,
  boxShapes,
  type Corner,
  inWords as cornerInWords,
  cornerOf,
  nextCorner,
  resized,
} from "./boxes";
import { Figure, type Moving } from "./figures";
import type { Box, Point, Task } from "./messages";
import { dragging, type Grip, watchPointers } from "./pointers";
import { ofStroke, segmentAt } from "./target";
import { sizeOf, toleranceAt } from "./task";
import type { Underlay } from "./underlay";

/** A click so near to the path, in pixels, is meant for it. */
const NEAR = 9;

export type Tool = "draw" | "points" | BoxKind | "photo-move" | "photo-scale";

export interface Hand {
  /** A new target was drawn. */
  drawn(points: Point[], closed: boolean): void;
  /** A point is about to be moved, or the box. */
  grasp(): void;
  /** What was done since then is given up. */
  letGo(): void;
  /** A point is being moved. */
  drag(index: number, to: Point, last: boolean): void;
  /** A point is added after another. */
  add(at: Point, after: number): void;
  remove(index: number): void;
  /** A box of the requirements is drawn, or a corner of it moves; null removes it. */
  box(kind: BoxKind, box: Box | null, last: boolean): void;
  /** The circle of a tolerance is made larger or smaller. */
  tolerance(index: number, radius: number, last: boolean): void;
  /** The photograph was clicked at an end of a known length. */
  marked(): void;
}

export class Board {
  readonly svg = shape("svg", {
    class: "stage board",
    tabindex: 0,
    role: "application",
    "aria-label":
      "The target. Comma and full stop choose a point, B a corner of a box; the arrow keys move it, Delete removes it; square brackets change the tolerance.",
  });
  private back = shape("g");
  private pins = shape("g", { class: "pinned" });
  private mechanism = new Figure();
  private marks = shape("g");
  private stroke = shape("path", { class: "stroke" });
  private boxGroup = shape("g");
  private sketch = shape("rect", { class: "pivot-box", visibility: "hidden" });
  private scaleBar = shape("g");
  private ghosts: Figure[] = [];
  private width = 600;
  private height = 420;
  private view = { x: 0, y: 0, scale: 2.4 };
  private task: Task | null = null;
  private moving: Moving | null = null;
  private pinned: Moving[] = [];
  private corner: Corner | null = null;
  private part = 0;
  /** Whether the view was chosen by hand. */
  touched = false;
  tool: Tool = "draw";
  selected = -1;

  constructor(
    private place: HTMLElement,
    private hand: Hand,
    private say: (text: string) => void,
    private underlay: Underlay,
  ) {
    this.svg.append(
      this.underlay.group,
      this.back,
      this.boxGroup,
      this.sketch,
      this.pins,
      this.mechanism.group,
      this.marks,
      this.stroke,
      this.scaleBar,
    );
    place.append(this.svg);
    watchPointers(
      this.svg,
      (event) => this.take(event),
      (one, other) => this.pinch(one, other),
    );
    this.svg.addEventListener(
      "wheel",
      (event: WheelEvent) => {
        event.preventDefault();
        this.touched = true;
        this.zoom(Math.exp(-event.deltaY / 400), this.at(event));
      },
      { passive: false },
    );
    this.svg.addEventListener("keydown", (event: KeyboardEvent) => this.key(event));
    new ResizeObserver(() => this.measure()).observe(place);
    this.measure();
  }

  private measure() {
    const width = Math.max(this.place.clientWidth, 240);
    const height = Math.max(Math.min(Math.round(width * (width < 500 ? 1 : 0.68)), innerHeight - 150, 720), 280);
    if (width === this.width && height === this.height) return;
    this.view.scale *= Math.min(width / this.width, height / this.height);
    Object.assign(this, { width, height });
    setAll(this.svg, { viewBox: `0 0 ${width} ${height}`, width, height });
    this.draw();
  }

  toPixel = ([x, y]: Point): Point => [
    this.width / 2 + (x - this.view.x) * this.view.scale,
    this.height / 2 - (y - this.view.y) * this.view.scale,
  ];

  private toPlane([x, y]: Point): Point {
    return [
      this.view.x + (x - this.width / 2) / this.view.scale,
      this.view.y - (y - this.height / 2) / this.view.scale,
    ];
  }

  private at(event: { clientX: number; clientY: number }): Point {
    const box = this.svg.getBoundingClientRect();
    return this.toPlane([
      ((event.clientX - box.left) * this.width) / box.width,
      ((event.clientY - box.top) * this.height) / box.height,
    ]);
  }

  zoom(by: number, around: Point = [this.view.x, this.view.y]) {
    const scale = Math.min(Math.max(this.view.scale * by, 1e-7), 1e7);
    const kept = this.view.scale / scale;
    this.view = {
      scale,
      x: around[0] + (this.view.x - around[0]) * kept,
      y: around[1] + (this.view.y - around[1]) * kept,
    };
    this.draw();
  }

  /** Brings target, linkage and pivot box into view. */
  fit() {
    const points = this.task?.points ?? [];
    const box = this.moving?.box() ?? [Infinity, Infinity, -Infinity, -Infinity];
    const all: Point[] = [...points, [box[0], box[1]], [box[2], box[3]]];
    for (const kept of [this.task?.pivots_in, this.task?.footprint_in])
      if (kept) all.push([kept[0], kept[1]], [kept[2], kept[3]]);
    this.touched = false;
    const finite = all.filter((p) => p.every(Number.isFinite));
    if (finite.length === 0) return;
    const [xs, ys] = [finite.map((p) => p[0]), finite.map((p) => p[1])];
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const size = Math.max(right - left, high - low, 1e-6);
    const scale = Math.min(
      (this.width - 70) / Math.max(right - left, size / 50),
      (this.height - 80) / Math.max(high - low, size / 50),
    );
    this.view = { x: (left + right) / 2, y: (low + high) / 2, scale };
    this.draw();
  }

  /** Whether the whole linkage is in view. */
  get holdsAll(): boolean {
    const box = this.moving?.box();
    if (!box?.every(Number.isFinite)) return true;
    const [[left, top], [right, bottom]] = [this.toPixel([box[0], box[3]]), this.toPixel([box[2], box[1]])];
    return left > 4 && top > 4 && right < this.width - 4 && bottom < this.height - 4;
  }

  /** What is in view. */
  get window(): Box {
    const [left, top] = this.toPlane([0, 0]);
    const [right, bottom] = this.toPlane([this.width, this.height]);
    return [left, bottom, right, top];
  }

  show(task: Task, moving: Moving | null, pinned: Moving[]) {
    this.task = task;
    this.moving = moving;
    this.pinned = pinned;
    if (this.selected >= task.points.length) this.selected = -1;
    if (this.corner && !task[this.corner.kind]) this.corner = null;
    this.draw();
  }

  redraw() {
    this.draw();
  }

  pose(part: number) {
    this.part = part;
    this.mechanism.pose(part);
    for (const ghost of this.ghosts) ghost.pose(part);
  }

  private draw() {
    const { task } = this;
    if (!task) return;
    const spots = task.points.map(this.toPixel);
    const closedLine = task.closed && spots.length > 2 ? [...spots, spots[0]] : spots;
    const many = spots.length > 24;
    this.underlay.draw(this.toPixel);
    const radii = spots.map((_, i) => (toleranceAt(task, i) ?? 0) * this.view.scale);
    const circles = spots.flatMap(([cx, cy], i) =>
      radii[i] > 1.5 ? [shape("circle", { class: "allowed", cx: px(cx), cy: px(cy), r: px(radii[i]) })] : [],
    );
    const empty =
      spots.length === 0
        ? [shape("text", { class: "invitation", x: px(this.width / 2), y: px(this.height / 2) }, ["Draw a path here"])]
        : [];
    this.back.replaceChildren(
      ...empty,
      ...circles,
      shape("path", { class: "target-line", d: pathThrough(closedLine) }),
    );
    const marks = spots.flatMap(([x, y], i) => {
      const [cx, cy] = [px(x), px(y)];
      const chosen = i === this.selected;
      const dot = shape("circle", {
        class: `target-point${i === 0 ? " first" : ""}${chosen ? " chosen" : ""}`,
        cx,
        cy,
        r: chosen ? 6.5 : many ? 3.4 : 5,
      });
      return [dot, shape("circle", { class: "handle", cx, cy, r: many ? 9 : 16, "data-point": i })];
    });
    // The rim of a circle can be drawn outwards and inwards where it does not lie on the point itself; the chosen one's lies on top.
    const rims = spots.flatMap(([x, y], i) => {
      if (!(i === this.selected || !many) || radii[i] <= 8) return [];
      return [
        shape("circle", {
          class: "rim",
          cx: px(x + radii[i] * Math.SQRT1_2),
          cy: px(y - radii[i] * Math.SQRT1_2),
          r: 5,
          "data-rim": i,
        }),
      ];
    });
    const top = rims.findIndex((rim) => rim.getAttribute("data-rim") === String(this.selected));
    if (top >= 0) rims.push(...rims.splice(top, 1));
    this.marks.replaceChildren(...marks, ...rims);
    while (this.ghosts.length < this.pinned.length) this.ghosts.push(new Figure(0.8));
    this.pins.replaceChildren(...this.pinned.map((_, i) => this.ghosts[i].group));
    this.pinned.forEach((moving, i) => {
      this.ghosts[i].show(moving, this.toPixel);
    });
    this.mechanism.show(this.moving, this.toPixel);
    this.drawBox();
    const length = roundLength((0.2 * this.width) / this.view.scale);
    const y = this.height - 14;
    this.scaleBar.replaceChildren(
      shape("path", { class: "scale", d: `M14 ${y - 4}v4h${px(length * this.view.scale)}v-4` }),
      shape("text", { class: "scale-text", x: px(22 + length * this.view.scale), y }, [
        `${Number(length.toPrecision(3))}${task.unit ? ` ${task.unit}` : ""}`,
      ]),
    );
    // Another view of one that stands still.
    this.pose(this.part);
  }

  private drawBox() {
    this.boxGroup.replaceChildren(...(this.task ? boxShapes(this.task, this.toPixel, this.corner) : []));
  }

  /** What a pointer that goes down here holds. */
  private take(event: PointerEvent): Grip | null {
    const target = event.target as Element;
    const [point, corner, rim] = ["point", "corner", "rim"].map((name) => target.getAttribute(`data-${name}`));
    this.svg.focus({ preventScroll: true });
    if (!this.task) return null;
    if (event.shiftKey) return this.pan(event);
    if (this.tool === "photo-move" && this.underlay.there) return this.moveUnderlay(event);
    if (this.tool === "photo-scale" && this.underlay.there) {
      this.underlay.mark(this.at(event));
      this.hand.marked();
      return null;
    }
    if (this.tool === "pivots_in" || this.tool === "footprint_in") return this.sketchBox(this.tool, this.at(event));
    if (corner) return this.resize(corner, event);
    if (rim !== null) return this.widen(Number(rim), event);
    if (point !== null) return this.carry(Number(point), event);
    return this.tool === "points" ? this.addPoint(event) : this.pen(event);
  }

  /** A grip that changes something from the first real movement on; what it had changed can be given up. */
  private changing(start: PointerEvent, step: Grip["step"]): Grip {
    return dragging(
      start,
      () => this.hand.grasp(),
      step,
      () => this.hand.letGo(),
    );
  }

  private pan(start: PointerEvent): Grip {
    const held = this.at(start);
    this.touched = true;
    const step = (event: PointerEvent) => {
      const now = this.at(event);
      this.view.x += held[0] - now[0];
      this.view.y += held[1] - now[1];
      this.draw();
    };
    return { step, abort: () => {} };
  }

  /** Two fingers hold two points of the plane. */
  private pinch(one: PointerEvent, other: PointerEvent) {
    const [p, q] = [this.at(one), this.at(other)];
    const apart = Math.max(Math.hypot(q[0] - p[0], q[1] - p[1]), 1e-9);
    this.touched = true;
    return (one: PointerEvent, other: PointerEvent) => {
      const now = [this.at(one), this.at(other)];
      this.zoom(Math.hypot(now[1][0] - now[0][0], now[1][1] - now[0][1]) / apart);
      const [a, b] = [this.at(one), this.at(other)];
      this.view.x += (p[0] + q[0] - a[0] - b[0]) / 2;
      this.view.y += (p[1] + q[1] - a[1] - b[1]) / 2;
      this.draw();
    };
  }

  private carry(index: number, start: PointerEvent, begin = () => this.hand.grasp()): Grip {
    const from = this.at(start);
    this.select(index);
    const held = this.task?.points[index] ?? from;
    return dragging(
      start,
      begin,
      (event, last) => {
        const now = this.at(event);
        this.hand.drag(index, [held[0] + now[0] - from[0], held[1] + now[1] - from[1]], last);
      },
      () => this.hand.letGo(),
    );
  }

  /** A point is added where the path is clicked, or behind its last point; it can be carried on at once. */
  private addPoint(start: PointerEvent): Grip {
    const [at, points] = [this.at(start), this.task?.points ?? []];
    const after = segmentAt(points, at, this.task?.closed === true, NEAR / this.view.scale) ?? points.length - 1;
    this.hand.add(at, after);
    const { step } = this.carry(after + 1, start, () => {});
    return { step, abort: () => this.hand.letGo() };
  }

  private resize(name: string, start: PointerEvent): Grip {
    const [kind, corner] = name.split(":") as [BoxKind, string];
    this.corner = { kind, corner: Number(corner) };
    this.drawBox();
    return this.changing(start, (event, last) => {
      const box = this.task?.[kind];
      if (box) this.hand.box(kind, resized(box, Number(corner), this.at(event), 12 / this.view.scale), last);
    });
  }

  private sketchBox(kind: BoxKind, from: Point): Grip {
    const step = (event: PointerEvent, last: boolean) => {
      const box = between(from, this.at(event), 12 / this.view.scale);
      setAll(this.sketch, { visibility: box && !last ? "visible" : "hidden" });
      if (box) {
        const [left, top] = this.toPixel([box[0], box[3]]);
        setAll(this.sketch, {
          x: px(left),
          y: px(top),
          width: px((box[2] - box[0]) * this.view.scale),
          height: px((box[3] - box[1]) * this.view.scale),
        });
      }
      if (!last) return;
      if (box) {
        this.hand.grasp();
        this.hand.box(kind, box, true);
      } else this.say("Drag from one corner of the box to the opposite one.");
    };
    return { step, abort: () => setAll(this.sketch, { visibility: "hidden" }) };
  }

  private widen(index: number, start: PointerEvent): Grip {
    this.select(index);
    return this.changing(start, (event, last) => {
      const [centre, now] = [this.task?.points[index] ?? [0, 0], this.at(event)];
      this.hand.tolerance(index, Math.hypot(now[0] - centre[0], now[1] - centre[1]), last);
    });
  }

  private moveUnderlay(start: PointerEvent): Grip {
    const [from, placed] = [this.at(start), this.underlay.placed];
    return this.changing(start, (event, last) => {
      const now = this.at(event);
      if (placed) this.underlay.place({ x: placed.x + now[0] - from[0], y: placed.y + now[1] - from[1] }, last);
    });
  }

  private pen(start: PointerEvent): Grip {
    const line: Point[] = [this.at(start)];
    const step = (event: PointerEvent, last: boolean) => {
      const more = event.getCoalescedEvents?.() ?? [];
      for (const one of more.length > 0 ? more : [event]) line.push(this.at(one));
      setAll(this.stroke, { d: last ? "" : pathThrough(line.map(this.toPixel)) });
      if (!last) return;
      const target = ofStroke(line, 40 / this.view.scale);
      if (target) this.hand.drawn(target.points, target.closed);
    };
    return { step, abort: () => setAll(this.stroke, { d: "" }) };
  }

  private select(index: number) {
    this.selected = index;
    this.draw();
  }

  private key(event: KeyboardEvent) {
    const { task } = this;
    if (!task || event.ctrlKey || event.metaKey || event.altKey) return;
    const n = task.points.length;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
    const step = (event.shiftKey ? 20 : 4) / this.view.scale;
    if (event.key === "," || event.key === ".") {
      this.corner = null;
      this.selected = n === 0 ? -1 : (this.selected + (event.key === "." ? 1 : -1) + n) % n;
      this.draw();
      this.tellPoint();
    } else if (event.key === "b" || event.key === "B") {
      this.corner = nextCorner(task, this.corner) ?? nextCorner(task, null);
      this.selected = -1;
      this.draw();
      this.tellCorner();
    } else if ((event.key === "Delete" || event.key === "Backspace") && this.corner) {
      this.hand.grasp();
      this.say(`${cornerInWords(this.corner).replace(/,.*/, "")} removed.`);
      this.hand.box(this.corner.kind, null, true);
    } else if ((event.key === "Delete" || event.key === "Backspace") && this.selected >= 0) {
      this.say(`Point ${this.selected} removed; ${n - 1} are left.`);
      this.hand.remove(this.selected);
    } else if (event.key === "+" || event.key === "-") {
      this.touched = true;
      this.zoom(event.key === "+" ? 1.25 : 0.8);
    } else if ((event.key === "[" || event.key === "]") && n > 0) {
      const index = Math.max(this.selected, 0);
      const now = toleranceAt(task, index) || 0.01 * sizeOf(task.points);
      if (event.key === "[" && toleranceAt(task, index) === 0) return;
      this.hand.grasp();
      this.hand.tolerance(index, now * (event.key === "]" ? 1.25 : 0.8), true);
      this.tellTolerance(index);
    } else if (way && this.corner) {
      const box = task[this.corner.kind];
      if (!box) return;
      const [x, y] = cornerOf(box, this.corner.corner);
      this.hand.grasp();
      this.hand.box(
        this.corner.kind,
        resized(box, this.corner.corner, [x + way[0] * step, y + way[1] * step], 12 / this.view.scale),
        true,
      );
      this.tellCorner();
    } else if (way && this.selected >= 0) {
      const [x, y] = task.points[this.selected];
      this.hand.grasp();
      this.hand.drag(this.selected, [x + way[0] * step, y + way[1] * step], true);
      this.tellPoint();
    } else return;
    event.preventDefault();
  }

  private tellCorner() {
    const box = this.corner && this.task?.[this.corner.kind];
    if (!this.corner || !box) return this.say("There is no box: tick one among the requirements.");
    const [x, y] = cornerOf(box, this.corner.corner);
    return this.say(`${cornerInWords(this.corner)} at ${figure(x, 4)}, ${figure(y, 4)}`);
  }

  private tellTolerance(index: number) {
    const { task } = this;
    if (!task) return;
    const where = task.tolerances ? `at point ${index}` : "at every point";
    this.say(`Largest error ${where}: ${figure(toleranceAt(task, index) ?? 0, 3)}${task.unit ? ` ${task.unit}` : ""}`);
  }

  private tellPoint() {
    const p = this.task?.points[this.selected];
    if (p) this.say(`Point ${this.selected} at ${figure(p[0], 4)}, ${figure(p[1], 4)}`);
  }
}
