// The board: the target under the hand, the linkage over it.

import { element, pathThrough, px, roundLength, setAll, shape } from "../../src/report/html/player/svg.mjs";
import { Keys } from "./boardkeys";
import { boxShapes, boxSpots, type Corner } from "./boxes";
import { Figure, type Moving } from "./figures";
import type { Joint, Pose } from "./grab";
import { more } from "./kit";
import { unitAfter } from "./labels";
import { pointShapes } from "./marks";
import { type Box, fourBarOf, type Point, type Task } from "./messages";
import { Overview } from "./overview";
import { watchPointers } from "./pointers";
import type { Hand, Surface, Tool } from "./surface";
import { boxOf, extentTimes, longestMax, sizeOf } from "./task";
import { Tools } from "./tools";
import type { Underlay } from "./underlay";
import * as view from "./view";

/** A board of fewer pixels is low. */
const LOW = 380;

/** A pinned linkage, and the number of its colour. */
export interface Pinned {
  moving: Moving;
  colour: number;
}

export class Board implements Surface {
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
  readonly marks = shape("g");
  private stroke = shape("path", { class: "stroke" });
  readonly boxGroup = shape("g");
  private sketch = shape("rect", { class: "pivot-box", visibility: "hidden" });
  private scaleBar = shape("g");
  private ghosts: Figure[] = [];
  private width = 600;
  private height = 420;
  /** The view that the user has chosen, and the one that is shown: in a small frame it holds the path. */
  private asked: view.View = view.opening(undefined);
  private view = this.asked;
  private overview = new Overview();
  private closer = element("button", { id: "closer", hidden: "" }, ["a closer one"]) as HTMLButtonElement;
  task: Task | null = null;
  moving: Moving | null = null;
  isFor = true;
  private pinned: Pinned[] = [];
  corner: Corner | null = null;
  private part = 0;
  tool: Tool = "draw";
  isWalker = false;
  selected = -1;
  held: number[] = [];

  constructor(
    private place: HTMLElement,
    private hand: Hand,
    say: (text: string) => void,
    private underlay: Underlay,
  ) {
    const [tools, keys] = [new Tools(this, hand, say, underlay), new Keys(this, hand, say)];
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
      (event) => tools.take(event),
      (one, other) => tools.pinch(one, other),
    );
    this.svg.addEventListener(
      "wheel",
      (event: WheelEvent) => {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY / 400), this.at(event));
      },
      { passive: false },
    );
    this.svg.addEventListener("keydown", (event: KeyboardEvent) => keys.press(event));
    new ResizeObserver(() => this.measure()).observe(place);
    this.measure();
  }

  private measure() {
    const [width, height] = [Math.max(this.place.clientWidth, 240), Math.max(this.place.clientHeight, 120)];
    if (width === this.width && height === this.height) return;
    const path = boxOf(this.task?.points ?? []);
    const isSeen = path && view.isWithin(path, this.window);
    Object.assign(this, { width, height });
    // A path that was in sight stays so, at its scale; with room again it is where the user has put it.
    this.view = path && (isSeen || this.view !== this.asked) ? view.inSight(this.asked, this.frame, path) : this.asked;
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

  at(event: { clientX: number; clientY: number }): Point {
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
    this.asked = at;
    this.draw();
    this.hand.looked();
  }

  /** The view of an empty board. */
  open(unit: string | undefined) {
    this.look(view.opening(unit));
  }

  /** Brings the path of a problem that was opened into view, and its boxes as far as the path stays large. */
  fitPath({ points, pivots_in, footprint_in, body }: Task) {
    const path = boxOf(points.filter((p) => p.every(Number.isFinite)));
    const reach = Math.max(0, ...(body?.outline ?? []).flat().map(([x, y]) => Math.hypot(x, y)));
    const bodies = path?.map((side, i) => side + (i < 2 ? -reach : reach)) as Box | undefined;
    const all = path && view.joined([path, bodies, pivots_in, footprint_in].filter((box): box is Box => !!box));
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

  /** Shows the target, a linkage, and those that are pinned; `isFor`: it was found for this path; `another`: it is not
   * the one that was shown before. */
  show(task: Task, moving: Moving | null, pinned: Pinned[], isFor = true, another = false) {
    if (another && this.moving && moving) this.fade(this.moving);
    this.task = task;
    this.moving = moving;
    this.isFor = isFor;
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
    more.kit?.posed(part);
  }

  private draw() {
    const { task } = this;
    if (!task) return;
    const spots = task.points.map(this.toPixel);
    const closedLine = task.closed && spots.length > 2 ? [...spots, spots[0]] : spots;
    const { allowed, marks, held } = pointShapes(task, spots, this.view.scale, this.selected);
    this.held = held;
    this.underlay.draw(this.toPixel);
    const isSeen = spots.some(([x, y]) => x >= 0 && y >= 0 && x <= this.width && y <= this.height);
    const invites =
      spots.length > 0
        ? isSeen
          ? ""
          : "The path is out of sight: Show all"
        : task.function
          ? ""
          : task.body
            ? "Click where the body lies, drag its direction"
            : "Draw a path here";
    const empty = invites
      ? [shape("text", { class: "invitation", x: px(this.width / 2), y: px(this.height / 2) }, [invites])]
      : [];
    this.back.replaceChildren(
      ...empty,
      ...allowed,
      shape("path", { class: "target-line", d: pathThrough(closedLine) }),
    );
    this.marks.replaceChildren(...marks);
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
    this.boxGroup.replaceChildren(...boxShapes(task, this.toPixel, this.corner));
    const passed = this.moving?.passed ?? [];
    more.kit?.drawn();
    const map = this.overview.show(boxOf(task.points), this.moving, this.window, this.frame);
    this.hand.drawnAt([...boxSpots(task, this.toPixel), ...map], [...spots, ...passed.map(this.toPixel)]);
    const length = roundLength((0.2 * this.width) / this.view.scale);
    const y = this.height - 14;
    const longest = task.points.length > 2 ? longestMax(task) : null;
    this.scaleBar.replaceChildren(...this.bar(false, length, y, ""));
    // A limit that is longer than the board is no ruler, and a low board has no room for it.
    if (longest !== null && longest * this.view.scale < this.width - 28 && this.height > LOW)
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

  /** Where the joints of a four-bar stand now. */
  get standing(): Pose | null {
    const joints = this.moving?.cycle.at(this.moving.at(this.part));
    const linkage = this.moving && fourBarOf(this.moving.shown.linkage);
    if (!linkage || !joints) return null;
    const { A, B } = linkage;
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

  /** Lines from the points to the places where the linkage meets them, where these lie apart. */
  private errors(points: Point[]): string {
    const met = (this.isFor && this.moving?.cycle.points.slice(0, points.length)) || [];
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
    const words = `${what}${Number(length.toPrecision(3))}${unitAfter(this.task?.unit)}`;
    const place = isLimit ? { x: 18, y: y - 8 } : { x: px(right + 8), y };
    return [
      shape("path", { class: isLimit ? "limit" : "scale", d: `M14 ${y - 4}v4H${px(right)}v-4` }),
      shape("text", { class: isLimit ? "limit-text" : "scale-text", ...place }, [words]),
    ];
  }

  drawStroke(line: Point[]) {
    setAll(this.stroke, { d: pathThrough(line.map(this.toPixel)) });
  }

  drawSketch(box: Box | null) {
    setAll(this.sketch, { visibility: box ? "visible" : "hidden" });
    if (!box) return;
    const [[left, top], { scale }] = [this.toPixel([box[0], box[3]]), this.view];
    const [width, height] = [(box[2] - box[0]) * scale, (box[3] - box[1]) * scale];
    setAll(this.sketch, { x: px(left), y: px(top), width: px(width), height: px(height) });
  }

  onMap(event: PointerEvent): Point | null {
    return this.overview.pointAt(this.toPixel(this.at(event)));
  }
}
