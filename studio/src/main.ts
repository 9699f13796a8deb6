// The page: the target and what is asked of the linkage on one side, the studio's answers on the other.

import { figure } from "../../src/report/html/player/svg.mjs";
import { Board, type Tool } from "./board";
import { Connection } from "./connection";
import { Moving } from "./figures";
import { Steps, remember, remembered } from "./memory";
import type { Answer, Point, Shown, Task } from "./messages";
import { Strip, inWords } from "./strip";
import { moved, ofText } from "./target";

/** Seconds of a turn. */
const TURN = 5;
const MOST_PINNED = 3;

/** The example: a step of a walking leg, flat below and lifted on the way back. */
const EXAMPLE: Task = {
  name: "walking-step",
  unit: "mm",
  points: [
    [-40, 0], [-30, -1], [-20, -1.5], [-10, -1.8], [0, -2], [10, -1.8], [20, -1.5], [30, -1], [40, 0], [44, 5],
    [42, 11], [34, 17], [22, 22], [8, 25], [-8, 25], [-22, 22], [-34, 17], [-42, 11], [-44, 5],
  ],
  closed: true,
  types: ["crank-rocker", "double-crank"],
  transmission_deg_min: 30,
  seed: 1,
};

const TYPES: Record<string, string[]> = {
  any: [],
  motor: ["crank-rocker", "double-crank"],
  "crank-rocker": ["crank-rocker"],
  "double-crank": ["double-crank"],
  rocking: ["double-rocker", "triple-rocker", "rocker-crank"],
};

const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const input = (id: string) => byId<HTMLInputElement>(id);

class Page {
  private task: Task = EXAMPLE;
  private steps = new Steps();
  private version = 0;
  private answer: Answer | null = null;
  private chosen = 0;
  private pinned: Shown[] = [];
  private hints = true;
  private begunWith = "null";
  private shownAll: Moving[] = [];
  private fitNext = true;
  private part = 0;
  private playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  private status = byId("status");
  private board: Board;
  private strip: Strip;
  private connection: Connection | null = null;

  constructor() {
    this.board = new Board(byId("board"), {
      drawn: (points, closed) => {
        this.fitNext = true;
        this.change({ points, closed, name: "drawing" }, { fresh: true });
      },
      grasp: () => this.steps.note(this.task),
      drag: (index, to, last) => this.drag(index, to, last),
      add: (at) => this.change({ points: [...this.task.points, at] }),
      remove: (index) => this.change({ points: this.task.points.filter((_, i) => i !== index) }),
      box: (pivots_in, last) => this.put({ ...this.task, pivots_in }, { moving: !last }),
    }, (text) => this.say(text));
    this.strip = new Strip(byId("strip"), (i) => this.choose(i), (i) => this.pin(i));
    this.listen();
  }

  async begin() {
    const kept = remembered();
    try {
      const reply = await fetch("/beginning.json");
      this.begunWith = reply.ok ? await reply.text() : "null";
    } catch {
      // The studio has ended: what is remembered is shown all the same.
    }
    const given = JSON.parse(this.begunWith) as (Task & { version?: number }) | null;
    if (given && kept?.begunWith !== this.begunWith) {
      const { version: _, ...task } = given;
      this.task = task;
      this.hints = kept?.hints ?? true;
    } else if (kept) {
      this.task = kept.task;
      this.pinned = kept.pinned;
      this.hints = kept.hints;
    }
    byId("hints").hidden = !this.hints;
    this.board.show(this.task, null, []);
    this.board.fit();
    this.connection = new Connection((answer) => this.hear(answer), (open, tries) => {
      document.body.dataset.connected = String(open);
      if (!open && tries > 1) this.say("The studio does not answer. Start it again with `linkwright studio` and open the address that it prints; your drawing is kept here.");
    });
    this.put(this.task, {});
    let last = performance.now();
    const frame = (now: number) => {
      if (this.playing) {
        this.part = (this.part + Math.min(now - last, 100) / 1000 / TURN) % 1;
        this.board.pose(this.part);
        this.strip.pose(this.part);
      }
      last = now;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** A change that can be undone. */
  private change(part: Partial<Task>, how: { fresh?: boolean } = {}) {
    this.steps.note(this.task);
    this.put({ ...this.task, ...part }, how);
  }

  private drag(index: number, to: Point, last: boolean) {
    this.put({ ...this.task, points: moved(this.task.points, index, to, this.task.closed) }, { moving: !last });
  }

  /** Takes a task: shown, remembered, sent. */
  private put(task: Task, how: { moving?: boolean; fresh?: boolean }) {
    this.task = task;
    this.version += 1;
    if (how.fresh) {
      this.chosen = 0;
      this.answer = null;
    }
    this.draw();
    this.fill();
    this.keep();
    document.body.dataset.asked = String(this.version);
    if (task.points.length < 3) {
      this.answer = null;
      this.draw();
      this.say("A path has at least three points: draw on the board, or click points.");
      return;
    }
    const { moving, fresh } = how;
    this.connection?.send({ ...task, version: this.version, ...(moving ? { moving } : {}), ...(fresh ? { fresh } : {}) });
  }

  private hear(answer: Answer) {
    if (answer.doing === "refused") {
      if (answer.version !== 0 && answer.version !== this.version) return;
      this.say(`This cannot be searched: ${answer.said}`);
      document.body.dataset.doing = "refused";
      return;
    }
    this.answer = answer;
    if (this.chosen < this.count() || this.chosen >= this.shownAll.length) this.chosen = Math.min(this.chosen, Math.max(answer.candidates.length - 1, 0));
    document.body.dataset.doing = answer.doing;
    document.body.dataset.answered = String(answer.version);
    this.draw();
    if (answer.candidates.length > 0 && this.fitNext) {
      this.fitNext = false;
      this.board.fit();
    }
    const best = answer.candidates[0];
    const unit = this.task.unit ? ` ${this.task.unit}` : "";
    const head = best ? `Best: rms ${figure(best.rms, 3)}${unit}, ${inWords(best)}. ` : "";
    this.say(head + answer.said, answer.doing === "searching" ? answer.progress : undefined);
  }

  private count() {
    return this.answer?.candidates.length ?? 0;
  }

  private draw() {
    const candidates = this.answer?.candidates ?? [];
    const { points } = this.task;
    this.shownAll = [...candidates, ...this.pinned].map((shown) => new Moving(shown, points));
    const pins = this.shownAll.slice(candidates.length);
    const shown = this.shownAll[this.chosen] ?? null;
    this.board.show(this.task, shown, pins.filter((one) => one !== shown));
    this.strip.show(this.shownAll, candidates.length, this.chosen, this.task.unit, points, this.task.closed);
    byId("nothing").hidden = this.shownAll.length > 0;
    byId<HTMLButtonElement>("undo").disabled = !this.steps.canUndo;
    byId<HTMLButtonElement>("redo").disabled = !this.steps.canRedo;
    byId<HTMLButtonElement>("linkage-file").disabled = !shown;
    this.board.pose(this.part);
    this.strip.pose(this.part);
  }

  private choose(index: number) {
    this.chosen = index;
    this.draw();
  }

  /** Pins a candidate to compare others with it, or lets a pinned one go. */
  private pin(index: number) {
    const found = this.count();
    if (index >= found) {
      this.pinned = this.pinned.filter((_, i) => i !== index - found);
      if (this.chosen >= found) this.chosen = 0;
    } else if (this.answer) {
      this.pinned = [...this.pinned, this.answer.candidates[index]].slice(-MOST_PINNED);
    }
    this.keep();
    this.draw();
  }

  private keep() {
    remember({ task: this.task, pinned: this.pinned, begunWith: this.begunWith, hints: this.hints });
  }

  private say(text: string, progress?: number) {
    if (this.status.textContent !== text) this.status.textContent = text;
    const bar = byId<HTMLProgressElement>("progress");
    bar.hidden = progress === undefined;
    bar.value = progress ?? 0;
  }

  /** Brings the controls to what the task says. */
  private fill() {
    const { task } = this;
    const set = (id: string, value: number | undefined) => {
      const field = input(id);
      if (document.activeElement !== field) field.value = value === undefined ? "" : String(value);
    };
    input("closed").checked = task.closed;
    set("tolerance", task.tolerance);
    set("transmission", task.transmission_deg_min);
    set("ratio", task.link_ratio_max);
    input("pivots").checked = task.pivots_in !== undefined;
    byId("box-numbers").hidden = task.pivots_in === undefined;
    ["left", "bottom", "right", "top"].forEach((id, i) => set(id, task.pivots_in?.[i]));
    const key = Object.keys(TYPES).find((name) => TYPES[name].join() === task.types.join());
    byId<HTMLSelectElement>("type").value = key ?? "as-given";
    byId("as-given").hidden = key !== undefined;
    for (const unit of document.querySelectorAll(".unit")) unit.textContent = task.unit ?? "";
    const text = byId<HTMLTextAreaElement>("coordinates");
    if (document.activeElement !== text) text.value = task.points.map((p) => p.join(", ")).join("\n");
    byId("point-count").textContent = String(task.points.length);
  }

  private listen() {
    const click = (id: string, act: () => void) => byId(id).addEventListener("click", act);
    for (const tool of ["draw", "points"] as Tool[]) {
      click(`tool-${tool}`, () => {
        this.board.tool = tool;
        for (const other of ["draw", "points"]) byId(`tool-${other}`).setAttribute("aria-pressed", String(other === tool));
      });
    }
    click("undo", () => this.back("undo"));
    click("redo", () => this.back("redo"));
    click("clear", () => this.change({ points: [] }, { fresh: true }));
    click("example", () => {
      this.steps.note(this.task);
      this.fitNext = true;
      this.put(EXAMPLE, { fresh: true });
    });
    click("fit", () => this.board.fit());
    click("nearer", () => this.board.zoom(1.25));
    click("farther", () => this.board.zoom(0.8));
    click("play", () => {
      this.playing = !this.playing;
      this.showPlaying();
    });
    this.showPlaying();
    click("hide-hints", () => {
      this.hints = false;
      byId("hints").hidden = true;
      this.keep();
    });
    click("problem-file", () => void this.save("/problem.toml", { ...this.task, version: this.version }, this.task.name));
    click("linkage-file", () => {
      const shown = this.shownAll[this.chosen]?.shown;
      const name = `${this.task.name}-${this.chosen + 1}`.slice(-64);
      if (shown) void this.save("/linkage.toml", { name, unit: this.task.unit, linkage: shown.linkage }, name);
    });
    input("closed").addEventListener("change", () => this.change({ closed: input("closed").checked }));
    const number = (id: string, key: "tolerance" | "transmission_deg_min" | "link_ratio_max") => {
      input(id).addEventListener("change", () => {
        const { value, valueAsNumber } = input(id);
        if (value === "" || Number.isFinite(valueAsNumber)) this.change({ [key]: value === "" ? undefined : valueAsNumber });
      });
    };
    number("tolerance", "tolerance");
    number("transmission", "transmission_deg_min");
    number("ratio", "link_ratio_max");
    const type = byId<HTMLSelectElement>("type");
    type.addEventListener("change", () => this.change({ types: TYPES[type.value] ?? this.task.types }));
    input("pivots").addEventListener("change", () => {
      this.change({ pivots_in: input("pivots").checked ? this.boxAround() : undefined });
      if (input("pivots").checked) this.board.fit();
    });
    ["left", "bottom", "right", "top"].forEach((id, i) => input(id).addEventListener("change", () => {
      const box = [...(this.task.pivots_in ?? this.boxAround())] as [number, number, number, number];
      box[i] = input(id).valueAsNumber;
      if (box.every(Number.isFinite)) this.change({ pivots_in: box });
    }));
    click("take-coordinates", () => {
      const points = ofText(byId<HTMLTextAreaElement>("coordinates").value);
      if (typeof points === "string") return this.say(`These are no coordinates: ${points}`);
      this.fitNext = true;
      return this.change({ points }, { fresh: true });
    });
    document.addEventListener("keydown", (event) => {
      const typing = (event.target as Element).closest("input, textarea, select");
      if (typing || !(event.ctrlKey || event.metaKey)) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      this.back(key === "y" || event.shiftKey ? "redo" : "undo");
    });
  }

  private showPlaying() {
    byId("play").textContent = this.playing ? "Pause" : "Play";
  }

  private back(way: "undo" | "redo") {
    const task = way === "undo" ? this.steps.undo(this.task) : this.steps.redo(this.task);
    if (task) this.put(task, {});
  }

  /** A box below the target, as wide as it. */
  private boxAround(): [number, number, number, number] {
    const [xs, ys] = [this.task.points.map((p) => p[0]), this.task.points.map((p) => p[1])];
    if (xs.length === 0) return [-50, -50, 50, 0];
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const size = Math.max(right - left, high - low, 1e-6);
    const round = (value: number) => Number(value.toPrecision(3));
    return [round(left - 0.3 * size), round(low - 1.2 * size), round(right + 0.3 * size), round(low - 0.1 * size)];
  }

  private async save(path: string, what: unknown, name: string) {
    try {
      const reply = await fetch(path, { method: "POST", body: JSON.stringify(what), headers: { "Content-Type": "application/json" } });
      const text = await reply.text();
      if (!reply.ok) return this.say(`This cannot be saved: ${text.trim()}`);
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text], { type: "application/toml" }));
      link.download = `${name}.toml`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
      return this.say(`Saved as ${name}.toml.`);
    } catch {
      return this.say("The studio does not answer: nothing was saved.");
    }
  }
}

void new Page().begin();
