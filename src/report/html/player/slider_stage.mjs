// The drawing that moves, of linkages with a slider too: their rail or rod and their block.

import { belowPoint, guideEnds, guideOf, outlineAt } from "./guide.mjs";
import { Stage } from "./stage.mjs";
import { pathThrough, setAll, shape } from "./svg.mjs";

/** A stage for every kind of linkage; four-bars it draws as a stage does. */
export class SliderStage extends Stage {
  makeMovingParts() {
    super.makeMovingParts();
    const line = (name) => shape("path", { class: name });
    Object.assign(this.parts, { rail: line("guide"), block: line("block") });
    this.moving.prepend(this.parts.rail);
    this.parts.pinA.before(this.parts.block);
  }

  show(cycle, closed) {
    const isGuided = "solve" in cycle.kernel && !("track" in cycle.kernel);
    /** The rail or the rod; null of a four-bar. */
    this.guide = isGuided ? guideOf(cycle.kernel, cycle.circuit()) : null;
    const hasB = "B" in cycle.mechanism.linkage || "track" in cycle.kernel;
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
