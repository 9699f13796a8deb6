// The player: drawing, transport and charts of one mechanism at a time. It knows nothing of the page around it.

import { CycleChart, ErrorChart } from "./chart.mjs";
import { Cycle } from "./cycle.mjs";
import { draggedTo, within, wrappedDeg } from "./drive.mjs";
import { Marks, Stage } from "./stage.mjs";
import { element, figure, setAll, shape } from "./svg.mjs";

/** Seconds of a turn at speed 1. */
const TURN_SECONDS = 6;
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
/** Seconds a point where motion is to be reduced: the linkage then steps from point to point. */
const STEP_SECONDS = 0.9;

const PLAY = "M4 2.5v11l9.5-5.5z";
const PAUSE = "M4 2.5h3v11H4zM9.5 2.5h3v11h-3z";
const BACK = "M12 3v10L5.5 8zM3.5 3H5v10H3.5z";
const ON = "M4 3v10l6.5-5zM11 3h1.5v10H11z";

/** A button with a sign; its name is read aloud. */
function signButton(name, path) {
  const sign = shape("path", { d: path });
  const button = element("button", { type: "button", class: "sign", "aria-label": name, title: name }, [
    shape("svg", { viewBox: "0 0 16 16", width: 16, height: 16, "aria-hidden": "true" }, [sign]),
  ]);
  return { button, sign };
}

export class Player {
  /**
   * @param {HTMLElement} stagePlace where the drawing and the transport go
   * @param {HTMLElement} chartPlace where the charts go
   * @param {{unit: string | null, target: any, transmissionMin: number | null, Stage?: typeof Stage, onPose?: (stage: any, joints: any) => void}} options
   */
  constructor(stagePlace, chartPlace, options) {
    this.options = options;
    this.calm = matchMedia("(prefers-reduced-motion: reduce)");
    this.q = 0;
    this.playing = false;
    this.sense = 1;
    this.speed = 1;
    this.rpm = 60;
    const { unit, onPose } = options;
    /** The word for one of the target's points. */
    this.noun = options.target.noun ?? "point";
    this.stage = new (options.Stage ?? Stage)(stagePlace, {
      unit,
      onPose,
      onDrag: (crankDeg) => this.dragTo(crankDeg),
      onKey: (step) => this.moveTo(this.q + step * this.keySense()),
    });
    this.makeTransport(stagePlace);
    this.makeCharts(chartPlace, unit);
  }

  makeTransport(place) {
    const play = signButton("Play", PLAY);
    const { noun } = this;
    const back = signButton(`${noun[0].toUpperCase()}${noun.slice(1)} before`, BACK);
    const on = signButton(`Next ${noun}`, ON);
    this.play = play;
    play.button.classList.add("play");
    play.button.addEventListener("click", () => this.toggle());
    back.button.addEventListener("click", () => this.stepPoint(-1));
    on.button.addEventListener("click", () => this.stepPoint(1));
    this.speedChoice = element(
      "select",
      { "aria-label": "Speed" },
      SPEEDS.map((s) => element("option", { value: s }, [`${s} ×`])),
    );
    this.speedChoice.value = "1";
    this.speedChoice.addEventListener("change", () => {
      this.speed = Number(this.speedChoice.value);
    });
    this.lookChoice = element("button", { type: "button", "aria-pressed": "false" }, ["Enlarge the target"]);
    this.lookChoice.addEventListener("click", () => {
      const target = this.stage.look !== "target";
      this.lookChoice.setAttribute("aria-pressed", String(target));
      this.stage.lookAt(target ? "target" : "linkage");
    });
    this.scrub = element("input", { type: "range", step: "0.25", class: "scrub" });
    this.scrubLabel = element("span", {}, ["Crank angle"]);
    this.scrub.addEventListener("input", () => {
      this.pause();
      this.moveTo(Number(this.scrub.value));
    });
    const label = element("label", { class: "scrub-label" }, [this.scrubLabel, this.scrub]);
    this.reading = element("output", { class: "pose" });
    const track = element("div", { class: "track" }, [label]);
    this.marks = new Marks(track);
    place.append(
      element("div", { class: "transport" }, [
        element("div", { class: "buttons" }, [back.button, play.button, on.button, this.speedChoice, this.lookChoice]),
        this.reading,
        track,
      ]),
    );
  }

  makeCharts(place, unit) {
    const length = unit ?? "units";
    const scaled = (power, of) => (sample) => of(sample) * ((this.rpm * Math.PI) / 30) ** power;
    const size = (vector) => (vector ? Math.hypot(vector[0], vector[1]) : NaN);
    const onPick = (q) => {
      this.pause();
      this.moveTo(q);
    };
    const rates = (title, key, power, dimension) => {
      const of = (component) => scaled(power, (sample) => (sample[key] ? component(sample[key]) : NaN));
      return new CycleChart(place, {
        title,
        height: 128,
        onPick,
        lines: [
          { name: "size", kind: "main", of: scaled(power, (sample) => size(sample[key])) },
          { name: "x", kind: "along-x", of: of((v) => v[0]) },
          { name: "y", kind: "along-y", of: of((v) => v[1]) },
        ],
        read: (sample) => {
          const value = scaled(power, (s) => size(s[key]))(sample);
          return Number.isFinite(value) ? `${figure(value, 4)} ${length}/${dimension}` : "undecided at a toggle";
        },
      });
    };
    const key = (kind, text) =>
      element("span", { class: "key" }, [
        shape("svg", { class: "chart", width: 18, height: 8, "aria-hidden": "true" }, [
          shape("path", { class: `line ${kind}`, d: "M0 4h18" }),
        ]),
        text,
      ]);
    this.errors = new ErrorChart(place, {
      title: `Error at the ${this.noun}s`,
      noun: this.noun,
      height: 128,
      unit,
      onPick: (point) => {
        this.pause();
        if (point.place !== null) this.moveTo(point.place);
      },
    });
    this.mu = new CycleChart(place, {
      title: "Transmission angle",
      height: 128,
      low: 0,
      high: 180,
      onPick,
      lines: [
        { name: "mu", kind: "main", of: (sample) => sample.mus?.[0] ?? sample.mu },
        { name: "mu2", kind: "along-x", of: (sample) => sample.mus?.[1] ?? NaN },
        { name: "mu3", kind: "along-y", of: (sample) => sample.mus?.[2] ?? NaN },
      ],
      read: (sample) => `${figure(sample.mu, 4)}°`,
    });
    this.dyads = [key("main", "at D"), key("along-x", "at F2"), key("along-y", "at F3")];
    const dyads = element("span", { class: "keys" }, this.dyads);
    place.append(element("p", { class: "chart-note" }, [dyads]));
    this.velocity = rates("Velocity of P", "v", 1, "s");
    this.acceleration = rates("Acceleration of P", "a", 2, "s²");
    const speed = element("input", {
      type: "number",
      min: "-10000",
      max: "10000",
      step: "any",
      value: "60",
      inputmode: "decimal",
    });
    speed.addEventListener("input", () => {
      const rpm = Number(speed.value);
      if (speed.value === "" || !Number.isFinite(rpm) || Math.abs(rpm) > 1e6) return;
      this.rpm = rpm;
      this.drawRates();
    });
    place.append(
      element("p", { class: "chart-note" }, [
        element("label", {}, ["With the crank at ", speed, " turns a minute. "]),
        element("span", { class: "keys" }, [key("main", "size"), key("along-x", "along x"), key("along-y", "along y")]),
      ]),
    );
  }

  /** Shows a mechanism. @param {any} mechanism */
  show(mechanism) {
    const before = this.cycle;
    this.cycle = new Cycle(mechanism, this.options.target);
    const { drive, range, moves } = this.cycle;
    this.sense = this.cycle.sense;
    this.stage.look = "linkage";
    this.lookChoice.setAttribute("aria-pressed", "false");
    this.stage.show(this.cycle, this.options.target.closed);
    this.lookChoice.hidden = !this.stage.hasSmallTarget();
    this.marks.show(this.cycle);
    // Whole quarters of a degree, as the slider steps.
    setAll(this.scrub, { min: Math.ceil(4 * range[0]) / 4, max: Math.floor(4 * range[1]) / 4 });
    for (const control of [this.scrub, this.play.button]) control.disabled = !moves;
    this.scrubLabel.textContent = drive.kind === "through" ? "Place on the motion" : "Crank angle";
    this.samples = this.cycle.samples();
    this.errors.show(this.cycle);
    // A line for each dyad of a six-bar.
    const lines = this.samples.find((sample) => sample)?.mus?.length ?? 0;
    this.dyads.forEach((one, i) => {
      one.hidden = lines < 2 || i >= lines;
    });
    const least = this.options.transmissionMin;
    this.mu.show(this.cycle, this.samples, least ? [least, 180 - least] : [], least ? "dashed: asked" : "");
    this.drawRates();
    const kept = before && before.drive.kind === "turn" && drive.kind === "turn";
    this.moveTo(kept ? this.q : this.cycle.start);
  }

  drawRates() {
    this.velocity.show(this.cycle, this.samples);
    this.acceleration.show(this.cycle, this.samples);
  }

  /** Moves everything to q. @param {number} q */
  moveTo(q) {
    if (!this.cycle) return;
    this.q = within(this.cycle.drive, q);
    this.stage.pose(this.q);
    const sample = this.cycle.sample(this.q);
    for (const chart of [this.mu, this.velocity, this.acceleration]) chart.at(this.q, sample);
    this.errors.at(this.q);
    this.scrub.value = String(this.q);
    const crank = `${figure(this.cycle.crankDeg(this.q), 4)}°`;
    const P = sample?.joints.P;
    const near = this.cycle.nearestPoint(this.q);
    this.reading.textContent = P
      ? `crank ${crank}   P (${figure(P[0], 5)}, ${figure(P[1], 5)})${near ? `   nearest ${this.noun} ${near.number}` : ""}`
      : `crank ${crank}   the loop is open here`;
    setAll(this.scrub, { "aria-valuetext": `crank at ${crank}` });
  }

  keySense() {
    return this.cycle?.drive.kind === "through" && Math.cos((this.q * Math.PI) / 180) < 0 ? -1 : 1;
  }

  dragTo(crankDeg) {
    this.pause();
    const { drive } = this.cycle;
    const before = this.q;
    const next = draggedTo(drive, before, crankDeg, this.dragSense ?? 1);
    const moved = wrappedDeg(next - before);
    if (drive.kind === "through" && Math.abs(moved) > 1e-9) this.dragSense = Math.sign(moved);
    this.moveTo(next);
  }

  /** To the next point along the motion, or the one before. @param {number} step 1 or -1 */
  stepPoint(step) {
    this.pause();
    this.goPoint(step);
  }

  goPoint(step) {
    const { points } = this.cycle;
    const there = points.filter((point) => point.place !== null);
    if (there.length === 0) return;
    const near = this.cycle.nearestPoint(this.q);
    const i = there.indexOf(near);
    const on = Math.abs(near.place - this.q) < 1e-9;
    const n = there.length;
    const next = on ? (i + step + n) % n : i;
    this.moveTo(there[next].place);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.start();
  }

  start() {
    if (!this.cycle?.moves) return;
    this.playing = true;
    this.showState();
    let last = performance.now();
    let stepped = last;
    const frame = (now) => {
      if (!this.playing) return;
      if (this.calm.matches) {
        if (now - stepped >= (1000 * STEP_SECONDS) / this.speed) {
          stepped = now;
          this.goPoint(1);
        }
      } else {
        this.advance((Math.min(now - last, 100) / 1000) * (360 / TURN_SECONDS) * this.speed);
      }
      last = now;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** By so many degrees: on and on where the motion is cyclic, to and fro over the part used where it is not. */
  advance(degrees) {
    if (this.cycle.cyclic) {
      this.moveTo(this.q + this.sense * degrees);
      return;
    }
    const used = this.cycle.used;
    const [low, high] = used && used[1] - used[0] > 0.5 ? used : this.cycle.range;
    let next = this.q + this.sense * degrees;
    if (next >= high && this.sense > 0) [next, this.sense] = [Math.max(high, this.q - degrees), -1];
    else if (next <= low && this.sense < 0) [next, this.sense] = [Math.min(low, this.q + degrees), 1];
    this.moveTo(next);
  }

  pause() {
    this.playing = false;
    this.showState();
  }

  showState() {
    setAll(this.play.sign, { d: this.playing ? PAUSE : PLAY });
    const name = this.playing ? "Pause" : "Play";
    setAll(this.play.button, { "aria-label": name, title: `${name} (space)` });
  }

  /** Lays everything out anew, for a page of another width. */
  layOut() {
    if (!this.cycle) return;
    this.stage.layOut();
    for (const chart of [this.errors, this.mu, this.velocity, this.acceleration]) chart.draw();
  }
}
