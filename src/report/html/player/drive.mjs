// The one parameter q, in degrees, that moves a mechanism.
//
// turn      q is the crank angle, the crank turns fully
// rock      q is the crank angle, between middle - halfWidth and middle + halfWidth, on one assembly
// through   crank angle = middle + halfWidth sin q, t1 = sign of cos q: the motion passes both toggles
// none      the links cannot be joined

/** @typedef {{kind: "turn" | "rock" | "through" | "none", middle_deg: number, half_width_deg: number, t1: number}} Drive */

const DEGREE = Math.PI / 180;
/** A rocking crank stops this part of its range before the toggle, where the motion is undecided. */
const BEFORE_TOGGLE = 1e-6;

/** An angle brought to (-180, 180]. @param {number} deg */
export function wrappedDeg(deg) {
  const turned = deg - 360 * Math.round(deg / 360);
  return turned <= -180 ? turned + 360 : turned;
}

/** An angle brought to [0, 360). @param {number} deg */
export function positiveDeg(deg) {
  const turned = deg % 360;
  return turned < 0 ? turned + 360 : turned;
}

/** Whether q comes back to itself after 360 degrees. @param {Drive} drive */
export const isCyclic = (drive) => drive.kind === "turn" || drive.kind === "through";

/** The least and the greatest q. @param {Drive} drive @returns {[number, number]} */
export function rangeOf(drive) {
  if (isCyclic(drive)) return [0, 360];
  const half = drive.half_width_deg * (1 - BEFORE_TOGGLE);
  return [drive.middle_deg - half, drive.middle_deg + half];
}

/** q brought into its range. @param {Drive} drive @param {number} q */
export function within(drive, q) {
  if (isCyclic(drive)) return positiveDeg(q);
  const [low, high] = rangeOf(drive);
  return Math.min(Math.max(q, low), high);
}

/** Crank angle (radians) and assembly at q. @param {Drive} drive @param {number} q */
export function inputAt(drive, q) {
  if (drive.kind !== "through") return { angle: q * DEGREE, t1: drive.t1 };
  const psi = q * DEGREE;
  return {
    angle: (drive.middle_deg + drive.half_width_deg * Math.sin(psi)) * DEGREE,
    t1: Math.cos(psi) >= 0 ? 1 : -1,
  };
}

/**
 * q of a crank angle (degrees) and an assembly; null where this motion does not pass there.
 * @param {Drive} drive @param {number} crankDeg @param {number} t1
 * @returns {number | null}
 */
export function placeOf(drive, crankDeg, t1) {
  if (drive.kind === "turn") return t1 === drive.t1 ? positiveDeg(crankDeg) : null;
  const offset = wrappedDeg(crankDeg - drive.middle_deg);
  // Points at a toggle may lie beyond it by rounding; farther away is another circuit.
  if (drive.kind === "none" || Math.abs(offset) > drive.half_width_deg * (1 + 1e-6) + 1e-6) return null;
  if (drive.kind === "rock") return t1 === drive.t1 ? within(drive, drive.middle_deg + offset) : null;
  const psi = Math.asin(Math.max(-1, Math.min(1, offset / drive.half_width_deg))) / DEGREE;
  return positiveDeg(t1 > 0 ? psi : 180 - psi);
}

/**
 * The stretch of q that the points use: [from, to], `to` may exceed 360 where the motion is cyclic; null without points.
 * @param {Drive} drive @param {number[]} crankDeg in the order of the points, unwrapped @param {(number | null)[]} places
 * @returns {[number, number] | null}
 */
export function usedOf(drive, crankDeg, places) {
  const there = places.filter((q) => q !== null);
  if (there.length === 0) return null;
  if (drive.kind === "rock") return [Math.min(...there), Math.max(...there)];
  if (drive.kind === "through") return [0, 360];
  const [low, high] = [Math.min(...crankDeg), Math.max(...crankDeg)];
  const from = positiveDeg(low);
  return [from, from + Math.min(high - low, 360)];
}

/**
 * q where the crank was dragged to an angle (degrees): the nearest that can be reached from `q`, on towards `sense`.
 * @param {Drive} drive @param {number} q @param {number} crankDeg @param {number} sense 1 or -1
 */
export function draggedTo(drive, q, crankDeg, sense) {
  if (drive.kind === "turn") return positiveDeg(crankDeg);
  const offset = wrappedDeg(crankDeg - drive.middle_deg);
  if (drive.kind === "rock") return within(drive, drive.middle_deg + offset);
  const psi = Math.asin(Math.max(-1, Math.min(1, offset / drive.half_width_deg))) / DEGREE;
  const ahead = q + 2 * sense;
  const apart = (other) => Math.abs(wrappedDeg(other - ahead));
  return positiveDeg(apart(psi) <= apart(180 - psi) ? psi : 180 - psi);
}
