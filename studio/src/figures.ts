// Linkages as pictures: on the board and in the strip.

import { Cycle } from "../../src/report/html/player/cycle.mjs";
import { belowPoint, guideEnds, guideOf, outlineAt } from "../../src/report/html/player/guide.mjs";
import { pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import { hullOf } from "../../src/report/html/player/tracks.mjs";
import { Machine } from "./machine";
import { type Point, pivotsOf, type Shown } from "./messages";

export type Toward = (p: Point) => Point;

type Joints = { C: Point; D: Point; P: Point; u?: Point; places?: Point[] } | null;

/** Of so many positions of a circuit one is looked at for the places that the links pass. */
const PASSED = 16;

/** A linkage made ready to move, as far as it is looked at: of many through nine points few are in sight. */
export class Moving {
  private made: Cycle | null = null;
  private joints: Joints[] | null = null;
  private places: Point[] | null = null;
  private guiding: ReturnType<typeof guideOf> | undefined;

  constructor(
    readonly shown: Shown,
    private points: Point[],
  ) {}

  get cycle(): Cycle {
    const mechanism = { key: "", name: "", ...this.shown };
    // Between a moved target and its answer the two may differ in length.
    this.made ??= new Cycle(mechanism as never, { points: this.points.slice(0, this.shown.crank_deg.length) });
    return this.made;
  }

  private get circuit(): Joints[] {
    this.joints ??= this.cycle.circuit() as Joints[];
    return this.joints;
  }

  get curve(): (Point | null)[] {
    return this.circuit.map((joints) => joints?.P ?? null);
  }

  /** The rail of a slider, or the rod that runs through its block; null of a four-bar. */
  get guide() {
    if (!this.shown.linkage.kind || this.shown.track) return null;
    this.guiding ??= guideOf(this.cycle.kernel, this.circuit);
    return this.guiding;
  }

  /** The bars at a position, and the plates between more joints, of which the last carries P; with a slider also its guide. */
  bars(joints: NonNullable<Joints>): { bars: [Point, Point][]; plates: Point[][]; along: Point[] } {
    const { guide } = this;
    const { track } = this.shown;
    if (track && joints.places) {
      const links = track.links.map((link) => link.map((i) => (joints.places as Point[])[i]));
      const bars = links.filter((link) => link.length < 3) as [Point, Point][];
      return { bars, plates: links.filter((link) => link.length > 2).map(hullOf) as Point[][], along: [] };
    }
    const [A, B] = pivotsOf(this.shown.linkage);
    const { C, D, P } = joints;
    const crank: [Point, Point] = [A, C];
    if (!guide) return { bars: [crank, [B, D], [C, D]], plates: [[C, D, P]], along: [] };
    const along = guideEnds(this.cycle.kernel, guide, joints) as Point[];
    // An arm holds a block at its pivot; the plate of a rod ends below P.
    const arm: [Point, Point][] = guide.moves ? [[B, D]] : [];
    const corner = guide.moves ? (belowPoint(this.cycle.kernel, joints as never) as Point) : D;
    return { bars: [crank, ...arm], plates: [[C, corner, P]], along };
  }

  /** Places that the links pass. */
  get passed(): Point[] {
    const along = (p: Point, q: Point) =>
      [0, 0.25, 0.5, 0.75, 1].map((part): Point => [p[0] + (q[0] - p[0]) * part, p[1] + (q[1] - p[1]) * part]);
    this.places ??= this.circuit.flatMap((joints, i) => {
      if (!joints || i % PASSED !== 0) return [];
      const { bars, plates, along: ends } = this.bars(joints);
      const edges = plates.flatMap((plate) => plate.map((p, k) => [p, plate[(k + 1) % plate.length]]));
      // Of one loop the coupler's own line lies between two others.
      const links = this.shown.track ? [...bars, ...edges] : [...bars.slice(0, 2), ...edges.slice(1)];
      const lines = [...links, ...(ends.length > 0 ? [ends] : [])];
      return lines.flatMap(([from, to]) => along(from, to));
    });
    return this.places;
  }

  /** The links in one of the positions, as a line through the joints. */
  get links(): Point[] {
    const [A, ...others] = pivotsOf(this.shown.linkage);
    const joints = this.circuit.find((one) => one !== null);
    return joints ? [A, joints.C, joints.D, ...others] : [A, ...others];
  }

  /** q at a part (0 to 1) of the motion: round and round, or to and fro over what the points use. */
  at(part: number): number {
    const { cycle } = this;
    if (cycle.cyclic) return (((cycle.sense * part * 360 + cycle.start) % 360) + 360) % 360;
    const used = cycle.used;
    const [low, high] = used && used[1] - used[0] > 0.5 ? used : cycle.range;
    return low + (high - low) * (0.5 - 0.5 * Math.cos(2 * Math.PI * part));
  }

  /** The part of the motion at which the crank stands at an angle, as near as it comes. */
  partOf(crankDeg: number): number {
    const { cycle } = this;
    if (cycle.cyclic) return ((((cycle.sense * (crankDeg - cycle.start)) / 360) % 1) + 1) % 1;
    const [low, high] = [this.at(0), this.at(0.5)];
    const turned = crankDeg - 360 * Math.round((crankDeg - (low + high) / 2) / 360);
    const along = high > low ? Math.min(Math.max((turned - low) / (high - low), 0), 1) : 0;
    return Math.acos(1 - 2 * along) / (2 * Math.PI);
  }

  box(): number[] {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    const joints = this.circuit.flatMap((j) => (j ? (j.places ?? [j.C, j.D, j.P]) : []));
    for (const [x, y] of [...pivotsOf(this.shown.linkage), ...joints]) {
      box[0] = Math.min(box[0], x);
      box[1] = Math.min(box[1], y);
      box[2] = Math.max(box[2], x);
      box[3] = Math.max(box[3], y);
    }
    return box;
  }
}

/** Linkages that were made ready before, by what they are. */
let made = new Map<string, Moving>();
const MOST_MADE = 400;
/** The same of an answer that is drawn again. */
const known = new WeakMap<Shown, { points: Point[]; moving: Moving }>();

/** A linkage made ready to move, once. */
export function movingOf(shown: Shown, points: Point[]): Moving {
  const before = known.get(shown);
  if (before?.points === points) return before.moving;
  const moving = keyed(shown, points);
  known.set(shown, { points, moving });
  return moving;
}

function keyed(shown: Shown, points: Point[]): Moving {
  const key = JSON.stringify([shown, points]);
  const moving = made.get(key) ?? new Moving(shown, points);
  if (made.size >= MOST_MADE) made = new Map();
  made.set(key, moving);
  return moving;
}

/** The parts of a linkage in a drawing. */
export class Figure {
  readonly group = shape("g", { class: "figure absent" });
  private curve = shape("path", { class: "curve" });
  private ground = shape("path", { class: "ground" });
  private coupler = shape("path", { class: "coupler" });
  private guide = shape("path", { class: "guide" });
  private block = shape("path", { class: "block" });
  private edges = shape("path", { class: "bar-edge" });
  private bars = shape("path", { class: "bar" });
  private pins = Array.from({ length: 4 }, () => shape("circle", { class: "pin" }));
  /** Those of further joints of a linkage of several loops. */
  private further = shape("g");
  private point = shape("circle", { class: "tracer" });
  private machine: Machine | null;
  private moving: Moving | null = null;
  private toward: Toward = (p) => p;

  /** `isMachine`: with ground, motor, letters and trail. */
  constructor(
    private scale = 1,
    isMachine = false,
  ) {
    this.machine = isMachine ? new Machine() : null;
    this.pins.forEach((pin, i) => {
      setAll(pin, { r: (i < 2 ? 5.4 : 4.4) * scale });
    });
    setAll(this.point, { r: 5 * scale });
    const [under, over] = this.machine ? [[this.machine.under], [this.machine.over]] : [[], []];
    const links = [this.guide, this.coupler, this.edges, this.bars];
    this.group.append(
      this.ground,
      this.curve,
      ...under,
      ...links,
      ...over,
      this.block,
      this.further,
      ...this.pins,
      this.point,
    );
  }

  show(moving: Moving | null, toward: Toward) {
    this.moving = moving;
    this.toward = toward;
    this.group.classList.toggle("absent", !moving);
    if (!moving) return;
    const pivots = pivotsOf(moving.shown.linkage);
    setAll(this.curve, { d: pathThrough(moving.curve.map((p) => p && toward(p))) });
    setAll(this.ground, { d: pathThrough(pivots.map(toward)) });
    for (const path of [this.guide, this.block]) path.classList.toggle("absent", !moving.guide);
    // A rail has no second pivot, and the foot on a rod is no pin.
    this.pins[1].classList.toggle("absent", pivots.length < 2);
    this.pins[3].classList.toggle("absent", moving.guide?.moves === true);
    const count = moving.shown.track ? moving.shown.track.names.length : 0;
    const pins = Array.from({ length: count }, () => shape("circle", { class: "pin", r: 3.6 * this.scale }));
    this.further.replaceChildren(...pins);
    this.machine?.show(moving, toward);
  }

  pose(part: number) {
    const { moving, toward } = this;
    const joints = moving?.cycle.at(moving.at(part)) as Joints;
    if (!moving || !joints) return;
    const [A, B = joints.D] = pivotsOf(moving.shown.linkage);
    const [a, b, c, d, p] = [A, B, joints.C, joints.D, joints.P].map(toward);
    const { bars, plates, along } = moving.bars(joints);
    joints.places?.map(toward).forEach(([x, y], i) => {
      setAll(this.further.children[i] as SVGElement, { cx: px(x), cy: px(y) });
    });
    const lines = bars.map((ends) => pathThrough(ends.map(toward))).join("");
    setAll(this.coupler, { d: plates.map((plate) => `${pathThrough(plate.map(toward))}Z`).join("") });
    setAll(this.edges, { d: lines });
    setAll(this.bars, { d: lines });
    if (moving.guide) {
      const { kernel } = moving.cycle as never as { kernel: { s: Point } };
      setAll(this.guide, { d: pathThrough(along.map(toward)) });
      const direction = moving.guide.moves ? (joints.u as Point) : kernel.s;
      setAll(this.block, { d: outlineAt(d, direction, this.scale) });
    }
    [a, b, c, d].forEach(([x, y], i) => {
      setAll(this.pins[i], { cx: px(x), cy: px(y) });
    });
    setAll(this.point, { cx: px(p[0]), cy: px(p[1]) });
    this.machine?.pose(moving, part, toward, [a, b, c, d, p]);
  }
}
