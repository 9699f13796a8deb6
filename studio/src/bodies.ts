// The body of a motion on the board: a frame at each pose with a handle that turns it, its outline where there is one, where
// the linkage takes it, and the body that moves along with the coupler. The long arm of a frame is the body's x axis.

import { bodyDeg, bodyPoses, CORNERS } from "../../src/report/html/player/body.mjs";
import { pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import type { Board } from "./board";
import type { Point, Task } from "./messages";

/** Of more poses only the chosen one has a handle, and only so many have numbers. */
const MANY = 12;
/** Pixels of a frame's long arm: a part of the poses' box, at least and at most; and from its tip to its handle. */
const [PART, LEAST, MOST, BEYOND, FURTHEST] = [0.11, 28, 46, 15, 90];
const DEGREES = 180 / Math.PI;
/** A body's lines at a place in pixels, turned by an angle; `scale`: pixels of a length of 1. */
function placed(lines: Point[][], [x, y]: Point, deg: number, scale: number): string {
  const [cos, sin] = [Math.cos(deg / DEGREES) * scale, Math.sin(deg / DEGREES) * scale];
  const corner = ([u, v]: Point): Point => [x + cos * u - sin * v, y - sin * u - cos * v];
  return lines.map((line) => `${pathThrough(line.map(corner))}Z`).join("");
}

/** The key of the region for the pins of the body. */
export const PINS_IN = "require.pins_in";

/** The corners of a region as a problem file has it: a box or a polygon. */
function cornersOf(text: string | undefined): Point[] | null {
  try {
    const list = JSON.parse(text ?? "null") as number[] | Point[] | null;
    if (!list) return null;
    if (Array.isArray(list[0])) return list as Point[];
    const [left, low, right, high] = list as number[];
    return [
      [left, low],
      [right, low],
      [right, high],
      [left, high],
    ];
  } catch {
    return null;
  }
}

export class Bodies {
  readonly under = shape("g", { class: "bodies" });
  readonly over = shape("g");
  private still = shape("g");
  private now = shape("path", { class: "body-now" });
  private long = LEAST;

  constructor(private board: Board) {
    this.under.append(this.still, this.now);
    board.boxGroup.after(this.under);
    board.marks.after(this.over);
  }

  private clear() {
    for (const group of [this.still, this.over]) group.replaceChildren();
  }

  draw() {
    const { task } = this.board;
    const body = task?.body;
    this.under.classList.toggle("absent", !body);
    this.over.classList.toggle("absent", !body);
    if (!task || !body) return this.clear();
    const { toPixel, selected, looking } = this.board;
    const spots = task.points.map((p) => toPixel(p as Point));
    const across = [0, 1].map((axis) => spots.map((spot) => spot[axis]));
    const diagonal = spots.length > 0 ? Math.hypot(...across.map((list) => Math.max(...list) - Math.min(...list))) : 0;
    this.long = Math.min(Math.max(PART * diagonal, LEAST), MOST);
    const outline = (body.outline ?? []) as Point[][];
    const few = spots.length <= MANY;
    const [frames, handles]: [SVGElement[], SVGElement[]] = [[], []];
    const reach = this.reach(outline);
    spots.forEach((spot, i) => {
      const deg = body.angle_deg[i];
      const isChosen = i === selected;
      if (few) {
        const [x, y] = spot;
        frames.push(shape("text", { class: "number pose-number", x: px(x - 13), y: px(y + 15) }, [String(i)]));
      }
      if (!Number.isFinite(deg)) return;
      const name = isChosen ? " chosen" : "";
      if (outline.length > 0)
        frames.push(shape("path", { class: `pose-outline${name}`, d: placed(outline, spot, deg, looking.scale) }));
      frames.push(shape("path", { class: `pose-frame${name}`, d: placed([CORNERS as Point[]], spot, deg, this.long) }));
      if (!few && !isChosen) return;
      const along = (far: number): Point => [
        spot[0] + far * Math.cos(deg / DEGREES),
        spot[1] - far * Math.sin(deg / DEGREES),
      ];
      const [cx, cy] = along(reach).map(px);
      handles.push(
        shape("path", { class: "turn-line", d: pathThrough([along(this.long), along(reach - 5)]) }),
        shape("circle", { class: `turner${name}`, cx, cy, r: 5.5 }),
        shape("circle", { class: "touch", cx, cy, r: 12, "data-turn": i }),
      );
    });
    const reached = shape("path", { class: "pose-reached", d: this.reached(task) });
    this.over.replaceChildren(...handles);
    this.still.replaceChildren(...this.regions(task), reached, ...frames);
  }

  /** The regions that a problem file gives: of the fixed pivots, and of the pins with the body in its chosen pose. */
  private regions(task: Task): SVGElement[] {
    const { toPixel, selected, looking } = this.board;
    return (["pivots_in", "pins_in"] as const).flatMap((key) => {
      const corners = cornersOf(task.kept?.[`require.${key}`]);
      const index = Math.max(selected, 0);
      const deg = task.body?.angle_deg[index];
      if (!corners || task.points.length === 0 || deg === undefined) return [];
      const d =
        key === "pivots_in"
          ? `${pathThrough(corners.map(toPixel))}Z`
          : placed([corners], toPixel(task.points[index] as Point), deg, looking.scale);
      const [x, y] = d.match(/-?[\d.]+/g) ?? [];
      const words = key === "pivots_in" ? "fixed pivots in here" : "pins of the body in here";
      const isBox = key === "pins_in" && !task.kept?.[PINS_IN].startsWith("[[");
      if (isBox) this.handle(corners, toPixel(task.points[index] as Point), deg);
      return [
        shape("path", { class: `region ${key}`, d }),
        shape("text", { class: "number", x: Number(x) + 8, y: Number(y) + (key === "pivots_in" ? 16 : -6) }, [words]),
      ];
    });
  }

  /** Handles at the corners of the box for the pins. */
  private handle(corners: Point[], spot: Point, deg: number) {
    const [cos, sin] = [Math.cos(deg / DEGREES), Math.sin(deg / DEGREES)].map((one) => one * this.board.looking.scale);
    this.over.append(
      ...corners.flatMap(([u, v], i) => {
        const [x, y] = [spot[0] + cos * u - sin * v, spot[1] - sin * u - cos * v];
        return [
          shape("rect", { class: "corner", x: px(x - 5), y: px(y - 5), width: 10, height: 10 }),
          shape("circle", { class: "touch", cx: px(x), cy: px(y), r: 10, "data-pins": i }),
        ];
      }),
    );
  }

  /** Pixels from a pose to its handle: beyond the frame, and not within the outline's rim. */
  private reach(outline: Point[][]): number {
    const { scale } = this.board.looking;
    const furthest = Math.max(0, ...outline.flat().map(([u]) => u * scale));
    return Math.min(Math.max(this.long, furthest) + BEYOND, FURTHEST);
  }

  /** The lines of the body: its outline, or a frame. */
  private lines(task: Task, spot: Point, deg: number): string {
    const outline = task.body?.outline as Point[][] | undefined;
    return outline?.length
      ? placed(outline, spot, deg, this.board.looking.scale)
      : placed([CORNERS as Point[]], spot, deg, this.long);
  }

  /** The body where the linkage takes it, at each pose. */
  private reached(task: Task): string {
    return this.errors(task)
      .map(({ place, deg }) => (place ? this.lines(task, this.board.toPixel(place), deg) : ""))
      .join("");
  }

  /** Where the linkage on the board takes the body, with the errors of place and angle; none where it was found for other
   * poses. */
  errors(task: Task): { place: Point | null; deg: number; apart: number; turned: number }[] {
    const { moving, isFor } = this.board;
    if (!moving || !isFor || moving.shown.frame_deg === undefined || !task.body) return [];
    const { cycle } = moving;
    return bodyPoses(cycle, { angle_deg: task.body.angle_deg }).map(({ reached, error }, i) => {
      const point = cycle.points[i];
      const place = Number.isFinite(reached) ? (point.reached as Point | null) : null;
      return { place, deg: reached, apart: point.error, turned: error };
    });
  }

  /** Moves the body along with the coupler. */
  pose(part: number) {
    const { task, moving } = this.board;
    if (!task?.body) return;
    const joints = moving?.cycle.at(moving.at(part));
    const frame = moving?.shown.frame_deg;
    if (!joints || frame === undefined) return setAll(this.now, { d: "" });
    return setAll(this.now, { d: this.lines(task, this.board.toPixel(joints.P as Point), bodyDeg(joints, frame)) });
  }
}
