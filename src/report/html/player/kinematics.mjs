// Positions, velocities and accelerations of linkages of one loop: four-bars in natural coordinates, and the kinds that
// other modules add (sliders.mjs).
//
// The same equations as the Rust kernel (position.rs, motion.rs, transmission.rs of the four-bar; Romero Nunez 2016,
// equations 10 to 19; De Castro 8 to 24), in the same order, so that they agree to rounding. tests/browser holds them
// beside each other. Angles are in radians here, points are [x, y].

/** @typedef {[number, number]} Point */
/** @typedef {{A: Point, B: Point, a: number, b: number, c: number, d: number, e: number, t1: number, t2: number}} FourBar */
/** @typedef {FourBar | import("./sliders.mjs").Slider} Linkage */
/** @typedef {{C: Point, D: Point, P: Point, u?: Point}} Joints u: the direction of a slider's coupler */
/** @typedef {{A: Point, B: Point, a: number, b: number, c: number, couplerSq: number, halfDifference: number, z: Point}} FourBarKernel */
/** @typedef {{vP: Point, aP: Point, omega3: number, omega4: number}} Rates */
/** @typedef {{solve: (angle: number, t1: number) => Joints | null, mus?: (joints: any) => number[], mu: (joints: any) => number, rates: (joints: any, omega: number, alpha: number) => Rates | null}} OtherKernel what positionAt, transmissionAngle and motionAt ask of a kind beside the four-bar */
/** @typedef {FourBarKernel & Partial<OtherKernel>} Kernel */

/** The kinds of linkages beside the four-bar: the kernel of a linkage, by its key `kind`. @type {Record<string, (linkage: any) => any>} */
export const otherKinds = {};

/** A loop that misses closure by less than this part of its scale is taken as flat. */
export const FLAT_TOLERANCE = 1e-12;
/** |sin mu| at and below which a position counts as a toggle. */
const TOGGLE_SINE = 1e-12;
/** The same for sin^2 mu, as a part of (b^2 + c^2 + s (|A| + |B| + a))/(b c). */
const TOGGLE_ROUNDING = 64 * Number.EPSILON;

/**
 * The numbers that the equations multiply with; of a four-bar z = (l2 + i h2)/b, so that P = C + z (D - C).
 * @param {any} linkage a Linkage
 * @returns {Kernel}
 */
export function kernelOf(linkage) {
  const other = otherKinds[linkage.kind];
  if (other) return other(linkage);
  const { A, B, a, b, c, d, e, t2 } = linkage;
  const along = (b + ((d - e) * (d + e)) / b) / 2;
  let areaSq = b + d + e;
  for (const lack of [b + d - e, d + e - b, e + b - d]) areaSq *= Math.max(lack, 0);
  const across = (t2 * Math.sqrt(areaSq)) / (2 * b);
  return { A, B, a, b, c, couplerSq: b * b, halfDifference: 0.5 * (b * b - c * c), z: [along / b, across / b] };
}

/**
 * The joints at a crank angle; null where the loop is open.
 * @param {Kernel} k
 * @param {number} angle crank angle from the x axis
 * @param {number} t1 1: D lies left of the line from C to B
 * @returns {Joints | null}
 */
export function positionAt(k, angle, t1) {
  if (k.solve) return k.solve(angle, t1);
  const cx = k.A[0] + k.a * Math.cos(angle);
  const cy = k.A[1] + k.a * Math.sin(angle);
  const vx = k.B[0] - cx;
  const vy = k.B[1] - cy;
  const inverse = 1 / (vx * vx + vy * vy);
  const u = 0.5 + k.halfDifference * inverse;
  const reach = k.couplerSq * inverse;
  const gap = reach - u * u;
  if (!(gap + FLAT_TOLERANCE * reach >= 0)) return null;
  const root = t1 * Math.sqrt(Math.max(gap, 0));
  const wx = vx * u - vy * root;
  const wy = vy * u + vx * root;
  const px = cx + k.z[0] * wx - k.z[1] * wy;
  const py = cy + k.z[0] * wy + k.z[1] * wx;
  return Number.isFinite(px) && Number.isFinite(py) ? { C: [cx, cy], D: [cx + wx, cy + wy], P: [px, py] } : null;
}

/**
 * The transmission angle in [0, pi], by half angles.
 * @param {Kernel} k
 * @param {Joints} joints
 */
export function transmissionAngle(k, joints) {
  if (k.mu) return k.mu(joints);
  const s = Math.hypot(k.B[0] - joints.C[0], k.B[1] - joints.C[1]);
  const near = Math.max((s - (k.b - k.c)) * (s + (k.b - k.c)), 0);
  const far = Math.max((k.b + k.c - s) * (k.b + k.c + s), 0);
  return 2 * Math.atan2(Math.sqrt(near), Math.sqrt(far));
}

/**
 * Velocity and acceleration of P and the turning of coupler and follower; null at a toggle.
 * @param {Kernel} k
 * @param {Joints} joints
 * @param {number} omega speed of the crank, rad/s
 * @param {number} alpha acceleration of the crank, rad/s^2
 * @returns {Rates | null}
 */
export function motionAt(k, joints, omega, alpha) {
  if (k.rates) return k.rates(joints, omega, alpha);
  const { C, D } = joints;
  const [wx, wy] = [D[0] - C[0], D[1] - C[1]];
  const [rx, ry] = [D[0] - k.B[0], D[1] - k.B[1]];
  const [armX, armY] = [C[0] - k.A[0], C[1] - k.A[1]];
  const bc = k.b * k.c;
  const sine = (wx * -ry + wy * rx) / bc;
  const s = Math.sqrt((k.B[0] - C[0]) ** 2 + (k.B[1] - C[1]) ** 2);
  const fromOrigin = Math.sqrt(k.A[0] ** 2 + k.A[1] ** 2) + Math.sqrt(k.B[0] ** 2 + k.B[1] ** 2) + k.a;
  const rounding = (TOGGLE_ROUNDING * (k.b * k.b + k.c * k.c + s * fromOrigin)) / bc;
  if (Math.abs(sine) <= TOGGLE_SINE || sine * sine <= rounding) return null;
  const inverse = 1 / (bc * sine);
  // <w, X> = p and <r, X> = q.
  const solve = (p, q) => [(-ry * p + wy * q) * inverse, (rx * p - wx * q) * inverse];
  const [vCx, vCy] = [-armY * omega, armX * omega];
  const vD = solve(wx * vCx + wy * vCy, 0);
  const [vWx, vWy] = [vD[0] - vCx, vD[1] - vCy];
  const [aCx, aCy] = [-armY * alpha - armX * (omega * omega), armX * alpha - armY * (omega * omega)];
  const aD = solve(wx * aCx + wy * aCy - (vWx * vWx + vWy * vWy), -(vD[0] * vD[0] + vD[1] * vD[1]));
  const [aWx, aWy] = [aD[0] - aCx, aD[1] - aCy];
  const [zx, zy] = k.z;
  return {
    vP: [vCx + zx * vWx - zy * vWy, vCy + zx * vWy + zy * vWx],
    aP: [aCx + zx * aWx - zy * aWy, aCy + zx * aWy + zy * aWx],
    omega3: (-wy * vWx + wx * vWy) / (k.b * k.b),
    omega4: (-ry * vD[0] + rx * vD[1]) / (k.c * k.c),
  };
}
