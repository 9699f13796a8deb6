// The drawing that moves, of linkages of several loops too: a plate for each link of three joints or more.

import { SliderStage } from "./slider_stage.mjs";
import { awayFrom } from "./stage.mjs";
import { pathThrough, px, setAll, shape } from "./svg.mjs";
import { hullOf } from "./tracks.mjs";

/** @typedef {import("./tracks.mjs").Track} Track */

/** A stage for linkages of every kind. */
export class LoopsStage extends SliderStage {
  show(cycle, closed) {
    /** The track of a linkage of several loops; null of one loop. @type {Track | null} */
    this.track = cycle.mechanism.track ?? null;
    for (const part of this.further ?? []) part.remove();
    this.further = [];
    this.furtherLetters = {};
    this.plates = [];
    this.parts.coupler.classList.toggle("absent", !!this.track);
    if (this.track) {
      const { names, links, dyads } = this.track;
      this.rest = names.map((_, i) => i).filter((i) => !["A", "B", "C", "D", "P"].includes(names[i]));
      this.plates = links.map((_, i) => shape("path", { class: `plate dyad${dyads[i]}` }));
      this.parts.bars.before(...this.plates);
      const pins = this.rest.map(() => shape("circle", { class: "pin", r: 4.4 }));
      this.pins = pins;
      this.parts.P.before(...pins);
      for (const i of this.rest) this.furtherLetters[i] = shape("text", { class: "letter" }, [names[i]]);
      this.letters.P.before(...Object.values(this.furtherLetters));
      this.further = [...this.plates, ...pins, ...Object.values(this.furtherLetters)];
    }
    super.show(cycle, closed);
  }

  pivots() {
    return this.track ? this.track.pivots : super.pivots();
  }

  /** The places of a position: A, B, C, D, P and, of several loops, those of all joints. */
  placesOf(joints) {
    if (!this.track) return super.placesOf(joints);
    return [this.track.pivots[0], this.track.pivots[1], joints.C, joints.D, joints.P, ...joints.places];
  }

  curves() {
    /** @type {any[]} */
    const circuit = this.circuit;
    const all = super.curves();
    if (!this.track || this.look === "target") return all;
    const path = (i) => pathThrough(circuit.map((joints) => (joints ? this.toPixel(joints.places[i]) : null)));
    return [shape("path", { class: "pin-path", d: this.rest.map(path).join("") }), ...all];
  }

  drawLinks(places, joints) {
    if (!this.track) {
      super.drawLinks(places, joints);
      return;
    }
    const { links } = this.track;
    const all = places.slice(5);
    let bars = "";
    links.forEach((link, i) => {
      const corners = link.map((joint) => all[joint]);
      if (corners.length < 3) bars += pathThrough(corners);
      setAll(this.plates[i], { d: corners.length < 3 ? "" : `${pathThrough(hullOf(corners))}Z` });
    });
    for (const bar of [this.parts.bars, this.parts.barsInside]) setAll(bar, { d: bars });
    this.rest.forEach((joint, i) => {
      const [x, y] = all[joint];
      setAll(this.pins[i], { cx: px(x), cy: px(y) });
      const beside = links.filter((link) => link.includes(joint)).flatMap((link) => link.map((other) => all[other]));
      const [ax, ay] = awayFrom(
        all[joint],
        beside.filter((other) => other !== all[joint]),
      );
      setAll(this.furtherLetters[joint], { x: px(x + 17 * ax), y: px(y + 17 * ay + 5) });
    });
  }
}
