// The board: the target under the hand, the linkage over it.

import { figure, pathThrough, px, roundLength, setAll, shape } from "../../src/report/html/player/svg.mjs";
import { Figure, type Moving } from "./figures";
import type { Point, Task } from "./messages";
import { ofStroke } from "./target";

export type Tool = "draw" | "points";

export interface Hand {
  /** A new target was drawn. */
  drawn(points: Point[], closed: boolean): void;
  /** A point is about to be moved, or the box. */
  grasp(): void;
  /** A point is being moved. */
  drag(index: number, to: Point, last: boolean): void;
  /** A point is added. */
  add(at: Point): void;
  remove(index: number): void;
  /** A corner of the pivot box moves. */
  box(box: [number, number, number, number], last: boolean): void;
}

export class Board {
  readonly svg = shape("svg", { class: "stage board", tabindex: 0, role: "application", "aria-label": "The target. Comma and full stop choose a point, the arrow keys move it, Delete removes it." });
  private back = shape("g");
  private pins = shape("g", { class: "pinned" });
  private mechanism = new Figure();
  private marks = shape("g");
  private stroke = shape("path", { class: "stroke" });
  private boxGroup = shape("g");
  private scaleBar = shape("g");
  private ghosts: Figure[] = [];
  private width = 600;
  private height = 420;
  private view = { x: 0, y: 0, scale: 2.4 };
  private task: Task | null = null;
  private moving: Moving | null = null;
  private pinned: Moving[] = [];
  tool: Tool = "draw";
  selected = -1;

  constructor(private place: HTMLElement, private hand: Hand, private say: (text: string) => void) {
    this.svg.append(this.back, this.boxGroup, this.pins, this.mechanism.group, this.marks, this.stroke, this.scaleBar);
    place.append(this.svg);
    this.svg.addEventListener("pointerdown", (event: PointerEvent) => this.down(event));
    this.svg.addEventListener("wheel", (event: WheelEvent) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), this.at(event));
    }, { passive: false });
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

  toPixel = ([x, y]: Point): Point => [this.width / 2 + (x - this.view.x) * this.view.scale, this.height / 2 - (y - this.view.y) * this.view.scale];

  private toPlane([x, y]: Point): Point {
    return [this.view.x + (x - this.width / 2) / this.view.scale, this.view.y - (y - this.height / 2) / this.view.scale];
  }

  private at(event: { clientX: number; clientY: number }): Point {
    const box = this.svg.getBoundingClientRect();
    return this.toPlane([((event.clientX - box.left) * this.width) / box.width, ((event.clientY - box.top) * this.height) / box.height]);
  }

  zoom(by: number, around: Point = [this.view.x, this.view.y]) {
    const scale = Math.min(Math.max(this.view.scale * by, 1e-7), 1e7);
    const kept = this.view.scale / scale;
    this.view = { scale, x: around[0] + (this.view.x - around[0]) * kept, y: around[1] + (this.view.y - around[1]) * kept };
    this.draw();
  }

  /** Brings target, linkage and pivot box into view. */
  fit() {
    const points = this.task?.points ?? [];
    const box = this.moving?.box() ?? [Infinity, Infinity, -Infinity, -Infinity];
    const all: Point[] = [...points, [box[0], box[1]], [box[2], box[3]]];
    const pivots = this.task?.pivots_in;
    if (pivots) all.push([pivots[0], pivots[1]], [pivots[2], pivots[3]]);
    const finite = all.filter((p) => p.every(Number.isFinite));
    if (finite.length === 0) return;
    const [xs, ys] = [finite.map((p) => p[0]), finite.map((p) => p[1])];
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const size = Math.max(right - left, high - low, 1e-6);
    const scale = Math.min((this.width - 70) / Math.max(right - left, size / 50), (this.height - 80) / Math.max(high - low, size / 50));
    this.view = { x: (left + right) / 2, y: (low + high) / 2, scale };
    this.draw();
  }

  show(task: Task, moving: Moving | null, pinned: Moving[]) {
    this.task = task;
    this.moving = moving;
    this.pinned = pinned;
    if (this.selected >= task.points.length) this.selected = -1;
    this.draw();
  }

  pose(part: number) {
    this.mechanism.pose(part);
    this.ghosts.forEach((ghost) => ghost.pose(part));
  }

  private draw() {
    const { task } = this;
    if (!task) return;
    const spots = task.points.map(this.toPixel);
    const closedLine = task.closed && spots.length > 2 ? [...spots, spots[0]] : spots;
    const many = spots.length > 24;
    const tolerance = (task.tolerance ?? 0) * this.view.scale;
    const circles = tolerance > 3 ? spots.map(([cx, cy]) => shape("circle", { class: "allowed", cx: px(cx), cy: px(cy), r: px(tolerance) })) : [];
    this.back.replaceChildren(...circles, shape("path", { class: "target-line", d: pathThrough(closedLine) }));
    this.marks.replaceChildren(...spots.flatMap(([x, y], i) => {
      const [cx, cy] = [px(x), px(y)];
      const chosen = i === this.selected;
      const dot = shape("circle", { class: `target-point${i === 0 ? " first" : ""}${chosen ? " chosen" : ""}`, cx, cy, r: chosen ? 6.5 : many ? 3.4 : 5 });
      return [dot, shape("circle", { class: "handle", cx, cy, r: many ? 9 : 16, "data-point": i })];
    }));
    while (this.ghosts.length < this.pinned.length) this.ghosts.push(new Figure(0.8));
    this.pins.replaceChildren(...this.pinned.map((_, i) => this.ghosts[i].group));
    this.pinned.forEach((moving, i) => this.ghosts[i].show(moving, this.toPixel));
    this.mechanism.show(this.moving, this.toPixel);
    this.drawBox();
    const length = roundLength((0.2 * this.width) / this.view.scale);
    const y = this.height - 14;
    this.scaleBar.replaceChildren(
      shape("path", { class: "scale", d: `M14 ${y - 4}v4h${px(length * this.view.scale)}v-4` }),
      shape("text", { class: "scale-text", x: px(22 + length * this.view.scale), y }, [`${Number(length.toPrecision(3))}${task.unit ? ` ${task.unit}` : ""}`]),
    );
  }

  private drawBox() {
    const box = this.task?.pivots_in;
    if (!box) return this.boxGroup.replaceChildren();
    const [left, top] = this.toPixel([box[0], box[3]]);
    const [right, bottom] = this.toPixel([box[2], box[1]]);
    const corners: [number, number, string][] = [[left, bottom, "01"], [right, bottom, "21"], [right, top, "23"], [left, top, "03"]];
    return this.boxGroup.replaceChildren(
      shape("rect", { class: "pivot-box", x: px(left), y: px(top), width: px(right - left), height: px(bottom - top) }),
      shape("text", { class: "number", x: px(left + 6), y: px(top + 15) }, ["pivots in here"]),
      ...corners.map(([x, y, name]) => shape("rect", { class: "corner", x: px(x - 6), y: px(y - 6), width: 12, height: 12, "data-corner": name })),
    );
  }

  private down(event: PointerEvent) {
    if (event.button !== 0 || !this.task) return;
    const target = event.target as Element;
    const point = target.getAttribute("data-point");
    const corner = target.getAttribute("data-corner");
    event.preventDefault();
    this.svg.focus({ preventScroll: true });
    this.svg.setPointerCapture(event.pointerId);
    if (event.shiftKey) return this.follow(this.pan(event));
    if (corner) return this.follow(this.resize(corner));
    if (point !== null) return this.follow(this.carry(Number(point), this.at(event)));
    if (this.tool === "points") {
      this.hand.add(this.at(event));
      this.selected = (this.task?.points.length ?? 0) - 1;
      return this.follow(this.carry(this.selected, this.at(event)));
    }
    return this.follow(this.pen(event));
  }

  /** Sends every move to `step` until the pointer goes up. */
  private follow(step: (event: PointerEvent, last: boolean) => void) {
    const move = (event: PointerEvent) => step(event, false);
    const end = (event: PointerEvent) => {
      for (const [name, listener] of [["pointermove", move], ["pointerup", end], ["pointercancel", end]] as const) this.svg.removeEventListener(name, listener);
      step(event, true);
    };
    for (const [name, listener] of [["pointermove", move], ["pointerup", end], ["pointercancel", end]] as const) this.svg.addEventListener(name, listener);
  }

  private pan(start: PointerEvent) {
    const held = this.at(start);
    return (event: PointerEvent) => {
      const now = this.at(event);
      this.view.x += held[0] - now[0];
      this.view.y += held[1] - now[1];
      this.draw();
    };
  }

  private carry(index: number, from: Point) {
    this.selected = index;
    this.hand.grasp();
    const held = this.task?.points[index] ?? from;
    return (event: PointerEvent, last: boolean) => {
      const now = this.at(event);
      this.hand.drag(index, [held[0] + now[0] - from[0], held[1] + now[1] - from[1]], last);
    };
  }

  private resize(corner: string) {
    this.hand.grasp();
    const [i, j] = [Number(corner[0]), Number(corner[1])];
    return (event: PointerEvent, last: boolean) => {
      const box = [...(this.task?.pivots_in ?? [0, 0, 1, 1])] as [number, number, number, number];
      const [x, y] = this.at(event).map((value) => Number(value.toPrecision(4)));
      const least = 12 / this.view.scale;
      box[i] = i === 0 ? Math.min(x, box[2] - least) : Math.max(x, box[0] + least);
      box[j] = j === 1 ? Math.min(y, box[3] - least) : Math.max(y, box[1] + least);
      this.hand.box(box, last);
    };
  }

  private pen(start: PointerEvent) {
    const line: Point[] = [this.at(start)];
    return (event: PointerEvent, last: boolean) => {
      const more = event.getCoalescedEvents?.() ?? [];
      for (const one of more.length > 0 ? more : [event]) line.push(this.at(one));
      setAll(this.stroke, { d: last ? "" : pathThrough(line.map(this.toPixel)) });
      if (!last) return;
      const target = ofStroke(line, 40 / this.view.scale);
      if (target) this.hand.drawn(target.points, target.closed);
    };
  }

  private key(event: KeyboardEvent) {
    const { task } = this;
    if (!task || event.ctrlKey || event.metaKey || event.altKey) return;
    const n = task.points.length;
    if (event.key === "," || event.key === ".") {
      this.selected = n === 0 ? -1 : (this.selected + (event.key === "." ? 1 : -1) + n) % n;
      this.draw();
      this.tellPoint();
    } else if ((event.key === "Delete" || event.key === "Backspace") && this.selected >= 0) {
      this.hand.remove(this.selected);
    } else if (event.key === "+" || event.key === "-") {
      this.zoom(event.key === "+" ? 1.25 : 0.8);
    } else {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
      if (!way || this.selected < 0) return;
      const step = (event.shiftKey ? 20 : 4) / this.view.scale;
      const [x, y] = task.points[this.selected];
      this.hand.grasp();
      this.hand.drag(this.selected, [x + way[0] * step, y + way[1] * step], true);
      this.tellPoint();
    }
    event.preventDefault();
  }

  private tellPoint() {
    const p = this.task?.points[this.selected];
    if (p) this.say(`Point ${this.selected} at ${figure(p[0], 4)}, ${figure(p[1], 4)}`);
  }
}

