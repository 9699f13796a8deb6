// Poses under the hand: added, turned, reordered; the body's outline drawn; the controls of a motion.

import { element, figure } from "../../src/report/html/player/svg.mjs";
import { Bodies, PINS_IN } from "./bodies";
import { LEAST, resized } from "./boxes";
import type { Page } from "./kit";
import { unitAfter } from "./labels";
import type { Box, Point, Task } from "./messages";
import { PinMapLayer } from "./pinmap";
import { dragging, type Grip } from "./pointers";
import type { How } from "./store";
import { resampled } from "./target";
import { boxOf, pathAlone, roundTo, settled, sizeOf, withAdded } from "./task";

/** Degrees of a key that turns a pose, with Shift and without. */
const [STEP, FAR] = [1, 15];
/** Pixels from a pose within which the pointer has no direction. */
const CLOSE = 6;
/** Points of an outline that is drawn. */
const OUTLINE = 60;
const DEGREES = 180 / Math.PI;

/** An angle without digits that nobody turns, as near as can be to another one. */
const near = (deg: number, other: number) => Number((deg + 360 * Math.round((other - deg) / 360)).toFixed(1));

/** A task with one pose turned to an angle. */
export function withAngle(task: Task, index: number, deg: number): Task {
  const { body } = task;
  return {
    ...task,
    body: body && { ...body, angle_deg: body.angle_deg.map((old, i) => (i === index ? deg : old)) },
  };
}

/** A task with one target moved to another place in the order. */
export function withOrder(task: Task, from: number, to: number): Task {
  const moved = <T>(list: T[] | undefined): T[] | undefined => {
    if (!list) return list;
    const rest = list.filter((_, i) => i !== from);
    rest.splice(to, 0, list[from]);
    return rest;
  };
  const { body, timing } = task;
  return settled({
    ...task,
    points: moved(task.points) as Point[],
    tolerances: moved(task.tolerances),
    weights: moved(task.weights),
    timing: timing && { ...timing, crank_deg: moved(timing.crank_deg) as number[] },
    body: body && {
      ...body,
      angle_deg: moved(body.angle_deg) as number[],
      tolerances_deg: moved(body.tolerances_deg),
    },
  });
}

/** A place of the plane in the frame of a body that lies at `origin`, turned by `deg`. */
function inBody([u, v]: Point, [x, y]: Point, deg: number): Point {
  const [cos, sin] = [Math.cos(deg / DEGREES), Math.sin(deg / DEGREES)];
  return [cos * (u - x) + sin * (v - y), cos * (v - y) - sin * (u - x)];
}

/** An outline about its own middle. */
export function centred(line: Point[]): Point[] {
  const middle = [0, 1].map((axis) => line.reduce((sum, p) => sum + p[axis], 0) / line.length);
  const size = sizeOf(line);
  return line.map((p) => p.map((x, axis) => roundTo(x - middle[axis], size, 4)) as Point);
}

export class Motion {
  private bodies: Bodies;
  private map: PinMapLayer;
  private draw = element(
    "button",
    { id: "tool-body", "aria-pressed": "false", title: "Draw the outline of the body", "aria-label": "Draw the body" },
    ["Body"],
  );
  private mapped = element("input", { type: "checkbox", id: "pin-map" }) as HTMLInputElement;
  private bar = [
    this.draw,
    element(
      "label",
      { class: "check", title: "Where a pin of the body could go: dark where it moves nearly on a circle" },
      [this.mapped, " map of pins"],
    ),
  ] as HTMLElement[];
  private tolerance = element("input", {
    type: "number",
    id: "tolerance-deg",
    min: 0,
    step: "any",
    placeholder: "any",
  }) as HTMLInputElement;
  private weight = element("input", { type: "number", id: "angle-weight", min: 0, step: "any" }) as HTMLInputElement;
  private unit = element("span", { class: "unit" });
  private pins = element("input", { type: "checkbox", id: "pins" }) as HTMLInputElement;
  private sides = ["left", "bottom", "right", "top"].map(
    (side) => element("input", { type: "number", id: `pins-${side}`, step: "any" }) as HTMLInputElement,
  );
  private numbers = element("div", { class: "numbers", id: "pins-numbers" }, [
    ...[0, 2, 1, 3].map((i) => element("label", {}, [`${["left", "bottom", "right", "top"][i]} `, this.sides[i]])),
  ]) as HTMLElement;
  /** What stands beside the box for the fixed pivots. */
  private inBody = [
    element("label", { class: "check", title: "Along the body's axes, from its origin: drawn at the chosen pose" }, [
      this.pins,
      " both pins of the body inside a box",
    ]),
    this.numbers,
  ] as HTMLElement[];
  private wishes = [
    element("label", {}, [
      "Largest error of the angle ",
      element("span", { class: "field" }, [this.tolerance, element("span", {}, ["°"])]),
    ]),
    element("label", {}, ["One degree counts like ", element("span", { class: "field" }, [this.weight, this.unit])]),
  ] as HTMLElement[];
  private each = element("input", { type: "checkbox", id: "each-tolerance-deg" }) as HTMLInputElement;
  private earlier = element("button", { id: "pose-earlier", title: "Key <" }, ["Earlier"]) as HTMLButtonElement;
  private later = element("button", { id: "pose-later", title: "Key >" }, ["Later"]) as HTMLButtonElement;
  private errors = element("p", { id: "pose-errors", class: "note" });
  private drop = element("button", { id: "drop-outline" }, ["Remove the outline"]) as HTMLButtonElement;
  private beside = [
    element("div", { class: "row", role: "group", "aria-label": "The chosen pose in the order" }, [
      element("span", {}, ["The chosen pose: "]),
      this.earlier,
      this.later,
      this.drop,
    ]),
    this.errors,
    element("label", { class: "check" }, [this.each, " its own error of the angle for each pose"]),
  ] as HTMLElement[];

  constructor(private page: Page) {
    const { board } = page;
    this.map = new PinMapLayer(board);
    this.bodies = new Bodies(board);
    const by = (id: string) => document.getElementById(id) as HTMLElement;
    (by("walker").parentElement as HTMLElement).before(...this.bar);
    (by("tolerance").closest("label") as HTMLElement).after(...this.wishes);
    by("table").after(...this.beside);
    by("box-numbers").after(...this.inBody);
    for (const row of document.querySelectorAll("#panel-wishes details"))
      if (row.querySelector("kbd"))
        row.append(
          element("p", {}, [
            "Poses: ",
            element("kbd", {}, ["("]),
            " ",
            element("kbd", {}, [")"]),
            " turn the chosen one by 1°, ",
            element("kbd", {}, ["R"]),
            " by 15°, ",
            element("kbd", {}, ["<"]),
            " ",
            element("kbd", {}, [">"]),
            " bring it earlier or later.",
          ]),
        );
    this.pins.addEventListener("change", () => this.withPins(this.pins.checked ? this.usualPins() : null));
    for (const [i, side] of this.sides.entries())
      side.addEventListener("change", () => {
        const box = [...(this.pinBox(this.page.task()) ?? this.usualPins())] as Box;
        box[i] = side.valueAsNumber;
        if (box.every(Number.isFinite) && box[0] < box[2] && box[1] < box[3]) this.withPins(box);
      });
    this.draw.addEventListener("click", () => page.use(board.tool === "body" ? "poses" : "body"));
    this.mapped.addEventListener("change", () => {
      if (!this.mapped.checked) this.map.show(null);
      page.map(this.mapped.checked);
    });
    this.tolerance.addEventListener("change", () => {
      const { value, valueAsNumber } = this.tolerance;
      if (value === "" || valueAsNumber >= 0) this.change({ tolerance_deg: value === "" ? undefined : valueAsNumber });
    });
    this.weight.addEventListener("change", () => {
      const { valueAsNumber } = this.weight;
      this.change({ angle_weight: valueAsNumber > 0 ? valueAsNumber * DEGREES : undefined });
    });
    this.each.addEventListener("change", () => {
      const { body, points } = this.page.task();
      const all = body?.tolerance_deg ?? 1;
      this.change(
        this.each.checked
          ? { tolerances_deg: points.map(() => all), tolerance_deg: undefined }
          : { tolerances_deg: undefined, tolerance_deg: Math.max(0, ...(body?.tolerances_deg ?? [])) },
      );
    });
    this.earlier.addEventListener("click", () => this.order(-1));
    this.later.addEventListener("click", () => this.order(1));
    this.drop.addEventListener("click", () => this.change({ outline: undefined }));
  }

  /** The box for the pins, in the body's frame; null: there is none, or a polygon of a problem file. */
  private pinBox(task: Task): Box | null {
    const list = JSON.parse(task.kept?.[PINS_IN] ?? "null") as Box | Point[] | null;
    return list && typeof list[0] === "number" ? (list as Box) : null;
  }

  /** A box to begin with: around the outline of the body, or half as large as the motion. */
  private usualPins(): Box {
    const { points, body } = this.page.task();
    const half = 0.25 * sizeOf(points);
    const around = boxOf((body?.outline ?? []).flat() as Point[]);
    return (around ?? [-half, -half, half, half]).map((value) => roundTo(value, 4 * half, 3)) as Box;
  }

  private withPins(box: Box | null, how?: How) {
    const task = this.page.task();
    const { [PINS_IN]: _, ...others } = task.kept ?? {};
    const kept = box ? { ...others, [PINS_IN]: JSON.stringify(box) } : others;
    const next = { ...task, kept: Object.keys(kept).length > 0 ? kept : undefined };
    if (how) this.page.put(next, how);
    else this.page.replace(next);
  }

  /** A corner of the box for the pins that is carried. */
  private resize(corner: number, start: PointerEvent): Grip {
    const { board, hand } = this.page;
    return dragging(
      start,
      () => hand.grasp(),
      (event, last) => {
        const task = this.page.task();
        const box = this.pinBox(task);
        const index = Math.max(board.selected, 0);
        const deg = task.body?.angle_deg[index] ?? 0;
        if (box)
          this.withPins(
            resized(
              box,
              corner,
              inBody(board.at(event), task.points[index] as Point, deg),
              LEAST / board.looking.scale,
            ),
            { moving: !last },
          );
      },
      () => hand.letGo(),
    );
  }

  private change(part: Partial<NonNullable<Task["body"]>>) {
    const task = this.page.task();
    if (task.body) this.page.replace({ ...task, body: { ...task.body, ...part } });
  }

  /** Begins a motion with a pose or none, in place of a path. */
  begin() {
    const task = this.page.task();
    if (task.body) return;
    const had = task.points.length > 0;
    const nothing = pathAlone({ ...task, name: "motion", source: undefined, points: [], closed: false });
    this.page.replace({ ...nothing, body: { angle_deg: [] } }, { fresh: true });
    this.page.tell(
      `A click puts a pose there, a drag gives it its direction; the round handle turns it.${had ? " Undo brings the path back." : ""}`,
    );
  }

  /** What a pointer holds; undefined: nothing of a motion. */
  take(event: PointerEvent): Grip | null | undefined {
    const { board } = this.page;
    const task = this.page.task();
    const target = event.target as Element;
    const turned = target.getAttribute("data-turn");
    if (task.body && turned !== null && board.tool !== "body") return this.turn(Number(turned), event);
    if (board.tool === "body") return this.outline(event);
    const corner = target.getAttribute("data-pins");
    if (corner !== null) return this.resize(Number(corner), event);
    const isHeld = ["point", "corner", "rim"].some((name) => target.hasAttribute(`data-${name}`));
    if (board.tool !== "poses" || isHeld) return undefined;
    return this.add(event);
  }

  /** Turns a pose towards the pointer. */
  private turn(index: number, start: PointerEvent): Grip {
    const { board, hand } = this.page;
    board.selected = index;
    board.redraw();
    return dragging(
      start,
      () => hand.grasp(),
      (event, last) => this.toward(index, event, last),
      () => hand.letGo(),
    );
  }

  private toward(index: number, event: PointerEvent, last: boolean) {
    const { board } = this.page;
    const task = this.page.task();
    const [x, y] = task.points[index];
    const [u, v] = board.at(event);
    const before = task.body?.angle_deg[index] ?? 0;
    const isClose = Math.hypot(u - x, v - y) * board.looking.scale < CLOSE;
    const deg = isClose ? before : near(Math.atan2(v - y, u - x) * DEGREES, before);
    this.page.put(withAngle(task, index, deg), { moving: !last });
  }

  /** A pose where the pointer goes down; a drag gives it its direction. */
  private add(start: PointerEvent): Grip {
    const { board, hand } = this.page;
    this.begin();
    const task = this.page.task();
    const { points, body } = task;
    const size = board.window[2] - board.window[0];
    const at = board.at(start).map((value) => roundTo(value, size, 4)) as Point;
    const index = points.length;
    const added = withAdded(task, index - 1, at);
    this.page.replace(withAngle(added, index, body?.angle_deg[index - 1] ?? 0), { fresh: index < 2 });
    board.selected = index;
    board.redraw();
    const grip = dragging(
      start,
      () => {},
      (event, last) => this.toward(index, event, last),
      () => {},
    );
    return { step: grip.step, abort: () => hand.letGo() };
  }

  /** The pen that draws the outline of the body. */
  private outline(start: PointerEvent): Grip {
    const { board } = this.page;
    const line: Point[] = [board.at(start)];
    const step = (event: PointerEvent, last: boolean) => {
      line.push(board.at(event));
      board.drawStroke(last ? [] : line);
      if (!last) return;
      const { scale } = board.looking;
      if (line.length < 4 || sizeOf(line) * scale < 12) return;
      this.page.use("poses");
      this.page.replace(this.drawn(line), { fresh: this.page.task().points.length < 2 });
    };
    return { step, abort: () => board.drawStroke([]) };
  }

  /** The task with an outline that was drawn on the board: about the chosen pose, or the first; without any the first pose
   * stands in its middle. */
  private drawn(line: Point[]): Task {
    const { board } = this.page;
    const task = this.page.task();
    const even = resampled(line, OUTLINE, true);
    const body = task.body ?? { angle_deg: [] };
    const size = sizeOf(even);
    if (task.points.length === 0) {
      const middle = [0, 1].map((axis) =>
        roundTo(even.reduce((sum, p) => sum + p[axis], 0) / even.length, size, 4),
      ) as Point;
      const outline = even.map((p) => p.map((x, axis) => roundTo(x - middle[axis], size, 4)) as Point);
      const first = withAdded({ ...task, body }, -1, middle);
      return { ...first, body: { ...(first.body ?? body), outline: [outline] } };
    }
    const index = Math.max(board.selected, 0);
    const [[x, y], deg] = [task.points[index], body.angle_deg[index] ?? 0];
    const outline = even.map((p) => inBody(p, [x, y], deg).map((value) => roundTo(value, size, 4)) as Point);
    return { ...task, body: { ...body, outline: [outline] } };
  }

  private order(by: number) {
    const { board } = this.page;
    const task = this.page.task();
    const to = board.selected + by;
    if (board.selected < 0 || to < 0 || to >= task.points.length) return;
    const from = board.selected;
    board.selected = to;
    this.page.replace(withOrder(task, from, to));
    this.page.say(`Pose ${from} is now pose ${to}.`);
  }

  /** A key on the board: brackets turn the chosen pose, angle brackets bring it earlier or later. */
  press(event: KeyboardEvent): boolean {
    const { board } = this.page;
    const task = this.page.task();
    const deg = task.body?.angle_deg[board.selected];
    if (!task.body || board.selected < 0) return false;
    if (event.key === "<" || event.key === ">") {
      this.order(event.key === "<" ? -1 : 1);
      return true;
    }
    const way = { "(": STEP, ")": -STEP, r: FAR, R: -FAR }[event.key];
    if (way === undefined) return false;
    const turned = near((deg ?? 0) + way, deg ?? 0);
    this.page.replace(withAngle(task, board.selected, turned));
    this.page.say(`Pose ${board.selected} at ${figure(turned, 4)}°`);
    return true;
  }

  shown() {
    this.bodies.draw();
    this.map.draw(this.page.task());
    this.tellErrors();
  }

  posed(part: number) {
    this.bodies.pose(part);
  }

  /** The map of an answer. */
  answered(map: Parameters<PinMapLayer["show"]>[0]) {
    this.map.show(this.mapped.checked ? (map ?? null) : null);
    this.map.draw(this.page.task());
  }

  fill(task: Task) {
    const { body } = task;
    for (const one of [...this.bar, ...this.wishes, ...this.beside, ...this.inBody]) one.hidden = !body;
    if (!body) return;
    const box = this.pinBox(task);
    this.pins.checked = task.kept?.[PINS_IN] !== undefined;
    this.numbers.hidden = !box;
    if (box)
      for (const [i, side] of this.sides.entries())
        if (document.activeElement !== side)
          side.value = String(roundTo(box[i], Math.hypot(box[2] - box[0], box[3] - box[1]) || 1, 4));
    const put = (field: HTMLInputElement, value: number | undefined) => {
      if (document.activeElement !== field) field.value = value === undefined ? "" : String(value);
    };
    put(this.tolerance, body.tolerance_deg);
    this.tolerance.disabled = body.tolerances_deg !== undefined;
    this.each.checked = body.tolerances_deg !== undefined;
    const digits = (weight: number) => Number((weight / DEGREES).toPrecision(3));
    put(this.weight, body.angle_weight && digits(body.angle_weight));
    this.weight.placeholder = String(digits(sizeOf(task.points)));
    this.unit.textContent = task.unit ?? "";
    this.drop.hidden = !body.outline?.length;
  }

  /** Says how far the linkage on the board misses each pose. */
  private tellErrors() {
    const task = this.page.task();
    if (!task.body || this.errors.closest(".panel")?.checkVisibility() !== true) return;
    const unit = unitAfter(task.unit);
    const lines = this.bodies.errors(task).map(({ apart, turned }, i) => {
      const angle = Number.isFinite(turned) ? `, ${figure(turned, 2)}°` : "";
      return `pose ${i} by ${figure(apart, 2)}${unit}${angle}`;
    });
    this.errors.textContent = lines.length > 0 ? `The linkage on the board misses ${lines.join("; ")}.` : "";
  }
}
