// The drawing that moves: the linkage over its target, its crank dragged by the hand.

import { angleTicks, element, figure, minus, pathThrough, px, roundLength, setAll, shape } from "./svg.mjs";

/** Room around the geometry for letters and stands, pixels. */
const PADDING = 40;
/** Numbers stand at every point up to so many, else at round ones. */
const NUMBERED = 20;
/** More points than this are plain dots. */
const MARKED = 120;
/** Below this part of the frame the target can be looked at by itself. */
const SMALL_TARGET = 0.3;

/** A box of the plane: [left, bottom, right, top]. */
function boxOf(points) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of points) {
    box[0] = Math.min(box[0], x);
    box[1] = Math.min(box[1], y);
    box[2] = Math.max(box[2], x);
    box[3] = Math.max(box[3], y);
  }
  return box[0] <= box[2] ? box : [-1, -1, 1, 1];
}

/** A box as wide as high around the same middle. */
function squared(box) {
  const half = extentOf(box) / 2 || 1;
  const [x, y] = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
  return [x - half, y - half, x + half, y + half];
}

const extentOf = (box) => Math.max(box[2] - box[0], box[3] - box[1]);

/** The direction away from neighbours, a unit vector. */
export function awayFrom(joint, neighbours) {
  let [x, y] = [0, 0];
  for (const other of neighbours) {
    const apart = Math.hypot(joint[0] - other[0], joint[1] - other[1]) || 1;
    x += (joint[0] - other[0]) / apart;
    y += (joint[1] - other[1]) / apart;
  }
  const size = Math.hypot(x, y);
  return size < 0.2 ? [0, -1] : [x / size, y / size];
}

/** What the marks are. */
function legend() {
  const key = (part, text) =>
    element("span", {}, [
      shape("svg", { class: "stage", width: 22, height: 12, viewBox: "0 0 22 12", "aria-hidden": "true" }, [part]),
      text,
    ]);
  return element("div", { class: "legend" }, [
    key(shape("circle", { class: "target-point", cx: 11, cy: 6, r: 4.4 }), "desired"),
    key(shape("circle", { class: "target-point first", cx: 11, cy: 6, r: 5 }), "the first"),
    key(shape("circle", { class: "reached", cx: 11, cy: 6, r: 2.4 }), "generated"),
    key(shape("path", { class: "curve", d: "M1 6h20" }), "curve of P"),
  ]);
}

/** Labels beside their points, placed where they hide least. */
class Labels {
  /** @param {[number, number][]} ink where something is drawn */
  constructor(ink) {
    this.ink = ink;
    /** @type {[number, number, number][]} middles and half widths */
    this.taken = [];
  }

  /**
   * The middle of a label `width` wide at `far` from a point, near the direction `wished`; null where it would cover
   * another label and is not needed.
   */
  place(point, far, width, wished, needed) {
    let best = null;
    for (let i = 0; i < 24; i += 1) {
      const turn = (Math.ceil((i % 12) / 2) * (i % 2 === 0 ? 1 : -1) * Math.PI) / 6;
      const reach = i < 12 ? far : 1.8 * far;
      const [dx, dy] = [Math.cos(wished + turn), Math.sin(wished + turn)];
      const at = [point[0] + dx * (reach + width / 2), point[1] + dy * (reach + 6)];
      const covers = this.taken.some(
        (other) => Math.abs(other[0] - at[0]) < other[2] + width / 2 + 1 && Math.abs(other[1] - at[1]) < 11,
      );
      const hidden = this.ink.filter(
        (spot) => Math.abs(spot[0] - at[0]) < width / 2 + 1 && Math.abs(spot[1] - at[1]) < 7,
      ).length;
      const cost = hidden + 0.9 * Math.abs(turn) + (i < 12 ? 0 : 1) + (covers ? 100 : 0);
      if (!best || cost < best.cost) best = { cost, at, covers };
    }
    if (best.covers && !needed) return null;
    this.taken.push([best.at[0], best.at[1], width / 2]);
    return best.at;
  }
}

/** The drawing. It is told where to stand by `pose`, and tells of drags by `onDrag(crankDeg)`. */
export class Stage {
  /**
   * @param {HTMLElement} place
   * @param {{unit: string | null, onDrag: (crankDeg: number) => void, onKey: (step: number) => void, onPose?: (stage: any, joints: any) => void}} options `onPose` draws more over the linkage
   */
  constructor(place, options) {
    this.place = place;
    this.options = options;
    this.look = "linkage";
    /** Its size, and pixels of a unit of length. @type {number | undefined} */
    this.width = undefined;
    /** @type {number | undefined} */
    this.height = undefined;
    /** @type {number | undefined} */
    this.scale = undefined;
    /** @type {((p: [number, number]) => [number, number]) | undefined} */
    this.toPixel = undefined;
    /** @type {((p: [number, number]) => [number, number]) | undefined} */
    this.toPlane = undefined;
    this.svg = shape("svg", { class: "stage", role: "group", "aria-label": "The linkage over its target" });
    this.still = shape("g");
    this.moving = shape("g");
    this.labels = shape("g", { class: "labels" });
    this.svg.append(this.still, this.moving, this.labels);
    place.append(this.svg, legend());
    this.makeMovingParts();
    this.listen();
    if (typeof ResizeObserver !== "undefined") {
      new ResizeObserver(() => {
        if (Math.abs(place.clientWidth - (this.width ?? 0)) > 1) this.layOut();
      }).observe(place);
    }
  }

  makeMovingParts() {
    const line = (name) => shape("path", { class: name });
    this.parts = {
      coupler: line("coupler"),
      bars: line("bar-edge"),
      barsInside: line("bar"),
      pinA: shape("circle", { class: "pin", r: 5.4 }),
      pinB: shape("circle", { class: "pin", r: 5.4 }),
      pinD: shape("circle", { class: "pin", r: 4.4 }),
      trace: line("now"),
      P: shape("circle", { class: "tracer", r: 5 }),
      pinC: shape("circle", { class: "pin", r: 4.4 }),
      grip: shape("circle", {
        class: "grip",
        r: 19,
        tabindex: 0,
        role: "slider",
        "aria-label": "Crank: drag it, or turn it with the arrow keys",
        "aria-valuemin": 0,
        "aria-valuemax": 360,
      }),
    };
    this.letters = Object.fromEntries(
      ["A", "B", "C", "D", "P"].map((name) => [name, shape("text", { class: "letter" }, [name])]),
    );
    this.moving.append(...Object.values(this.parts), ...Object.values(this.letters));
  }

  listen() {
    const { grip } = this.parts;
    const turn = (event) => {
      if (!this.cycle || !this.toPlane) return;
      const [x, y] = this.fromEvent(event);
      const [A] = this.pivots();
      this.options.onDrag((Math.atan2(y - A[1], x - A[0]) * 180) / Math.PI);
    };
    grip.addEventListener("pointerdown", (event) => {
      grip.setPointerCapture(event.pointerId);
      grip.classList.add("held");
      event.preventDefault();
      grip.focus({ preventScroll: true });
    });
    grip.addEventListener("pointermove", (event) => {
      if (grip.hasPointerCapture(event.pointerId)) turn(event);
    });
    for (const name of ["pointerup", "pointercancel"]) grip.addEventListener(name, () => grip.classList.remove("held"));
    grip.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      this.options.onKey(event.shiftKey ? 0.1 * step : step);
    });
  }

  /** The point of the plane under a pointer. */
  fromEvent(event) {
    const box = this.svg.getBoundingClientRect();
    const [x, y] = [
      ((event.clientX - box.left) * this.width) / box.width,
      ((event.clientY - box.top) * this.height) / box.height,
    ];
    return this.toPlane([x, y]);
  }

  /** Shows another mechanism. @param {import("./cycle.mjs").Cycle} cycle @param {boolean} closed whether the target is a closed curve */
  show(cycle, closed) {
    this.cycle = cycle;
    this.closed = closed;
    this.circuit = cycle.circuit();
    this.layOut();
  }

  /** Whether the target is so small that it deserves a look of its own. */
  hasSmallTarget() {
    return this.cycle !== undefined && extentOf(this.targetBox()) < SMALL_TARGET * extentOf(this.wholeBox());
  }

  /** @param {"linkage" | "target"} look */
  lookAt(look) {
    this.look = look;
    this.layOut();
  }

  targetBox() {
    const { points } = this.cycle;
    return boxOf(points.flatMap(({ target, reached }) => [target, reached ?? target]));
  }

  wholeBox() {
    const moving = this.circuit.flatMap((joints) => (joints ? this.placesOf(joints) : []));
    return boxOf([...moving, ...this.pivots(), ...this.cycle.points.map((point) => point.target)]);
  }

  /** The fixed pivots. @returns {[number, number][]} */
  pivots() {
    const { A, B } = /** @type {any} */ (this.cycle.mechanism.linkage);
    return [A, B];
  }

  /** The places of a position: A, B, C, D, P. @returns {any} */
  placesOf(joints) {
    return [...this.pivots(), joints.C, joints.D, joints.P];
  }

  /** Draws what stands still, for the width that there is. */
  layOut() {
    if (!this.cycle) return;
    const width = Math.max(this.place.clientWidth || 640, 240);
    const box = this.look === "target" ? this.targetBox() : this.wholeBox();
    const [w, h] = [box[2] - box[0] || extentOf(box) || 1, box[3] - box[1] || extentOf(box) || 1];
    const padding = Math.min(PADDING, 0.09 * width);
    const footer = 30;
    const wanted = ((width - 2 * padding) * h) / w + 2 * padding + footer;
    const height = Math.round(
      Math.min(Math.max(wanted, 0.5 * width, 260), Math.max((width < 500 ? 1.1 : 0.84) * width, 300), 600),
    );
    const scale = Math.min((width - 2 * padding) / w, (height - 2 * padding - footer) / h);
    const centre = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
    const middle = [width / 2, (height - footer) / 2];
    Object.assign(this, { width, height, scale });
    this.toPixel = ([x, y]) => [middle[0] + (x - centre[0]) * scale, middle[1] - (y - centre[1]) * scale];
    this.toPlane = ([x, y]) => [centre[0] + (x - middle[0]) / scale, centre[1] - (y - middle[1]) / scale];
    setAll(this.svg, { viewBox: `0 0 ${width} ${height}`, width, height });
    this.still.replaceChildren(...this.ground(), ...this.curves(), ...this.target(), ...this.scaleBar());
    this.moving.classList.toggle("only-point", this.look === "target");
    if (this.q !== undefined) this.pose(this.q);
  }

  ground() {
    if (this.look === "target") return [];
    const stand = ([x, y]) => {
      let hatch = "";
      for (let i = 0; i < 6; i += 1) hatch += `M${px(x - 14 + 5.6 * i)} ${px(y + 16)}l-4.5 5.5`;
      return shape("g", { class: "stand" }, [
        shape("path", { d: `M${px(x)} ${px(y)}l11 16h-22z`, class: "stand-body" }),
        shape("path", { d: `M${px(x - 16)} ${px(y + 16)}h32${hatch}` }),
      ]);
    };
    const at = this.pivots().map(this.toPixel);
    return [shape("path", { class: "ground", d: pathThrough(at) }), ...at.map(stand)];
  }

  curves() {
    const of = (name) => pathThrough(this.circuit.map((joints) => (joints ? this.toPixel(joints[name]) : null)));
    if (this.look === "target") {
      // Finer where it is enlarged.
      const box = squared(this.targetBox());
      const parts = Math.min(64, Math.ceil(extentOf(this.wholeBox()) / extentOf(box)));
      const near = this.cycle.curveNear(box, parts).map((P) => P && this.toPixel(P));
      return [shape("path", { class: "curve", d: pathThrough(near) })];
    }
    return [shape("path", { class: "pin-path", d: of("C") + of("D") }), shape("path", { class: "curve", d: of("P") })];
  }

  target() {
    const { points } = this.cycle;
    const many = points.length > MARKED;
    const radius = many ? 1.8 : points.length > 40 ? 3.4 : 4.6;
    const spots = points.map((point) => this.toPixel(point.target));
    const parts = [];
    const along = this.closed && spots.length > 2 ? [...spots, spots[0]] : spots;
    parts.push(shape("path", { class: "target-line", d: pathThrough(along) }));
    let whiskers = "";
    points.forEach((point, i) => {
      if (!point.reached) return;
      const reached = this.toPixel(point.reached);
      if (Math.hypot(reached[0] - spots[i][0], reached[1] - spots[i][1]) > radius)
        whiskers += pathThrough([spots[i], reached]);
    });
    if (whiskers) parts.push(shape("path", { class: "whisker", d: whiskers }));
    const worst = this.cycle.worstPoint();
    points.forEach((point, i) => {
      const [cx, cy] = spots[i].map(px);
      if (point === worst) parts.push(shape("circle", { class: "worst-halo", cx, cy, r: radius + 6 }));
      const name = point.number === 0 ? "target-point first" : "target-point";
      parts.push(
        shape("circle", { class: many ? "target-dot" : name, cx, cy, r: point.number === 0 ? radius + 1 : radius }),
      );
      if (point.reached && !many) {
        const [rx, ry] = this.toPixel(point.reached).map(px);
        parts.push(shape("circle", { class: "reached", cx: rx, cy: ry, r: 1.9 }));
      }
    });
    this.labels.replaceChildren(...this.numbers(spots, radius, worst));
    return parts;
  }

  /** Numbers outside of the target: all where they are few, else round ones, and the worst point's. */
  numbers(spots, radius, worst) {
    const { points } = this.cycle;
    // The least of 1, 2, 5, 10, 20 and so on that leaves few enough.
    const step = Math.round(1 / roundLength(NUMBERED / points.length)) || 1;
    const middle = [0, 1].map((axis) => spots.reduce((sum, spot) => sum + spot[axis], 0) / (spots.length || 1));
    const curve = this.circuit.flatMap((joints, i) => (joints && i % 3 === 0 ? [this.toPixel(joints.P)] : []));
    const labels = new Labels([...curve, ...spots]);
    const parts = [];
    const place = (point, i) => {
      const isWorst = point === worst;
      const text = isWorst ? `${point.number} worst` : String(point.number);
      const wished = Math.atan2(spots[i][1] - middle[1], spots[i][0] - middle[0]);
      const at = labels.place(spots[i], radius + (isWorst ? 8 : 3), 6.6 * text.length, wished, isWorst);
      if (at)
        parts.push(
          shape(
            "text",
            { class: isWorst ? "number worst" : "number", x: px(at[0]), y: px(at[1] + 4), "text-anchor": "middle" },
            [text],
          ),
        );
    };
    points.forEach((point, i) => {
      if (point === worst) place(point, i);
    });
    points.forEach((point, i) => {
      if (point !== worst && point.number % step === 0) place(point, i);
    });
    return parts;
  }

  scaleBar() {
    const length = roundLength((0.22 * this.width) / this.scale);
    const [left, y, long] = [14, this.height - 12, length * this.scale];
    const label = `${minus(String(Number(length.toPrecision(3))))}${this.options.unit ? ` ${this.options.unit}` : ""}`;
    return [
      shape("path", { class: "scale", d: `M${left} ${y - 4}v4h${px(long)}v-4` }),
      shape("text", { class: "scale-text", x: px(left + long + 8), y }, [label]),
    ];
  }

  /** Draws the links with their places at these pixels. @param {any} places @param {any} _joints */
  drawLinks([a, b, c, d, p], _joints) {
    const { coupler, bars, barsInside } = this.parts;
    setAll(coupler, { d: `${pathThrough([c, d, p])}Z` });
    for (const bar of [bars, barsInside]) setAll(bar, { d: pathThrough([a, c, null, c, d, null, b, d]) });
  }

  /** Moves the linkage to q. @param {number} q */
  pose(q) {
    this.q = q;
    if (!this.toPixel) return;
    const joints = this.cycle.at(q);
    this.options.onPose?.(this, joints);
    this.moving.classList.toggle("absent", !joints);
    if (!joints) return;
    const places = this.placesOf(joints).map(this.toPixel);
    const [a, b, c, d, p] = places;
    const { parts, letters } = this;
    this.drawLinks(places, joints);
    const seats = { pinA: a, pinB: b, pinC: c, pinD: d, P: p, grip: c };
    for (const [name, [cx, cy]] of Object.entries(seats)) setAll(parts[name], { cx: px(cx), cy: px(cy) });
    const near = this.cycle.nearestPoint(q);
    setAll(parts.trace, { d: near ? pathThrough([this.toPixel(near.target), p]) : "" });
    parts.trace.classList.toggle(
      "absent",
      !near || Math.hypot(near.target[0] - joints.P[0], near.target[1] - joints.P[1]) * this.scale > 40,
    );
    /** @type {Record<string, [[number, number], [number, number][]]>} */
    const around = { A: [a, [c, b]], B: [b, [d, a]], C: [c, [a, d, p]], D: [d, [b, c, p]], P: [p, [c, d]] };
    for (const [name, [joint, others]] of Object.entries(around)) {
      const [x, y] = awayFrom(joint, others);
      setAll(letters[name], { x: px(joint[0] + 17 * x), y: px(joint[1] + 17 * y + 5) });
    }
    const crank = this.cycle.crankDeg(q);
    setAll(parts.grip, {
      "aria-valuenow": +crank.toPrecision(5),
      "aria-valuetext": `${figure(crank, 4)} degrees`,
    });
  }
}

/** Marks under a slider: where the points are, and the part that they use. */
export class Marks {
  /** @param {HTMLElement} place */
  constructor(place) {
    this.svg = shape("svg", {
      class: "marks",
      "aria-hidden": "true",
      viewBox: "0 0 1000 14",
      preserveAspectRatio: "none",
    });
    place.append(this.svg);
    this.labels = element("div", { class: "marks-labels", "aria-hidden": "true" });
    place.append(this.labels);
  }

  /** @param {import("./cycle.mjs").Cycle} cycle */
  show(cycle) {
    const [low, high] = cycle.range;
    const x = (q) => px((1000 * (q - low)) / (high - low));
    const parts = [];
    const band = (from, to) =>
      parts.push(shape("rect", { class: "used", x: x(from), y: 0, width: Math.max(0, x(to) - x(from)), height: 14 }));
    if (cycle.used) {
      const [from, to] = cycle.used;
      band(Math.max(from, low), Math.min(to, high));
      if (cycle.cyclic && to > high) band(low, Math.min(to - 360, high));
    }
    const worst = cycle.worstPoint();
    let data = "";
    for (const point of cycle.points) if (point.place !== null && point !== worst) data += `M${x(point.place)} 1v8`;
    parts.push(shape("path", { class: "mark", d: data }));
    if (worst && worst.place !== null) parts.push(shape("path", { class: "mark worst", d: `M${x(worst.place)} 0v14` }));
    this.svg.replaceChildren(...parts);
    const words = cycle.drive.kind === "through" ? "" : "°";
    this.labels.replaceChildren(
      ...angleTicks(low, high, (this.labels.clientWidth || 600) / 52).map((q) => {
        const label = element("span", {}, [`${minus(String(q))}${words}`]);
        label.style.left = `${(100 * (q - low)) / (high - low)}%`;
        return label;
      }),
    );
  }
}
