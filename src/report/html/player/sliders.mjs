// Positions, velocities and accelerations of slider-cranks and inverted slider-cranks.
//
// The same equations as the Rust kernels (slider_crank, inverted_slider_crank): C = A + a e, P = C + Z u, and u from the
// closure Im((C + b u - Q) conj s) = 0, or Im((B - C) conj u) = h. D is the slider's pin, or the foot of the perpendicular
// from B on the rod. Angles are in radians here, points are [x, y].

import { FLAT_TOLERANCE, otherKinds } from "./kinematics.mjs";

/** @typedef {[number, number]} Point */
/** @typedef {{kind: "slider-crank", A: Point, a: number, b: number, line_point: Point, line_deg: number, coupler_x: number, coupler_y: number, t1: number}} SliderCrank */
/** @typedef {{kind: "inverted-slider-crank", A: Point, B: Point, a: number, offset: number, coupler_x: number, coupler_y: number, t1: number}} InvertedSliderCrank */
/** @typedef {SliderCrank | InvertedSliderCrank} Slider */
/** @typedef {{kind: string, A: Point, B?: Point, a: number, b: number, Q: Point, s: Point, h: number, z: Point} & import("./kinematics.mjs").OtherKernel} SliderKernel */
/** @typedef {{C: Point, D: Point, P: Point, u: Point}} SliderJoints */

/** The sine of the transmission angle at and below which a position counts as a toggle. */
const SLIDER_TOGGLE = 1e-7;

/** The inner product of two vectors. */
export const inner = (p, q) => p[0] * q[0] + p[1] * q[1];
const outer = (p, q) => p[0] * q[1] - p[1] * q[0];

/** @param {any} linkage @returns {SliderKernel} */
function sliderOf(linkage) {
  const { kind, A, B, a, b, line_point = [0, 0], line_deg = 0, offset = 0, coupler_x, coupler_y } = linkage;
  const angle = (line_deg * Math.PI) / 180;
  /** @type {SliderKernel} */
  const kernel = {
    kind,
    A,
    B,
    a,
    b,
    Q: line_point,
    s: [Math.cos(angle), Math.sin(angle)],
    h: offset,
    z: [coupler_x, coupler_y],
    solve: (angle, t1) => sliderAt(kernel, angle, t1),
    mu: (joints) => sliderMu(kernel, joints),
    rates: (joints, omega, alpha) => sliderRates(kernel, joints, omega, alpha),
  };
  return kernel;
}

for (const kind of ["slider-crank", "inverted-slider-crank"]) otherKinds[kind] = sliderOf;

/**
 * The joints at a crank angle, with the coupler's direction u; null where the loop is open.
 * @param {any} k @param {number} angle @param {number} t1
 * @returns {SliderJoints | null}
 */
function sliderAt(k, angle, t1) {
  /** @type {Point} */
  const C = [k.A[0] + k.a * Math.cos(angle), k.A[1] + k.a * Math.sin(angle)];
  /** @type {Point} */
  let u;
  /** @type {Point} */
  let D;
  if (k.kind === "slider-crank") {
    const v = [C[0] - k.Q[0], C[1] - k.Q[1]];
    const h = outer(k.s, v) / k.b;
    const left = (1 - h) * (1 + h);
    if (!(left + FLAT_TOLERANCE >= 0)) return null;
    const root = t1 * Math.sqrt(Math.max(left, 0));
    u = [k.s[0] * root + k.s[1] * h, k.s[1] * root - k.s[0] * h];
    const place = inner(k.s, v) + k.b * root;
    D = [k.Q[0] + k.s[0] * place, k.Q[1] + k.s[1] * place];
  } else {
    const v = [k.B[0] - C[0], k.B[1] - C[1]];
    const sq = inner(v, v);
    const left = sq - k.h * k.h;
    if (!(left + FLAT_TOLERANCE * sq >= 0) || sq === 0) return null;
    const root = t1 * Math.sqrt(Math.max(left, 0));
    u = [(v[0] * root + v[1] * k.h) / sq, (v[1] * root - v[0] * k.h) / sq];
    D = [C[0] + u[0] * root, C[1] + u[1] * root];
  }
  /** @type {Point} */
  const P = [C[0] + k.z[0] * u[0] - k.z[1] * u[1], C[1] + k.z[0] * u[1] + k.z[1] * u[0]];
  return Number.isFinite(P[0]) && Number.isFinite(P[1]) ? { C, D, P, u } : null;
}

/** The transmission angle in [0, pi/2]. @param {any} k @param {any} joints */
function sliderMu(k, { C, u }) {
  if (k.kind === "slider-crank") return Math.atan2(Math.abs(inner(k.s, u)), Math.abs(outer(k.s, u)));
  return Math.atan2(Math.abs(inner(u, [k.B[0] - C[0], k.B[1] - C[1]])), Math.abs(k.h));
}

/**
 * Velocity and acceleration of P and the turning of the coupler; null at a toggle.
 * @param {any} k @param {any} joints @param {number} omega rad/s @param {number} alpha rad/s^2
 * @returns {{vP: Point, aP: Point, omega3: number, omega4: number} | null}
 */
function sliderRates(k, joints, omega, alpha) {
  const { C, P, u } = joints;
  if (Math.sin(sliderMu(k, joints)) <= SLIDER_TOGGLE) return null;
  const arm = [C[0] - k.A[0], C[1] - k.A[1]];
  const vC = [-arm[1] * omega, arm[0] * omega];
  const aC = [-arm[1] * alpha - arm[0] * omega * omega, arm[0] * alpha - arm[1] * omega * omega];
  let omega3;
  let alpha3;
  if (k.kind === "slider-crank") {
    const per = 1 / (k.b * inner(k.s, u));
    omega3 = -outer(k.s, vC) * per;
    alpha3 = (k.b * omega3 * omega3 * outer(k.s, u) - outer(k.s, aC)) * per;
  } else {
    const per = 1 / inner(u, [k.B[0] - C[0], k.B[1] - C[1]]);
    omega3 = -outer(u, vC) * per;
    alpha3 = (2 * omega3 * inner(u, vC) - omega3 * omega3 * k.h - outer(u, aC)) * per;
  }
  const z = [P[0] - C[0], P[1] - C[1]];
  return {
    vP: [vC[0] - omega3 * z[1], vC[1] + omega3 * z[0]],
    aP: [aC[0] - alpha3 * z[1] - omega3 * omega3 * z[0], aC[1] + alpha3 * z[0] - omega3 * omega3 * z[1]],
    omega3,
    // The block of an inverted one turns with the rod.
    omega4: k.kind === "slider-crank" ? 0 : omega3,
  };
}
