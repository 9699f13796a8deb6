// What guides a slider: its rail, or the rod that runs through its block, and the block itself.

import { inner } from "./sliders.mjs";
import { pathThrough } from "./svg.mjs";

/** @typedef {import("./sliders.mjs").Point} Point */

/** The part of the slider's range that its rail or rod reaches beyond it. */
const BEYOND = 0.12;

/**
 * The rail or the rod: a point of it and its direction at a position, and how far it reaches along.
 * @param {any} k @param {any[]} circuit the joints along the circuit
 * @returns {{moves: boolean, reach: [number, number]}}
 */
export function guideOf(k, circuit) {
  const rail = k.kind === "slider-crank";
  let [low, high] = rail ? [Infinity, -Infinity] : [0, 0];
  for (const joints of circuit) {
    if (!joints) continue;
    const from = rail ? k.Q : joints.C;
    const place = inner(rail ? k.s : joints.u, [joints.D[0] - from[0], joints.D[1] - from[1]]);
    [low, high] = [Math.min(low, place), Math.max(high, place)];
  }
  const more = BEYOND * (high - low);
  return {
    moves: !rail,
    reach: rail ? [low - more, high + more] : [low < 0 ? low - more : 0, high > 0 ? high + more : 0],
  };
}

/** The two ends of the rail or the rod at a position. @param {any} k @param {{reach: [number, number]}} guide @param {any} joints @returns {Point[]} */
export function guideEnds(k, { reach }, joints) {
  const [from, along] = k.kind === "slider-crank" ? [k.Q, k.s] : [joints.C, joints.u];
  return reach.map((place) => [from[0] + along[0] * place, from[1] + along[1] * place]);
}

/** The outline of a block of 22 by 13 pixels, or so many times as large, along a direction of the plane. */
export function outlineAt([x, y], [ux, uy], scale = 1) {
  /** @returns {[number, number]} */
  const corner = (i, j) => [x + scale * (11 * i * ux + 6.5 * j * uy), y - scale * (11 * i * uy - 6.5 * j * ux)];
  return `${pathThrough([corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)])}Z`;
}

/** The foot of the perpendicular from P on the rod. @returns {Point} */
export function belowPoint(kernel, { C, u }) {
  return [C[0] + u[0] * kernel.z[0], C[1] + u[1] * kernel.z[0]];
}
