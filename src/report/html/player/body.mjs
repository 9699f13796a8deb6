// The body of a motion on the drawing: a frame at each pose, in outline where it is wanted and filled where the linkage
// takes it, and one that moves along with the coupler. The long arm, with a point, is the body's x axis.

import { wrappedDeg } from "./drive.mjs";
import { positionAt } from "./kinematics.mjs";
import { element, pathThrough, px, setAll, shape } from "./svg.mjs";

/** Poses that are drawn strongly; of more, so many evenly chosen. */
const STRONG = 12;
const DEGREES = 180 / Math.PI;
/** The corners of a frame of length 1, in the body's axes: as in bodies.rs, for the drawings that stand still. */
export const CORNERS = [
  [-0.07, -0.07],
  [0.76, -0.07],
  [1, 0],
  [0.76, 0.07],
  [0.07, 0.07],
  [0.07, 0.56],
  [-0.07, 0.56],
];

/** @typedef {{number: number, place: number | null, wanted: number | null, reached: number, error: number, tolerance: number | null}} BodyPose */

/** The angle of a body that lies `frameDeg` from the direction C -> D, degrees within half a turn. */
export function bodyDeg({ C, D, u = [D[0] - C[0], D[1] - C[1]] }, frameDeg) {
  return wrappedDeg(Math.atan2(u[1], u[0]) * DEGREES + frameDeg);
}

/**
 * The angles of the body at the points of a cycle: wanted, reached, and the error, in degrees; NaN where there is none.
 * @param {import("./cycle.mjs").Cycle} cycle @param {{angle_deg: (number | null)[], tolerance_deg?: number[]}} target
 * @returns {BodyPose[]}
 */
export function bodyPoses(cycle, target) {
  const { frame_deg: frame = NaN, t1_at: t1s } = cycle.mechanism;
  return cycle.points.map(({ number, place, crankDeg }, i) => {
    const wanted = target.angle_deg[i];
    const joints = positionAt(cycle.kernel, crankDeg / DEGREES, t1s?.[i] ?? cycle.drive.t1);
    const reached = joints ? bodyDeg(joints, frame) : NaN;
    const error = wanted === null ? NaN : Math.abs(wrappedDeg(wanted - reached));
    return { number, place, wanted, reached, error, tolerance: target.tolerance_deg?.[i] ?? null };
  });
}

/** What a chart of errors reads, with the errors of the angle. */
export function anglesOf(cycle, target) {
  const points = bodyPoses(cycle, target);
  const like = (point) => (point ? points[cycle.points.indexOf(point)] : null);
  return {
    points,
    nearestPoint: (q) => like(cycle.nearestPoint(q)),
    worstPoint: () => points.reduce((w, p) => (p.error > (w?.error ?? -1) ? p : w), null),
  };
}

/** A frame at a place in pixels, y down. */
function frameAt([x, y], deg, long) {
  const [cos, sin] = [Math.cos(deg / DEGREES), Math.sin(deg / DEGREES)];
  /** @returns {[number, number]} */
  const corner = ([u, v]) => [x + long * (cos * u - sin * v), y - long * (sin * u + cos * v)];
  return `${pathThrough(CORNERS.map(corner))}Z`;
}

/** The frames over a stage. */
export class Bodies {
  /** @param {{angle_deg: (number | null)[]}} target */
  constructor(target) {
    this.target = target;
    this.still = shape("g");
    this.now = shape("path", { class: "body-now" });
    this.long = 20;
  }

  /** Draws them on a stage that has just moved. @param {any} stage @param {any} joints null where the loop is open */
  draw(stage, joints) {
    // The stage maps the plane anew whenever it lays itself out.
    if (this.seen !== stage.toPixel) this.layOut(stage);
    const { frame_deg: frame } = stage.cycle.mechanism;
    const there = joints && frame !== undefined;
    setAll(this.now, { d: there ? frameAt(stage.toPixel(joints.P), bodyDeg(joints, frame), this.long) : "" });
  }

  layOut(stage) {
    if (!this.seen) {
      stage.svg.insertBefore(this.still, stage.moving);
      stage.svg.insertBefore(this.now, stage.labels);
      stage.place.querySelector(".legend")?.append(...this.keys());
    }
    this.seen = stage.toPixel;
    const poses = bodyPoses(stage.cycle, this.target);
    const spots = stage.cycle.points.map((point) => stage.toPixel(point.target));
    const across = [0, 1].map((axis) => spots.map((spot) => spot[axis]));
    const diagonal = Math.hypot(...across.map((list) => Math.max(...list) - Math.min(...list)));
    this.long = Math.min(Math.max(0.11 * diagonal, 22), 46);
    const turned = poses.map((_, i) => i).filter((i) => poses[i].wanted !== null);
    const last = turned.length - 1;
    const isStrong = (k) =>
      last < STRONG || Array.from({ length: STRONG }, (_, j) => Math.floor((j * last) / (STRONG - 1))).includes(k);
    const parts = { faint: "", reached: "", wanted: "" };
    turned.forEach((i, k) => {
      const { wanted, reached } = poses[i];
      const [x, y] = spots[i];
      if (!isStrong(k)) {
        const arm = 0.7 * this.long;
        parts.faint += `M${px(x)} ${px(y)}l${px(arm * Math.cos(wanted / DEGREES))} ${px(-arm * Math.sin(wanted / DEGREES))}`;
        return;
      }
      parts.wanted += frameAt(spots[i], wanted, this.long);
      const { reached: at } = stage.cycle.points[i];
      if (at && Number.isFinite(reached)) parts.reached += frameAt(stage.toPixel(at), reached, this.long);
    });
    this.still.replaceChildren(
      ...Object.entries(parts).map(([name, d]) => shape("path", { class: `body-${name}`, d })),
    );
  }

  keys() {
    const key = (name, text) =>
      element("span", {}, [
        shape("svg", { class: "stage", width: 22, height: 14, viewBox: "0 0 22 14", "aria-hidden": "true" }, [
          shape("path", { class: `body-${name}`, d: frameAt([3, 11], 0, 17) }),
        ]),
        text,
      ]);
    return [key("wanted", "body desired"), key("reached", "body generated")];
  }
}
