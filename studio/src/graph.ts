// A function under the hand: the outputs that are wanted and those that the linkage generates, over the input, and the error
// below. A pair is dragged up and down; the controls of a function.

import { inputAt } from "../../src/report/html/player/drive.mjs";
import { kernelOf, positionAt } from "../../src/report/html/player/kinematics.mjs";
import { element, figure, pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import type { Page } from "./kit";
import { type FourBar, fourBarOf, type Point, type Shown, type Task } from "./messages";
import { dragging, type Grip, watchPointers } from "./pointers";
import { moved } from "./target";

/** Samples of the generated function. */
const SAMPLES = 181;
const DEGREES = 180 / Math.PI;
/** Pixels beside the graph and below it, and of the error's graph: a part of the height, and at least. */
const [LEFT, RIGHT, TOP, BETWEEN, BOTTOM] = [46, 14, 22, 30, 24];
const [ERRORS, LEAST] = [0.26, 44];
/** Of more pairs so many have handles. */
const [DENSE, HANDLES] = [24, 12];

/** A value nearest to another one, by whole turns. */
const beside = (deg: number, other: number) => deg + 360 * Math.round((other - deg) / 360);

/** What a linkage generates: the outputs at inputs, degrees; NaN where its loop is open. */
export function generated(shown: Shown, pairs: Point[], inputs: number[]): number[] {
  const { crank_deg, t1_at, output_offset_deg: offset = 0, sense } = shown;
  // The studio's functions are those of four-bars.
  const { A, B } = fourBarOf(shown.linkage) as FourBar;
  const kernel = kernelOf(shown.linkage as never);
  const ground = Math.atan2(B[1] - A[1], B[0] - A[0]) * DEGREES;
  const sign = sense === "opposite" ? -1 : 1;
  let last = pairs[0][1];
  return inputs.map((input) => {
    const joints = positionAt(kernel, (crank_deg[0] + input - pairs[0][0]) / DEGREES, t1_at[0] as never);
    if (!joints) return Number.NaN;
    const [x, y] = joints.D as Point;
    const turned = Math.atan2(y - B[1], x - B[0]) * DEGREES - ground - offset;
    last = beside(sign * turned, last);
    return last;
  });
}

/** Round numbers between two others. */
export function ticks(low: number, high: number, most: number): number[] {
  const rough = (high - low) / most;
  const unit = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 5, 10].find((by) => by * unit >= rough) ?? 10) * unit;
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) =>
    Number(((first + i) * step).toPrecision(12)),
  );
}

/** One of the two graphs: where its values lie. */
interface Frame {
  top: number;
  high: number;
  range: [number, number];
}

const widened = (low: number, high: number, least: number): [number, number] => {
  const more = Math.max(0.06 * (high - low), (least - (high - low)) / 2);
  return [low - more, high + more];
};

export class Graph {
  private svg = shape("svg", {
    class: "stage graph",
    tabindex: 0,
    role: "application",
    "aria-label":
      "The function: output over input, the error below. Comma and full stop choose a pair, the arrows up and down move its output, Delete removes it.",
  });
  private place = element("div", { id: "graph", hidden: "" });
  private cursor = shape("path", { class: "cursor" });
  private still = shape("g");
  private handles = shape("g");
  private selected = -1;
  private width = 0;
  private height = 0;
  private output: Frame = { top: 0, high: 1, range: [0, 1] };
  private inputs: [number, number] = [0, 1];
  private tolerance = element("input", {
    type: "number",
    id: "tolerance-output",
    min: 0,
    step: "any",
    placeholder: "any",
  });
  private sense = element(
    "select",
    { id: "sense" },
    [
      ["any", "either way"],
      ["same", "as the crank"],
      ["opposite", "against the crank"],
    ].map(([value, words]) => element("option", { value }, [words])),
  ) as HTMLSelectElement;
  private references = ["input_offset", "output_offset"].map(
    (id) =>
      element("select", { id }, [
        element("option", { value: "free" }, ["only differences count"]),
        element("option", { value: "ground" }, ["from the line of the pivots"]),
      ]) as HTMLSelectElement,
  );
  private wishes = [
    element("label", {}, [
      "Largest error of the output ",
      element("span", { class: "field" }, [this.tolerance, element("span", {}, ["°"])]),
    ]),
    element("label", {}, ["The follower turns ", this.sense]),
    element("label", {}, ["Inputs: ", this.references[0]]),
    element("label", {}, ["Outputs: ", this.references[1]]),
  ] as HTMLElement[];
  private formula = element("input", { type: "text", id: "formula", spellcheck: "false" }) as HTMLInputElement;
  private ranges = (
    [
      ["first", "first x", "1"],
      ["last", "last x", "2"],
      ["input-range", "crank turns by, degrees", "60"],
      ["output-range", "follower turns by, degrees", "90"],
    ] as const
  ).map(
    ([id, label, value]) =>
      element("input", { type: "number", id, step: "any", value, "aria-label": label }) as HTMLInputElement,
  );
  private take = element("button", { id: "take-formula" }, ["Take the formula"]);
  private beside = [
    element("h2", {}, ["By a formula"]),
    element("label", {}, ["y = ", this.formula]),
    element("div", { class: "row" }, ["x from ", this.ranges[0], " to ", this.ranges[1]]),
    element("div", { class: "row" }, ["the crank turns by ", this.ranges[2], "°"]),
    element("div", { class: "row" }, ["the follower by ", this.ranges[3], "°"]),
    element("div", { class: "row" }, [this.take]),
  ] as HTMLElement[];

  constructor(
    private page: Page,
    read: (text: string) => Promise<Task>,
  ) {
    this.svg.append(this.still, this.cursor, this.handles);
    this.place.append(this.svg);
    const by = (id: string) => document.getElementById(id) as HTMLElement;
    (by("tolerance").closest("label") as HTMLElement).after(...this.wishes);
    by("table").after(...this.beside);
    watchPointers(
      this.svg,
      (event) => this.grip(event),
      () => () => {},
    );
    this.svg.addEventListener("keydown", (event: KeyboardEvent) => this.press(event));
    new ResizeObserver(() => this.draw()).observe(this.place);
    const tolerance = this.tolerance as HTMLInputElement;
    tolerance.addEventListener("change", () => {
      const { value, valueAsNumber } = tolerance;
      if (value === "" || valueAsNumber >= 0)
        this.change({ tolerance_deg: value === "" ? undefined : valueAsNumber, tolerances_deg: undefined });
    });
    this.sense.addEventListener("change", () => this.change({ sense: this.sense.value as "any" }));
    this.references.forEach((select, i) => {
      select.addEventListener("change", () =>
        this.change({ [i === 0 ? "input_offset" : "output_offset"]: select.value as "free" }),
      );
    });
    this.take.addEventListener("click", async () => {
      const [first, last, input, output] = this.ranges.map((one) => one.value);
      const text = `format = 1\n[task.function]\nof = ${JSON.stringify(this.formula.value)}\nover = [${first}, ${last}]\ninput_range_deg = ${input}\noutput_range_deg = ${output}\nsamples = 31\n`;
      try {
        const { points, function: pairs } = await read(text);
        const task = this.page.task();
        this.page.replace(
          {
            ...task,
            points,
            function: { ...task.function, ...pairs, sense: task.function?.sense },
            weights: undefined,
          },
          { fresh: true },
        );
      } catch (error) {
        this.page.tell(`The formula cannot be taken: ${error instanceof Error ? error.message : error}`);
      }
    });
  }

  private change(part: Partial<NonNullable<Task["function"]>>) {
    const task = this.page.task();
    if (task.function) this.page.replace({ ...task, function: { ...task.function, ...part } });
  }

  private get pairs(): Point[] {
    return this.page.task().points as Point[];
  }

  private x(input: number): number {
    const [low, high] = this.inputs;
    return LEFT + ((input - low) / (high - low)) * (this.width - LEFT - RIGHT);
  }

  private y({ top, high, range }: Frame, value: number): number {
    return top + high * (1 - (value - range[0]) / (range[1] - range[0]));
  }

  private held(): number[] {
    const n = this.pairs.length;
    const all = Array.from({ length: Math.min(n, n > DENSE ? HANDLES : n) }, (_, k) =>
      n > DENSE ? Math.round((k * (n - 1)) / (HANDLES - 1)) : k,
    );
    return this.selected >= 0 && !all.includes(this.selected) ? [...all, this.selected] : all;
  }

  draw() {
    const task = this.page.task();
    this.place.hidden = !task.function;
    const isFirst = task.function && !this.place.isConnected;
    if (isFirst) document.getElementById("stage")?.after(this.place);
    document.getElementById("board")?.classList.toggle("of-function", task.function !== undefined);
    if (!task.function || task.points.length < 2) return;
    const [width, height] = [this.place.clientWidth, this.place.clientHeight];
    if (width < 80 || height < 80) return;
    Object.assign(this, { width, height });
    setAll(this.svg, { viewBox: `0 0 ${width} ${height}`, width, height });
    const { pairs } = this;
    if (this.selected >= pairs.length) this.selected = -1;
    const xs = pairs.map((p) => p[0]);
    this.inputs = [Math.min(...xs), Math.max(...xs)];
    const { moving, isFor } = this.page.board;
    const shown = moving && isFor && moving.shown.output_offset_deg !== undefined ? moving.shown : null;
    const [from, to] = this.inputs;
    const inputs = Array.from({ length: SAMPLES }, (_, i) => from + ((to - from) * i) / (SAMPLES - 1));
    const outputs = shown ? generated(shown, pairs, inputs) : [];
    const made = shown ? generated(shown, pairs, xs) : [];
    const errors = made.map((value, i) => pairs[i][1] - beside(value, pairs[i][1]));
    const values = [...pairs.map((p) => p[1]), ...outputs.filter(Number.isFinite)];
    const low = Math.max(ERRORS * (height - TOP - BETWEEN - BOTTOM), LEAST);
    this.output = {
      top: TOP,
      high: Math.max(height - TOP - BETWEEN - BOTTOM - low, 20),
      range: widened(Math.min(...values), Math.max(...values), 1e-6),
    };
    const most = Math.max(...errors.filter(Number.isFinite).map(Math.abs), 1e-9);
    const error: Frame = { top: height - BOTTOM - low, high: low, range: [-1.15 * most, 1.15 * most] };
    const spot = (frame: Frame, at: Point): Point => [this.x(at[0]), this.y(frame, at[1])];
    const parts: SVGElement[] = [...this.axes(this.output, "output °", error, most)];
    if (shown) {
      const line = (of: (Point | null)[], frame: Frame) => pathThrough(of.map((p) => p && spot(frame, p)));
      const whole = inputs.map((input, i): Point | null => (Number.isFinite(outputs[i]) ? [input, outputs[i]] : null));
      parts.push(
        shape("path", { class: "curve", d: line(whole, this.output) }),
        shape("path", {
          class: "error",
          d: line(
            xs.map((x, i) => [x, errors[i]] as Point),
            error,
          ),
        }),
      );
    }
    parts.push(
      ...pairs.map((pair) => {
        const [cx, cy] = spot(this.output, pair).map(px);
        return shape("circle", { class: "pair", cx, cy, r: pairs.length > DENSE ? 2 : 3 });
      }),
    );
    this.still.replaceChildren(...parts);
    this.handles.replaceChildren(
      ...this.held().flatMap((i) => {
        const [cx, cy] = spot(this.output, pairs[i]).map(px);
        const name = `target-point${i === this.selected ? " chosen" : ""}`;
        return [
          shape("circle", { class: name, cx, cy, r: i === this.selected ? 6.5 : 4.6 }),
          shape("circle", { class: "touch", cx, cy, r: 12, "data-pair": i }),
        ];
      }),
    );
  }

  private axes(frame: Frame, title: string, error: Frame, most: number): SVGElement[] {
    const right = this.width - RIGHT;
    const words = (x: number, y: number, text: string, kind = "") =>
      shape("text", { class: `tick ${kind}`, x: px(x), y: px(y) }, [text]);
    const rule = (y: number, name: string) => shape("path", { class: name, d: `M${LEFT} ${px(y)}H${px(right)}` });
    const outputs = ticks(...frame.range, Math.max(frame.high / 38, 2)).flatMap((value) => {
      const y = this.y(frame, value);
      return [rule(y, "grid"), words(LEFT - 6, y + 4, String(value), "left")];
    });
    const inputs = ticks(...this.inputs, Math.max((right - LEFT) / 70, 2)).flatMap((value) => {
      const x = this.x(value);
      const d = `M${px(x)} ${frame.top}V${px(frame.top + frame.high)}M${px(x)} ${px(error.top)}v${px(error.high)}`;
      return [shape("path", { class: "grid", d }), words(x, error.top + error.high + 16, String(value), "middle")];
    });
    const said = most > 1e-9 ? `, at most ${figure(most, 3)}°` : "";
    return [
      ...outputs,
      ...inputs,
      rule(this.y(error, 0), "zero"),
      words(LEFT, frame.top - 8, title),
      words(LEFT, error.top - 8, `error: wanted less generated${said}`),
      words(right, frame.top - 8, "over the input °", "right"),
    ];
  }

  /** Shows where the crank stands. */
  posed(part: number) {
    const { moving } = this.page.board;
    const task = this.page.task();
    if (!task.function || !moving || task.points.length < 2 || this.width === 0) return;
    const { cycle, shown } = moving;
    const deg = (inputAt(cycle.drive, moving.at(part)).angle * 180) / Math.PI;
    const [low, high] = this.inputs;
    const input = beside(deg - shown.crank_deg[0] + task.points[0][0], (low + high) / 2);
    const isSeen = input >= low - 1e-6 && input <= high + 1e-6;
    setAll(this.cursor, { d: isSeen ? `M${px(this.x(input))} ${TOP}V${px(this.height - BOTTOM)}` : "" });
  }

  private at(event: PointerEvent): number {
    const { top } = this.svg.getBoundingClientRect();
    const { top: above, high, range } = this.output;
    return range[0] + (1 - (event.clientY - top - above) / high) * (range[1] - range[0]);
  }

  private grip(event: PointerEvent): Grip | null {
    this.svg.focus({ preventScroll: true });
    const held = (event.target as Element).getAttribute("data-pair");
    if (held === null) return null;
    const index = Number(held);
    this.selected = index;
    this.draw();
    const [from, before] = [this.at(event), this.pairs[index][1]];
    const { hand } = this.page;
    return dragging(
      event,
      () => hand.grasp(),
      (event, last) => this.lift(index, before + this.at(event) - from, last),
      () => hand.letGo(),
    );
  }

  /** An output elsewhere; of many pairs those beside it come along. */
  private lift(index: number, to: number, last: boolean) {
    const task = this.page.task();
    const points = moved(this.pairs, index, [this.pairs[index][0], to], false).map(
      ([, y], i): Point => [this.pairs[i][0], y],
    );
    this.page.put({ ...task, points }, { moving: !last });
  }

  private press(event: KeyboardEvent) {
    const n = this.pairs.length;
    const { range } = this.output;
    const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "," || event.key === ".") this.selected = (this.selected + (event.key === "." ? 1 : -1) + n) % n;
    else if (event.key === "Delete" && this.selected >= 0 && n > 2) this.page.hand.remove(this.selected);
    else if (way && this.selected >= 0) {
      this.page.hand.grasp();
      const step = ((event.shiftKey ? 20 : 4) * (range[1] - range[0])) / this.output.high;
      this.lift(this.selected, this.pairs[this.selected][1] + way * step, true);
    } else return;
    event.preventDefault();
    this.draw();
    const pair = this.pairs[this.selected];
    if (pair) this.page.say(`Pair ${this.selected}: input ${figure(pair[0], 4)}°, output ${figure(pair[1], 4)}°`);
  }

  fill(task: Task) {
    const { function: pairs } = task;
    for (const one of [...this.wishes, ...this.beside]) one.hidden = !pairs;
    if (!pairs) return;
    const put = (field: HTMLInputElement | HTMLSelectElement, value: string) => {
      if (document.activeElement !== field) field.value = value;
    };
    put(this.tolerance as HTMLInputElement, String(pairs.tolerance_deg ?? ""));
    put(this.sense, pairs.sense ?? "any");
    put(this.references[0], pairs.input_offset ?? "free");
    put(this.references[1], pairs.output_offset ?? "free");
    put(this.formula, pairs.of?.formula ?? this.formula.value ?? "");
  }
}
