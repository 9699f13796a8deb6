// The drawing that moves, of linkages with a slider too: their rail or rod and their block.

import { inner } from "./sliders.mjs";
import { Stage } from "./stage.mjs";
import { pathThrough, setAll, shape } from "./svg.mjs";

/** @typedef {import("./sliders.mjs").Point} Point */

/** The part of the slider's range that its rail or rod reaches beyond it. */
const BEYOND = 0.12;

/**
 * The rail or the rod: a point of it and its direction at a position, and how far it reaches along.
 * @param {any} k @param {any[]} circuit the joints along the circuit
 * @returns {{moves: boolean, reach: [number, number]}}
 */
function guideOf(k, circuit) {
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
function guideEnds(k, { reach }, joints) {
  const [from, along] = k.kind === "slider-crank" ? [k.Q, k.s] : [joints.C, joints.u];
  return reach.map((place) => [from[0] + along[0] * place, from[1] + along[1] * place]);
}

/** The outline of a block of 22 by 13 pixels along a direction of the plane. */
function outlineAt([x, y], [ux, uy]) {
  /** @returns {[number, number]} */
  const corner = (i, j) => [x + 11 * i * ux + 6.5 * j * uy, y - 11 * i * uy + 6.5 * j * ux];
  return `${pathThrough([corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)])}Z`;
}

/** A stage for every kind of linkage; four-bars it draws as a stage does. */
export class SliderStage extends Stage {
  makeMovingParts() {
    super.makeMovingParts();
    const line = (name) => shape("path", { class: name });
    Object.assign(this.parts, { rail: line("rail"), block: line("block") });
    this.moving.prepend(this.parts.rail);
    this.parts.pinA.before(this.parts.block);
  }

  show(cycle, closed) {
    const isGuided = "solve" in cycle.kernel;
    /** The rail or the rod; null of a four-bar. */
    this.guide = isGuided ? guideOf(cycle.kernel, cycle.circuit()) : null;
    const hasB = "B" in cycle.mechanism.linkage;
    this.parts.pinB.classList.toggle("absent", !hasB);
    this.letters.B.classList.toggle("absent", !hasB);
    for (const name of ["rail", "block"]) this.parts[name].classList.toggle("absent", !isGuided);
    // The foot on a rod is no pin.
    this.parts.pinD.classList.toggle("absent", !!this.guide?.moves);
    super.show(cycle, closed);
  }

  pivots() {
    return super.pivots().filter((pivot) => pivot);
  }

  /** The places of a position: A, B (D without one), C, D, P, and the two ends of the rail or the rod. */
  placesOf(joints) {
    const { guide } = this;
    if (!guide) return super.placesOf(joints);
    const [A, B = joints.D] = this.pivots();
    return [A, B, joints.C, joints.D, joints.P, ...guideEnds(this.cycle.kernel, guide, joints)];
  }

  drawLinks(places, joints) {
    if (!this.guide) {
      super.drawLinks(places, joints);
      return;
    }
    const { parts, guide } = this;
    const [a, b, c, d, p, ...ends] = places;
    const kernel = /** @type {any} */ (this.cycle.kernel);
    // An arm holds a block at its pivot.
    const bars = pathThrough([a, c]) + (guide.moves ? pathThrough([b, d]) : "");
    setAll(parts.bars, { d: bars });
    setAll(parts.barsInside, { d: bars });
    // The plate of a rod ends below P.
    const corner = guide.moves ? this.toPixel(belowPoint(kernel, joints)) : d;
    setAll(parts.coupler, { d: `${pathThrough([c, corner, p])}Z` });
    setAll(parts.rail, { d: pathThrough(ends) });
    setAll(parts.block, { d: outlineAt(d, guide.moves ? joints.u : kernel.s) });
  }
}

/** The foot of the perpendicular from P on the rod. @returns {Point} */
function belowPoint(kernel, { C, u }) {
  return [C[0] + u[0] * kernel.z[0], C[1] + u[1] * kernel.z[0]];
}
