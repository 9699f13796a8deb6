// A mechanism made ready to be shown: its kernel, where its points lie on the motion, its curves over the motion.

import { inputAt, isCyclic, placeOf, rangeOf, usedOf } from "./drive.mjs";
import { kernelOf, motionAt, positionAt, transmissionAngle } from "./kinematics.mjs";
import { trackKernel } from "./tracks.mjs";

/** @typedef {{key: string, name: string, linkage: import("./kinematics.mjs").Linkage, drive: import("./drive.mjs").Drive, crank_deg: number[], t1_at?: number[], frame_deg?: number, worst?: number, track?: any}} Mechanism track: of a linkage of several loops (tracks.mjs) */
/** @typedef {{number: number, target: [number, number], reached: [number, number] | null, error: number, crankDeg: number, place: number | null, tolerance: number | null}} PathPoint */
/** @typedef {{q: number, joints: import("./kinematics.mjs").Joints, mu: number, mus?: number[], v: [number, number] | null, a: [number, number] | null}} Sample */

/** Positions over the motion: one a degree. */
const SAMPLES = 360;
/** Positions of a curve in the drawing. */
const CURVE_SAMPLES = 720;

/** A mechanism over a target. */
export class Cycle {
  /** @param {Mechanism} mechanism @param {{points: [number, number][], numbers?: number[], tolerance?: number[]}} target */
  constructor(mechanism, target) {
    this.mechanism = mechanism;
    this.drive = mechanism.drive;
    this.kernel = mechanism.track ? trackKernel(mechanism.track) : kernelOf(mechanism.linkage);
    this.range = rangeOf(this.drive);
    this.cyclic = isCyclic(this.drive);
    this.moves = this.drive.kind !== "none";
    /** @type {PathPoint[]} */
    this.points = target.points.map((at, i) => {
      const crankDeg = mechanism.crank_deg[i];
      const t1 = mechanism.t1_at?.[i] ?? this.drive.t1;
      const joints = crankDeg === undefined ? null : positionAt(this.kernel, (crankDeg * Math.PI) / 180, t1);
      const reached = joints ? joints.P : null;
      return {
        number: target.numbers?.[i] ?? i,
        target: at,
        reached,
        error: reached ? Math.hypot(reached[0] - at[0], reached[1] - at[1]) : NaN,
        crankDeg,
        place: crankDeg === undefined ? null : placeOf(this.drive, crankDeg, t1),
        tolerance: target.tolerance?.[i] ?? null,
      };
    });
    this.used = usedOf(
      this.drive,
      mechanism.crank_deg,
      this.points.map((point) => point.place),
    );
    this.start = this.points.find((point) => point.place !== null)?.place ?? (this.range[0] + this.range[1]) / 2;
    /** Which way the crank turns along the points: 1 or -1. */
    this.sense = senseOf(mechanism.crank_deg);
  }

  /** The joints at q; null where the loop is open. @param {number} q */
  at(q) {
    const { angle, t1 } = inputAt(this.drive, q);
    return positionAt(this.kernel, angle, t1);
  }

  /** The crank angle at q, degrees. @param {number} q */
  crankDeg(q) {
    return (inputAt(this.drive, q).angle * 180) / Math.PI;
  }

  /** Everything at q, with the crank at one radian a second. @param {number} q @returns {Sample | null} */
  sample(q) {
    const joints = this.at(q);
    if (!joints) return null;
    const motion = motionAt(this.kernel, joints, 1, 0);
    const mu = (transmissionAngle(this.kernel, joints) * 180) / Math.PI;
    const mus = this.kernel.mus?.(joints).map((angle) => (angle * 180) / Math.PI);
    return { q, joints, mu, mus, v: motion ? motion.vP : null, a: motion ? motion.aP : null };
  }

  /** Samples over the whole motion, first and last included. @returns {(Sample | null)[]} */
  samples() {
    const [low, high] = this.range;
    return Array.from({ length: SAMPLES + 1 }, (_, i) => this.sample(low + ((high - low) * i) / SAMPLES));
  }

  /** The joints along the whole circuit, for its curves. */
  circuit() {
    return Array.from({ length: CURVE_SAMPLES + 1 }, (_, i) => this.onCircuit(i));
  }

  /** The joints at a place on the whole circuit, in parts of CURVE_SAMPLES. @param {number} i */
  onCircuit(i) {
    const drive = this.drive.kind === "rock" ? { ...this.drive, kind: /** @type {const} */ ("through") } : this.drive;
    const { angle, t1 } = inputAt(drive, (360 * i) / CURVE_SAMPLES);
    return positionAt(this.kernel, angle, t1);
  }

  /**
   * The curve of P in and around a box, each step cut into `parts`; null where it is elsewhere.
   * @param {number[]} box left, bottom, right, top @param {number} parts
   */
  curveNear(box, parts) {
    const [w, h] = [box[2] - box[0], box[3] - box[1]];
    const holds = (joints) =>
      joints &&
      joints.P[0] > box[0] - w &&
      joints.P[0] < box[2] + w &&
      joints.P[1] > box[1] - h &&
      joints.P[1] < box[3] + h;
    const curve = [];
    for (let i = 0; i < CURVE_SAMPLES; i += 1) {
      if (!holds(this.onCircuit(i)) && !holds(this.onCircuit(i + 1))) {
        curve.push(null);
        continue;
      }
      for (let j = 0; j <= parts; j += 1) curve.push(this.onCircuit(i + j / parts)?.P ?? null);
    }
    return curve;
  }

  /** Whether q lies in the part that the points use. @param {number} q */
  isUsed(q) {
    if (!this.used) return false;
    const [from, to] = this.used;
    return (q >= from && q <= to) || (this.cyclic && q + 360 >= from && q + 360 <= to);
  }

  /** The point that is passed nearest to q; null without any. @param {number} q @returns {PathPoint | null} */
  nearestPoint(q) {
    let best = null;
    let least = Infinity;
    for (const point of this.points) {
      if (point.place === null) continue;
      let apart = Math.abs(point.place - q);
      if (this.cyclic) apart = Math.min(apart, 360 - apart);
      if (apart < least) [best, least] = [point, apart];
    }
    return best;
  }

  /** The point with the largest error; null without any. @returns {PathPoint | null} */
  worstPoint() {
    const named = this.points.find((point) => point.number === this.mechanism.worst);
    if (named) return named;
    return this.points.reduce((w, p) => (!(p.error <= (w?.error ?? -1)) && p.error >= 0 ? p : w), null);
  }
}

/** @param {number[]} crankDeg */
function senseOf(crankDeg) {
  let sum = 0;
  for (let i = 1; i < crankDeg.length; i += 1) sum += Math.sign(crankDeg[i] - crankDeg[i - 1]);
  return sum < 0 ? -1 : 1;
}
