// What makes a drawing read as a machine: fixed pivots on the ground, the motor's crank with its turning, letters, and
// the trail that P leaves.

import { pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import type { Moving, Toward } from "./figures";
import { type Point, pivotsOf } from "./messages";

/** The part of a motion over which P leaves a trail, its pieces, and steps of each. */
const TRAIL = 0.2;
const PIECES = 5;
const STEPS = 6;
/** Pixels from the crank's pivot to the arrow of its turning. */
const REACH = 21;
/** The largest arrow, in degrees to each side of its middle. */
const WIDEST = 140;

const DEGREE = Math.PI / 180;

/** A pivot on the ground: a triangle over hatching. */
function stand(): SVGGElement {
  const hatches = [-10, -4, 2, 8].map((x) => `M${x + 2} 16l-5 6`).join("");
  return shape("g", { class: "stand" }, [
    shape("path", { class: "stand-body", d: "M0 0L10 16H-10Z" }),
    shape("path", { d: `M-15 16H15${hatches}` }),
  ]);
}

/** An arrow around a pivot from one angle to another, degrees in the plane; with a head at its end, or at both. */
function arrow([x, y]: Point, from: number, to: number, both: boolean): string {
  const at = (deg: number, reach = REACH): Point => [
    x + reach * Math.cos(deg * DEGREE),
    y - reach * Math.sin(deg * DEGREE),
  ];
  const arc = Array.from({ length: 25 }, (_, i) => at(from + ((to - from) * i) / 24));
  const head = (end: number, back: number) =>
    pathThrough([at(end + back, REACH - 5), at(end), at(end + back, REACH + 5)]);
  const back = to > from ? -16 : 16;
  return pathThrough(arc) + head(to, back) + (both ? head(from, -back) : "");
}

export class Machine {
  /** What lies under the links, and what lies over them. */
  readonly under = shape("g");
  readonly over = shape("g");
  private stands = [stand(), stand(), stand(), stand()];
  private trail = Array.from({ length: PIECES }, (_, i) =>
    shape("path", { class: "trail", opacity: (0.75 * (i + 1)) / PIECES }),
  );
  private crank = shape("path", { class: "crank" });
  private turning = shape("path", { class: "turning" });
  private letters = ["A", "B", "C", "D", "P"].map((name) => shape("text", { class: "letter" }, [name]));

  constructor() {
    this.under.append(...this.stands, ...this.trail);
    this.over.append(this.crank, this.turning, ...this.letters);
  }

  show(moving: Moving, toward: Toward) {
    const pivots = pivotsOf(moving.shown.linkage);
    const [A] = pivots;
    pivots.map(toward).forEach(([x, y], i) => {
      setAll(this.stands[i], { transform: `translate(${px(x)} ${px(y)})` });
    });
    const isAlone = pivots.length < 2;
    this.stands.forEach((one, i) => {
      one.classList.toggle("absent", i >= pivots.length);
    });
    this.letters[1].classList.toggle("absent", isAlone);
    const { drive } = moving.shown;
    const { cyclic, sense } = moving.cycle;
    const isFull = cyclic && drive.kind === "turn";
    const middle = isFull ? 90 : drive.middle_deg;
    const half = isFull ? WIDEST : Math.min(drive.half_width_deg, WIDEST);
    const turned = sense < 0 ? -half : half;
    const d = drive.kind === "none" ? "" : arrow(toward(A), middle - turned, middle + turned, !isFull);
    setAll(this.turning, { d });
  }

  /** Stands where the joints are, in pixels: A, B, C, D, P. */
  pose(moving: Moving, part: number, toward: Toward, joints: Point[]) {
    const [a, b, c, d, p] = joints;
    setAll(this.crank, { d: pathThrough([a, c]) });
    const beside = (from: Point, neighbours: Point[]): Point => {
      const away = neighbours.reduce(
        ([x, y], other) => {
          const apart = Math.hypot(from[0] - other[0], from[1] - other[1]) || 1;
          return [x + (from[0] - other[0]) / apart, y + (from[1] - other[1]) / apart];
        },
        [0, 0],
      );
      const length = Math.hypot(away[0], away[1]);
      const [x, y] = length < 0.2 ? [0, -1] : [away[0] / length, away[1] / length];
      return [from[0] + 15 * x, from[1] + 15 * y + 5];
    };
    const places: Point[] = [
      [a[0] - 20, a[1] + 14],
      [b[0] + 20, b[1] + 14],
      beside(c, [a, d, p]),
      beside(d, [b, c, p]),
      beside(p, [c, d]),
    ];
    this.letters.forEach((letter, i) => {
      setAll(letter, { x: px(places[i][0]), y: px(places[i][1]) });
    });
    const step = TRAIL / (PIECES * STEPS);
    const passed = Array.from({ length: PIECES * STEPS + 1 }, (_, i) => {
      const joints = moving.cycle.at(moving.at((part - TRAIL + i * step + 1) % 1));
      return joints ? toward(joints.P as Point) : null;
    });
    this.trail.forEach((piece, i) => {
      setAll(piece, { d: pathThrough(passed.slice(i * STEPS, (i + 1) * STEPS + 1)) });
    });
  }
}
