// The board: the target under the hand, the linkage over it.

import { element, figure, pathThrough, px, roundLength, setAll, shape } from "../../src/report/html/player/svg.mjs";
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
import type { Joint, Pose } from "./grab";
import type { Box, Point, Task } from "./messages";
import { Overview } from "./overview";
import { dragging, type Grip, watchPointers } from "./pointers";
import { ofStroke, segmentAt } from "./target";
import { boxOf, extentTimes, longestMax, sizeOf, toleranceAt } from "./task";
import type { Underlay } from "./underlay";
import * as view from "./view";

/** A click so near to the path, in pixels, is meant for it. */
const NEAR = 9;

/** Pixels of what stands under the board. */
const BESIDE = 128;
/** Points of a dense path by which it is held. */
const HANDLES = 10;

/** A pinned linkage, and the number of its colour. */
export interface Pinned {
  moving: Moving;
  colour: number;
}

export type Tool = "draw" | "grab" | "points" | BoxKind | "photo-move" | "photo-scale";

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
  /** A joint of the linkage is being moved, from a pose. */
  joint(pose: Pose, joint: Joint, to: Point): void;
  /** The crank is being turned to an angle, degrees. */
  turn(crankDeg: number): void;
  /** The photograph was clicked at an end of a known length. */
  marked(): void;
  /** The view has changed. */
  looked(): void;
  /** The closer linkage that is offered is wanted. */
  takeCloser(): void;
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
  private mechanism = new Figure(1, true);
  /** The linkage that was shown before another took its place, while it fades. */
  private before = new Figure();
  private whiskers = shape("path", { class: "whisker" });
  /** The ground under a walking machine, and its other leg, half a turn later. */
  private earth = shape("path", { class: "earth" });
  private second = new Figure();
  /** The largest extent that is asked for, around the path. */
  private ghost = shape("rect", { class: "ghost" });
  private grips = shape("g");
  private marks = shape("g");
  private stroke = shape("path", { class: "stroke" });
  private boxGroup = shape("g");
  private sketch = shape("rect", { class: "pivot-box", visibility: "hidden" });
  private scaleBar = shape("g");
  private ghosts: Figure[] = [];
  private width = 600;
  private height = 420;
  private view: view.View = view.opening(undefined);
  private overview = new Overview();
  private closer = element("button", { type: "button", id: "closer", hidden: "" }, [
    "a closer one",
  ]) as HTMLButtonElement;
  private task: Task | null = null;
  private moving: Moving | null = null;
  private pinned: Pinned[] = [];
  private corner: Corner | null = null;
  private part = 0;
  tool: Tool = "draw";
  isWalker = false;
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
      this.ghost,
      this.earth,
      this.pins,
      this.second.group,
      this.before.group,
      this.whiskers,
      this.mechanism.group,
      this.marks,
      this.grips,
      this.stroke,
      this.scaleBar,
      this.overview.group,
    );
    this.closer.addEventListener("click", () => this.hand.takeCloser());
    place.append(this.svg, this.closer);
    watchPointers(
      this.svg,
      (event) => this.take(event),
      (one, other) => this.pinch(one, other),
    );
    this.svg.addEventListener(
      "wheel",
      (event: WheelEvent) => {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY / 400), this.at(event));
      },
      { passive: false },
    );
    this.svg.addEventListener("keydown", (event: KeyboardEvent) => this.key(event));
    const sizes = new ResizeObserver(() => this.measure());
    sizes.observe(place);
    if (place.parentElement) sizes.observe(place.parentElement);
    this.measure();
  }

  private measure() {
    const width = Math.max(this.place.clientWidth, 240);
    // Beside it the controls of the board and the status stay in sight.
    const room = (this.place.parentElement?.clientHeight || innerHeight * 0.52) - BESIDE;
    const upright = innerHeight > innerWidth && innerWidth < 761;
    const height = Math.max(Math.round(upright ? Math.min(width * 0.85, innerHeight * 0.42) : room), 180);
    if (width === this.width && height === this.height) return;
    Object.assign(this, { width, height });
    setAll(this.svg, { viewBox: `0 0 ${width} ${height}`, width, height });
    this.draw();
  }

  private get frame(): view.Frame {
    return { width: this.width, height: this.height };
  }

  toPixel = (p: Point): Point => view.toPixel(this.view, this.frame, p);

  private toPlane(p: Point): Point {
    return view.toPlane(this.view, this.frame, p);
  }

  private at(event: { clientX: number; clientY: number }): Point {
    const box = this.svg.getBoundingClientRect();
    return this.toPlane([
      ((event.clientX - box.left) * this.width) / box.width,
      ((event.clientY - box.top) * this.height) / box.height,
    ]);
  }

  zoom(by: number, around?: Point) {
    this.look(view.zoomed(this.view, by, around));
  }

  /** The view, which only the user changes. */
  get looking(): view.View {
    return this.view;
  }

  look(at: view.View) {
    this.view = at;
    this.draw();
    this.hand.looked();
  }

  /** The view of an empty board. */
  open(unit: string | undefined) {
    this.look(view.opening(unit));
  }

  /** Brings the path of a problem that was opened into view, and its boxes as far as the path stays large. */
  fitPath({ points, pivots_in, footprint_in }: Task) {
    const path = boxOf(points.filter((p) => p.every(Number.isFinite)));
    const all = path && view.joined([path, pivots_in, footprint_in].filter((box): box is Box => !!box));
    if (path && all) this.look(view.onPath(this.frame, path, all));
  }

  /** Brings target, linkages and boxes of the requirements into view. */
  fit() {
    const boxes = [...this.linkages(), boxOf(this.task?.points ?? []), this.task?.pivots_in, this.task?.footprint_in];
    const all = view.joined(boxes.filter((box): box is Box => !!box));
    if (all) this.look(view.around(this.frame, all));
  }

  /** What the linkages that are shown need. */
  private linkages(): Box[] {
    return [this.moving, ...this.pinned.map(({ moving }) => moving)].flatMap((one) => (one ? [one.box() as Box] : []));
  }

  /** What is in view. */
  get window(): Box {
    return view.windowOf(this.view, this.frame);
  }

  /** Shows the target, a linkage, and those that are pinned; `another`: it is not the one that was shown before. */
  show(task: Task, moving: Moving | null, pinned: Pinned[], another = false) {
    if (another && this.moving && moving) this.fade(this.moving);
    this.task = task;
    this.moving = moving;
    this.pinned = pinned;
    if (this.selected >= task.points.length) this.selected = -1;
    if (this.corner && !task[this.corner.kind]) this.corner = null;
    this.draw();
  }

  /** Offers a linkage that comes nearer by a part than the one that is held; null: there is none. */
  offer(part: number | null) {
    this.closer.hidden = part === null;
    if (part !== null) this.closer.textContent = `a closer one: −${Math.round(100 * part)} %`;
  }

  /** Lets a linkage fade while another appears in its place. */
  private fade(before: Moving) {
    this.before.show(before, this.toPixel);
    this.before.pose(this.part);
    for (const [group, name] of [
      [this.before.group, "leaving"],
      [this.mechanism.group, "coming"],
    ] as const) {
      group.classList.remove(name);
      // Read, so that the same animation begins anew.
      group.getBoundingClientRect();
      group.classList.add(name);
    }
  }

  redraw() {
    this.draw();
  }

  pose(part: number) {
    this.part = part;
    this.mechanism.pose(part);
    if (this.isWalker) this.second.pose((part + 0.5) % 1);
    if (this.tool === "grab") this.drawGrips();
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
    const isSeen = spots.some(([x, y]) => x >= 0 && y >= 0 && x <= this.width && y <= this.height);
    const invites = spots.length === 0 ? "Draw a path here" : isSeen ? "" : "The path is out of sight: Show all";
    const empty = invites
      ? [shape("text", { class: "invitation", x: px(this.width / 2), y: px(this.height / 2) }, [invites])]
      : [];
    this.back.replaceChildren(
      ...empty,
      ...circles,
      shape("path", { class: "target-line", d: pathThrough(closedLine) }),
    );
    // A dense path is held at a few places, its ends not among them: there the next stroke may begin.
    const held = new Set(Array.from({ length: HANDLES }, (_, k) => Math.floor(((k + 0.5) * spots.length) / HANDLES)));
    if (this.selected >= 0) held.add(this.selected);
    const marks = spots.flatMap(([x, y], i) => {
      const [cx, cy] = [px(x), px(y)];
      const chosen = i === this.selected;
      const dot = shape("circle", {
        class: `target-point${i === 0 ? " first" : ""}${chosen ? " chosen" : ""}`,
        cx,
        cy,
        r: chosen ? 6.5 : 5,
      });
      if (many && !held.has(i)) return [];
      if (many && !chosen) setAll(dot, { r: 4.4 });
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
    this.pinned.forEach(({ moving, colour }, i) => {
      setAll(this.ghosts[i].group, { class: `figure pin-${colour}` });
      this.ghosts[i].show(moving, this.toPixel);
    });
    setAll(this.whiskers, { d: this.errors(task.points) });
    this.drawWalker(task.points);
    this.drawGhost(task);
    this.drawGrips();
    this.mechanism.show(this.moving, this.toPixel);
    this.drawBox();
    this.overview.show(boxOf(task.points), this.moving, this.window, this.frame);
    const length = roundLength((0.2 * this.width) / this.view.scale);
    const y = this.height - 14;
    const longest = task.points.length > 2 ? longestMax(task) : null;
    this.scaleBar.replaceChildren(...this.bar(false, length, y, ""));
    // A limit that is longer than the board is no ruler.
    if (longest !== null && longest * this.view.scale < this.width - 28)
      this.scaleBar.append(...this.bar(true, longest, y - 22, "limit of the longest link: "));
    // Another view of one that stands still.
    this.pose(this.part);
  }

  /** The ground at the height of the lowest point, and the second leg where the crank turns on and on. */
  private drawWalker(points: Point[]) {
    const low = boxOf(points)?.[1];
    const walks = this.isWalker && this.moving?.cycle.cyclic === true && low !== undefined;
    this.second.show(walks ? this.moving : null, this.toPixel);
    this.second.group.classList.add("second");
    if (!this.isWalker || low === undefined) return setAll(this.earth, { d: "" });
    const y = px(this.toPixel([0, low])[1] + 2);
    const hatches = Array.from({ length: Math.ceil(this.width / 16) }, (_, i) => `M${16 * i + 10} ${y}l-7 8`);
    return setAll(this.earth, { d: `M0 ${y}H${this.width}${hatches.join("")}` });
  }

  /** The box that a limit on the extent leaves to what is shown. */
  private drawGhost(task: Task) {
    const times = task.points.length > 2 ? extentTimes(task) : null;
    this.ghost.classList.toggle("absent", times === null);
    const around = (this.moving?.box() as Box | undefined) ?? boxOf(task.points);
    if (times === null || !around) return;
    const [x, y] = this.toPixel([(around[0] + around[2]) / 2, (around[1] + around[3]) / 2]);
    // As its own box, as large as the limit allows.
    const [w, h] = [around[2] - around[0], around[3] - around[1]];
    const by = (times * sizeOf(task.points) * this.view.scale) / (Math.hypot(w, h) || 1);
    setAll(this.ghost, { x: px(x - (w * by) / 2), y: px(y - (h * by) / 2), width: px(w * by), height: px(h * by) });
  }

  /** Where the joints stand now. */
  get standing(): Pose | null {
    const joints = this.moving?.cycle.at(this.moving.at(this.part));
    if (!this.moving || !joints) return null;
    const { A, B } = this.moving.shown.linkage;
    return { A, B, C: joints.C as Point, D: joints.D as Point, P: joints.P as Point };
  }

  /** What a linkage is grabbed by: its joints, and the middle of the crank to turn it. */
  private drawGrips() {
    const pose = this.tool === "grab" ? this.standing : null;
    if (!pose) return this.grips.replaceChildren();
    const grip = (name: string, at: Point) => {
      const [cx, cy] = this.toPixel(at);
      return shape("circle", { class: `grip ${name}`, cx: px(cx), cy: px(cy), r: 13, "data-joint": name });
    };
    const middle: Point = [(pose.A[0] + pose.C[0]) / 2, (pose.A[1] + pose.C[1]) / 2];
    const joints = (Object.keys(pose) as Joint[]).map((name) => grip(name, pose[name]));
    return this.grips.replaceChildren(grip("turn", middle), ...joints);
  }

  /** A joint that is carried, or the crank that is turned. */
  private grab(name: string, start: PointerEvent): Grip | null {
    const pose = this.standing;
    if (!pose) return null;
    const [from, { A }] = [this.at(start), pose];
    if (name === "turn") {
      const step = (event: PointerEvent) => {
        const [x, y] = this.at(event);
        this.hand.turn((Math.atan2(y - A[1], x - A[0]) * 180) / Math.PI);
      };
      return { step, abort: () => {} };
    }
    const held = pose[name as Joint];
    return this.changing(start, (event) => {
      const now = this.at(event);
      this.hand.joint(pose, name as Joint, [held[0] + now[0] - from[0], held[1] + now[1] - from[1]]);
    });
  }

  /** Lines from the points to the places where the linkage meets them, where these lie apart. */
  private errors(points: Point[]): string {
    const met = this.moving?.cycle.points.slice(0, points.length) ?? [];
    return met
      .map(({ reached }, i) => {
        if (!reached) return "";
        const [from, to] = [this.toPixel(points[i]), this.toPixel(reached)];
        return Math.hypot(to[0] - from[0], to[1] - from[1]) < 1.5 ? "" : pathThrough([from, to]);
      })
      .join("");
  }

  /** A length at the rim of the board: of the limit with its words above, as it may run off the board. */
  private bar(isLimit: boolean, length: number, y: number, what: string) {
    const right = 14 + length * this.view.scale;
    const words = `${what}${Number(length.toPrecision(3))}${this.task?.unit ? ` ${this.task.unit}` : ""}`;
    const place = isLimit ? { x: 18, y: y - 8 } : { x: px(right + 8), y };
    return [
      shape("path", { class: isLimit ? "limit" : "scale", d: `M14 ${y - 4}v4H${px(right)}v-4` }),
      shape("text", { class: isLimit ? "limit-text" : "scale-text", ...place }, [words]),
    ];
  }

  private drawBox() {
    this.boxGroup.replaceChildren(...(this.task ? boxShapes(this.task, this.toPixel, this.corner) : []));
  }

  /** What a pointer that goes down here holds. */
  private take(event: PointerEvent): Grip | null {
    const target = event.target as Element;
    const [point, corner, rim, joint] = ["point", "corner", "rim", "joint"].map((name) =>
      target.getAttribute(`data-${name}`),
    );
    this.svg.focus({ preventScroll: true });
    if (!this.task) return null;
    const overviewed = target.closest(".overview") && this.overview.pointAt(this.toPixel(this.at(event)));
    if (overviewed) {
      this.look({ ...this.view, x: overviewed[0], y: overviewed[1] });
      return null;
    }
    if (event.shiftKey) return this.pan(event);
    if (this.tool === "grab") return joint ? this.grab(joint, event) : this.pan(event);
    if (this.tool === "photo-move" && this.underlay.there) return this.moveUnderlay(event);
    if (this.tool === "photo-scale" && this.underlay.there) {
      this.underlay.mark(this.at(event));
      this.hand.marked();
      return null;
    }
    if (this.tool === "pivots_in" || this.tool === "footprint_in") return this.sketchBox(this.tool, this.at(event));
    if (corner) return this.resize(corner, event);
    if (rim !== null) return this.widen(Number(rim), event);
    if (point !== null) return this.carry(this.nearest(event), event);
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
    const step = (event: PointerEvent) => this.look(view.carried(this.view, held, this.at(event)));
    return { step, abort: () => {} };
  }

  /** Two fingers hold two points of the plane. */
  private pinch(one: PointerEvent, other: PointerEvent) {
    const [p, q] = [this.at(one), this.at(other)];
    const apart = Math.max(Math.hypot(q[0] - p[0], q[1] - p[1]), 1e-9);
    return (one: PointerEvent, other: PointerEvent) => {
      const now = [this.at(one), this.at(other)];
      this.zoom(Math.hypot(now[1][0] - now[0][0], now[1][1] - now[0][1]) / apart);
      const [a, b] = [this.at(one), this.at(other)];
      const middle = (one: Point, other: Point): Point => [(one[0] + other[0]) / 2, (one[1] + other[1]) / 2];
      this.look(view.carried(this.view, middle(p, q), middle(a, b)));
    };
  }

  /** The point nearest to a pointer among those by which the path is held: their handles overlap. */
  private nearest(event: PointerEvent): number {
    const [x, y] = this.at(event);
    const points = this.task?.points ?? [];
    const far = (i: number) => Math.hypot(points[i][0] - x, points[i][1] - y);
    const held = [...this.marks.querySelectorAll("[data-point]")].map((one) => Number(one.getAttribute("data-point")));
    return held.reduce((best, i) => (far(i) < far(best) ? i : best));
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
