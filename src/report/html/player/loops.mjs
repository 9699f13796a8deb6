// The drawing that moves, of linkages of several loops too: a plate for each link of three joints or more.

import { SliderStage } from "./slider_stage.mjs";
import { awayFrom } from "./stage.mjs";
import { pathThrough, px, setAll, shape } from "./svg.mjs";
import { hullOf } from "./tracks.mjs";

/** @typedef {import("./tracks.mjs").Track} Track */

/** A stage for linkages of every kind. */
export class LoopsStage extends SliderStage {
  show(cycle, closed) {
    /** @type {{track?: Track}} */
    const { track } = cycle.mechanism;
    /** That of a linkage of several loops. */
    this.track = track;
    for (const part of this.own ?? []) part.remove();
    this.plates = [];
    /** The joints beside A, B, C, D, P, whose names have one letter. */
    this.further = [];
    this.parts.coupler.classList.toggle("absent", !!track);
    if (track) {
      this.plates = track.dyads.map((dyad) => shape("path", { class: `plate dyad${dyad}` }));
      track.names.forEach((name, joint) => {
        const [pin, letter] = [shape("circle", { class: "pin", r: 4.4 }), shape("text", { class: "letter" }, [name])];
        if (name.length > 1) this.further.push({ joint, pin, letter });
      });
      this.parts.bars.before(...this.plates);
      this.parts.P.before(...this.further.map(({ pin }) => pin));
      this.letters.P.before(...this.further.map(({ letter }) => letter));
    }
    this.own = [...this.plates, ...this.further.flatMap(({ pin, letter }) => [pin, letter])];
    super.show(cycle, closed);
  }

  pivots() {
    return this.track?.pivots ?? super.pivots();
  }

  /** The places of a position: A, B, C, D, P and, of several loops, those of all joints. */
  placesOf(joints) {
    if (!this.track) return super.placesOf(joints);
    return [...this.track.pivots.slice(0, 2), joints.C, joints.D, joints.P, ...joints.places];
  }

  curves() {
    /** @type {any[]} */
    const circuit = this.circuit;
    const all = super.curves();
    if (!this.track || this.look === "target") return all;
    const path = ({ joint }) => pathThrough(circuit.map((joints) => joints && this.toPixel(joints.places[joint])));
    return [shape("path", { class: "pin-path", d: this.further.map(path).join("") }), ...all];
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
    for (const { joint, pin, letter } of this.further) {
      const at = all[joint];
      const [x, y] = at;
      setAll(pin, { cx: px(x), cy: px(y) });
      const beside = links.flatMap((link) => (link.includes(joint) ? link.map((other) => all[other]) : []));
      const [ax, ay] = awayFrom(at, beside);
      setAll(letter, { x: px(x + 17 * ax), y: px(y + 17 * ay + 5) });
    }
  }
}
