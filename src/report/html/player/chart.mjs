// Charts over the motion and along the points, with a cursor that the animation moves.

import { angleTicks, element, figure, pathThrough, px, setAll, shape, ticks, tickTexts } from "./svg.mjs";

/** Pixels left of, right of, above and below the area of a chart. */
const LEFT = 56;
const RIGHT = 16;
const TOP = 10;
const BOTTOM = 24;

/** What every chart has: a title with a reading beside it, a frame, and a width that follows its place. */
class Chart {
  /** Charts so far: the ids of their clips. */
  static count = 0;

  /** @param {HTMLElement} place @param {{title: string, height: number}} options */
  constructor(place, { title, height }) {
    this.height = height;
    this.reading = element("span", { class: "reading" });
    this.note = element("small", {});
    this.name = title;
    this.title = element("span", {}, [title, this.note]);
    this.svg = shape("svg", { class: "chart", role: "img" });
    this.figure = element("figure", { class: "chart-box" }, [
      element("figcaption", {}, [this.title, this.reading]),
      this.svg,
    ]);
    place.append(this.figure);
    if (typeof ResizeObserver !== "undefined") {
      new ResizeObserver(() => {
        if (Math.abs(this.figure.clientWidth - (this.width ?? 0)) > 1) this.draw();
      }).observe(this.figure);
    }
  }

  /** Draws it anew, for the width that there is. */
  draw() {}

  /** Takes the width that there is. */
  measure() {
    this.width = Math.max(this.figure.clientWidth || 420, 220);
    setAll(this.svg, { viewBox: `0 0 ${this.width} ${this.height}`, width: this.width, height: this.height });
  }

  /** @param {string} text */
  describe(text) {
    setAll(this.svg, { "aria-label": text });
  }

  /** Grid lines and numbers of the vertical axis from `low` to `high`. */
  frame(low, high, lines) {
    const texts = tickTexts(lines);
    const y = (value) => this.y(value, low, high);
    const parts = lines.map((value) =>
      shape("path", { class: value === 0 ? "axis" : "grid", d: `M${LEFT} ${px(y(value))}H${px(this.width - RIGHT)}` }),
    );
    const numbers = lines.map((value, i) =>
      shape("text", { class: "tick", x: LEFT - 8, y: px(y(value) + 4), "text-anchor": "end" }, [texts[i]]),
    );
    return [...parts, ...numbers];
  }

  y(value, low, high) {
    return this.height - BOTTOM - ((this.height - TOP - BOTTOM) * (value - low)) / (high - low || 1);
  }

  bottomTicks(values, texts, x) {
    const base = this.height - BOTTOM;
    const lines = shape("path", {
      class: "axis",
      d: `M${LEFT} ${base}H${px(this.width - RIGHT)}${values.map((v) => `M${px(x(v))} ${base}v4`).join("")}`,
    });
    return [
      lines,
      ...values.map((v, i) =>
        shape("text", { class: "tick", x: px(x(v)), y: base + 17, "text-anchor": "middle" }, [texts[i]]),
      ),
    ];
  }
}

/** Curves over q. */
export class CycleChart extends Chart {
  /**
   * @param {HTMLElement} place
   * @param {{title: string, height: number, low?: number, high?: number, lines: {name: string, kind: string, of: (sample: any) => number}[],
   *   read: (sample: any) => string, onPick: (q: number) => void}} options
   */
  constructor(place, options) {
    super(place, options);
    this.options = options;
    /** @type {import("./cycle.mjs").Cycle | undefined} */
    this.cycle = undefined;
    /** @type {(import("./cycle.mjs").Sample | null)[]} */
    this.samples = [];
    /** @type {number[]} */
    this.levels = [];
    const pick = (event) => {
      if (!this.cycle) return;
      const box = this.svg.getBoundingClientRect();
      const at = ((event.clientX - box.left) * this.width) / box.width;
      const [low, high] = this.cycle.range;
      const part = Math.min(Math.max((at - LEFT) / (this.width - LEFT - RIGHT), 0), 1);
      options.onPick(low + part * (high - low));
    };
    this.svg.addEventListener("pointerdown", (event) => {
      this.svg.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (this.svg.hasPointerCapture(event.pointerId)) pick(event);
    });
  }

  /**
   * @param {import("./cycle.mjs").Cycle} cycle @param {any[]} samples
   * @param {number[]} [levels] dashed lines @param {string} [note] what they are
   */
  show(cycle, samples, levels = [], note = "") {
    this.note.textContent = note;
    Object.assign(this, { cycle, samples, levels });
    this.draw();
  }

  /** The vertical range: that of the values, but not the peaks at a toggle. */
  extent() {
    const values = [];
    const used = [];
    for (const sample of this.samples) {
      if (!sample) continue;
      for (const line of this.options.lines) {
        const value = line.of(sample);
        if (!Number.isFinite(value)) continue;
        values.push(value);
        if (this.cycle.drive.kind !== "rock" || this.cycle.isUsed(sample.q)) used.push(value);
      }
    }
    if (values.length === 0) return [0, 1];
    const by = (list, part) => [...list].sort((x, y) => x - y)[Math.round((list.length - 1) * part)];
    const toggles = this.cycle.drive.kind === "rock" || this.cycle.drive.kind === "through";
    const base = used.length > 8 ? used : values;
    let [low, high] =
      toggles && base === values ? [by(values, 0.08), by(values, 0.92)] : [Math.min(...base), Math.max(...base)];
    if (this.cycle.drive.kind === "through") [low, high] = [by(values, 0.08), by(values, 0.92)];
    low = Math.min(low, 0);
    const margin = 0.06 * (high - low || 1);
    return [low < 0 ? low - margin : 0, high + margin];
  }

  draw() {
    if (!this.cycle) return;
    this.measure();
    const { cycle, samples } = this;
    const [from, to] = cycle.range;
    const [low, high] = this.options.high !== undefined ? [this.options.low ?? 0, this.options.high] : this.extent();
    const x = (q) => LEFT + ((this.width - LEFT - RIGHT) * (q - from)) / (to - from);
    this.x = x;
    const parts = [];
    const top = TOP;
    const tall = this.height - TOP - BOTTOM;
    const band = (a, b) =>
      b > a && parts.push(shape("rect", { class: "used", x: px(x(a)), y: top, width: px(x(b) - x(a)), height: tall }));
    if (cycle.used && cycle.used[1] - cycle.used[0] < to - from - 1) {
      band(Math.max(cycle.used[0], from), Math.min(cycle.used[1], to));
      if (cycle.cyclic) band(from, Math.min(cycle.used[1] - 360, to));
    }
    const lines = this.options.high !== undefined ? angleTicks(low, high, 5) : ticks(low, high, 4);
    parts.push(...this.frame(low, high, lines));
    const angles = angleTicks(from, to, (this.width - LEFT - RIGHT) / 44);
    parts.push(
      ...this.bottomTicks(
        angles,
        tickTexts(angles).map((text) => (cycle.drive.kind === "through" ? text : `${text}°`)),
        x,
      ),
    );
    for (const level of this.levels) {
      parts.push(
        shape("path", { class: "level", d: `M${LEFT} ${px(this.y(level, low, high))}H${px(this.width - RIGHT)}` }),
      );
    }
    const clipped = (value) => Math.min(Math.max(value, low - (high - low)), high + (high - low));
    for (const line of this.options.lines) {
      /** @type {([number, number] | null)[]} */
      const points = samples.map((sample) => {
        const value = sample ? line.of(sample) : NaN;
        return Number.isFinite(value) ? [x(sample.q), this.y(clipped(value), low, high)] : null;
      });
      parts.push(shape("path", { class: `line ${line.kind}`, d: pathThrough(points) }));
    }
    Chart.count += 1;
    const name = `clip${Chart.count}`;
    const clip = shape("clipPath", { id: name }, [
      shape("rect", { x: LEFT, y: TOP - 2, width: px(this.width - LEFT - RIGHT), height: tall + 4 }),
    ]);
    const drawn = parts.filter((part) => part.classList.contains("line"));
    const rest = parts.filter((part) => !part.classList.contains("line"));
    this.cursor = shape("path", { class: "cursor" });
    this.dot = shape("circle", { class: "cursor-dot", r: 3.6 });
    this.svg.replaceChildren(clip, ...rest, shape("g", { "clip-path": `url(#${name})` }, drawn), this.cursor, this.dot);
    this.low = low;
    this.high = high;
    this.describe(this.summary());
    if (this.q !== undefined) this.at(this.q);
  }

  /** In words: from where to where the first line goes. */
  summary() {
    const { of } = this.options.lines[0];
    const list = this.samples.filter((sample) => sample && Number.isFinite(of(sample)));
    if (list.length === 0) return `${this.name}: nothing to show`;
    const least = list.reduce((best, sample) => (of(sample) < of(best) ? sample : best));
    const most = list.reduce((best, sample) => (of(sample) > of(best) ? sample : best));
    const where = (sample) =>
      `${figure(of(sample), 3)} at a crank angle of ${figure(this.cycle.crankDeg(sample.q), 3)} degrees`;
    return `${this.name}: from ${where(least)} to ${where(most)}`;
  }

  /** Moves the cursor. @param {number} q @param {any} [given] the sample there */
  at(q, given) {
    this.q = q;
    if (!this.cursor) return;
    const sample = given ?? this.cycle.sample(q);
    const at = px(this.x(q));
    setAll(this.cursor, { d: `M${at} ${TOP}V${this.height - BOTTOM}` });
    const value = sample ? this.options.lines[0].of(sample) : NaN;
    const shown = Number.isFinite(value) && value <= this.high && value >= this.low;
    this.dot.classList.toggle("absent", !shown);
    if (shown) setAll(this.dot, { cx: at, cy: px(this.y(value, this.low, this.high)) });
    this.reading.textContent = sample ? this.options.read(sample) : "open";
  }
}

/** The error at each point, as stems. */
export class ErrorChart extends Chart {
  /** @param {HTMLElement} place @param {{title: string, noun: string, height: number, unit: string | null, onPick: (point: any) => void}} options */
  constructor(place, options) {
    super(place, options);
    this.options = options;
    this.svg.addEventListener("pointerdown", (event) => {
      if (!this.cycle || this.cycle.points.length === 0) return;
      const box = this.svg.getBoundingClientRect();
      const at = ((event.clientX - box.left) * this.width) / box.width;
      const nearest = this.cycle.points.reduce(
        (best, point, i) => {
          const apart = Math.abs(this.xOf(i) - at);
          return apart < best.apart ? { apart, point } : best;
        },
        { apart: Infinity, point: null },
      );
      if (nearest.point) options.onPick(nearest.point);
    });
  }

  /** @param {import("./cycle.mjs").Cycle} cycle */
  show(cycle) {
    this.cycle = cycle;
    this.draw();
  }

  draw() {
    if (!this.cycle) return;
    this.measure();
    const { points } = this.cycle;
    const worst = this.cycle.worstPoint();
    const high = this.highest();
    const room = this.width - LEFT - RIGHT;
    this.xOf = (i) => LEFT + (room * (i + 0.5)) / points.length;
    const y = (value) => this.y(value, 0, high);
    const base = this.height - BOTTOM;
    const parts = this.frame(0, high, ticks(0, high, 4));
    const step = [1, 2, 5, 10, 20, 50, 100, 200, 500].find((s) => points.length / s <= room / 28) ?? 1000;
    const shown = points.map((_, i) => i).filter((i) => i % step === 0);
    parts.push(
      ...this.bottomTicks(
        shown,
        shown.map((i) => String(points[i].number)),
        this.xOf,
      ),
    );
    /** @type {([number, number] | null)[]} */
    const limit = points.map((point, i) =>
      point.tolerance === null || point.tolerance > high ? null : [this.xOf(i), y(point.tolerance)],
    );
    this.note.textContent = limit.some(Boolean) ? "dashed: tolerance" : "";
    if (limit.some(Boolean)) parts.push(shape("path", { class: "level", d: pathThrough(limit) }));
    points.forEach((point, i) => {
      if (!Number.isFinite(point.error)) return;
      const kind = point === worst ? "stem worst" : points.length > 120 ? "stem thin" : "stem";
      const x = px(this.xOf(i));
      parts.push(shape("path", { class: kind, d: `M${x} ${px(base)}V${px(y(point.error))}` }));
      if (points.length <= 120)
        parts.push(shape("circle", { class: kind, cx: x, cy: px(y(point.error)), r: point === worst ? 4 : 2.8 }));
    });
    this.ring = shape("circle", { class: "cursor-ring", r: 6.5 });
    this.svg.replaceChildren(...parts, this.ring);
    const unit = this.options.unit ? ` ${this.options.unit}` : "";
    const { noun } = this.options;
    this.describe(
      worst
        ? `Error at the ${points.length} ${noun}s: the largest is ${figure(worst.error, 4)}${unit} at ${noun} ${worst.number}`
        : `Error at the ${noun}s: nothing to show`,
    );
    if (this.q !== undefined) this.at(this.q);
  }

  /** Rings the point that is nearest on the motion. @param {number} q */
  at(q) {
    this.q = q;
    if (!this.ring) return;
    const near = this.cycle.nearestPoint(q);
    const i = near ? this.cycle.points.indexOf(near) : -1;
    this.ring.classList.toggle("absent", i < 0 || !Number.isFinite(near.error));
    if (i < 0) return;
    setAll(this.ring, { cx: px(this.xOf(i)), cy: px(this.y(near.error, 0, this.highest())) });
    this.reading.textContent = `${this.options.noun} ${near.number}: ${figure(near.error, 4)}${this.options.unit ? ` ${this.options.unit}` : ""}`;
  }

  highest() {
    const most = Math.max(...this.cycle.points.map((point) => point.error).filter(Number.isFinite), 0);
    const tolerances = this.cycle.points.map((point) => point.tolerance).filter((t) => t !== null && t <= 4 * most);
    return Math.max(most, ...tolerances, Number.MIN_VALUE) * 1.12;
  }
}
