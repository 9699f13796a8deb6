// Linkages of several loops, six-bars and eight-bars: their motion is read from samples over a turn of the crank, and drawn
// with a plate for each link of three joints or more.

import { otherKinds } from "./kinematics.mjs";
import { SliderStage } from "./slider_stage.mjs";
import { awayFrom } from "./stage.mjs";
import { pathThrough, px, setAll, shape } from "./svg.mjs";

/** @typedef {[number, number]} Point */
/** @typedef {{names: string[], pivots: Point[], links: number[][], dyads: number[], rows: number[][]}} Track names: of the joints, the fixed pivots first, P the last; links: indices of their joints; dyads: of each link, 0 the crank; rows: over a turn, x and y of each moving joint, the transmission angle of each dyad, velocity and acceleration of P at one radian a second */

/** The weights of four neighbours in periodic cubic interpolation, at a share of the step between the second and the third. */
const weights = (f) => [
  ((2 - f) * f - 1) * f * 0.5,
  (f * f * (3 * f - 5) + 2) * 0.5,
  ((4 - 3 * f) * f + 1) * f * 0.5,
  (f - 1) * f * f * 0.5,
];

/** The row of a track at a crank angle. @param {number[][]} rows @param {number} angle radians */
function rowAt(rows, angle) {
  const n = rows.length;
  const turns = angle / (2 * Math.PI);
  const x = (turns - Math.floor(turns)) * n;
  const i = Math.floor(x);
  const near = [-1, 0, 1, 2].map((by) => rows[(i + by + n) % n]);
  const w = weights(x - i);
  return near[0].map((_, k) => near.reduce((sum, row, j) => sum + w[j] * row[k], 0));
}

/** The kernel of a track. @param {Track} track @returns {any} */
export function trackKernel(track) {
  const { names, pivots, rows } = track;
  const moving = names.length - pivots.length;
  const flat = (mu) => Math.min(mu, Math.PI - mu);
  const mus = (joints) => joints.row.slice(2 * moving, -4);
  return {
    track,
    solve(angle) {
      const row = rowAt(rows, angle);
      const places = [...pivots];
      for (let i = 0; i < moving; i += 1) places.push([row[2 * i], row[2 * i + 1]]);
      const at = (name) => places[names.indexOf(name)];
      return { C: at("C"), D: at("D"), P: at("P"), places, row };
    },
    mus,
    /** The transmission angle nearest to flat. */
    mu: (joints) => mus(joints).reduce((worst, mu) => (flat(mu) < flat(worst) ? mu : worst)),
    rates(joints, omega, alpha) {
      const [vx, vy, ax, ay] = joints.row.slice(-4);
      const along = (v, a) => a * omega * omega + v * alpha;
      return { vP: [vx * omega, vy * omega], aP: [along(vx, ax), along(vy, ay)], omega3: 0, omega4: 0 };
    },
  };
}

otherKinds.track = trackKernel;

/** The corners of the convex hull of a few points. @param {Point[]} points */
function hullOf(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain;
  };
  return [...half(sorted).slice(0, -1), ...half(sorted.reverse()).slice(0, -1)];
}

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
    const all = super.curves();
    if (!this.track || this.look === "target") return all;
    const path = (i) => pathThrough(this.circuit.map((joints) => (joints ? this.toPixel(joints.places[i]) : null)));
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
