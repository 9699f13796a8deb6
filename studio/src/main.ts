// The page: the target and what is asked of the linkage on one side, the studio's answers on the other.

import { figure } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import { Board, type Tool } from "./board";
import { type Choice, followed, placeOf } from "./choice";
import { Connection } from "./connection";
import { Desk } from "./desk";
import { EXAMPLES } from "./examples";
import { type Moving, movingOf } from "./figures";
import { takesText, taskOfText, watchFiles } from "./files";
import { changing } from "./focus";
import { Guide } from "./guide";
import { Helps, Kept } from "./helps";
import { remember, remembered, Steps } from "./memory";
import type { Answer, Point, Solution, Task } from "./messages";
import { Nine } from "./nine";
import { Pace } from "./pace";
import { PhotographPanel } from "./photograph";
import { fillRequirements, listenToRequirements } from "./requirements";
import { Said } from "./said";
import { SizeChip } from "./size";
import { Stays } from "./stays";
import { inWords, isExact, Strip } from "./strip";
import { Table } from "./table";
import { moved } from "./target";
import {
  drawnAnew,
  pathAlone,
  settled,
  taskOf,
  withAdded,
  withLengthsTimes,
  withMoved,
  withoutStale,
  withPoints,
  withRemoved,
  withToleranceAt,
} from "./task";
import { type Placed, Underlay } from "./underlay";
import { rescaled, type View } from "./view";
import { Voice } from "./voice";

/** Seconds of a turn. */
const TURN = 5;
const MOST_PINNED = 3;
/** An answer that is less than so much better than the one that was brought back does not replace it. */
const BETTER = 0.999;

/** What a step back brings back. */
interface State {
  task: Task;
  photo: Placed | null;
  view: View;
  answer: Answer | null;
  chosen: { pin: number } | { candidate: number } | null;
}

const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const input = (id: string) => byId<HTMLInputElement>(id);

class Page {
  private task: Task = EXAMPLES[0][1];
  private steps = new Steps<State>();
  /** The version that a step back or forth brought, with the answer that stood there. */
  private restored: { version: number; answer: Answer } | null = null;
  private version = 0;
  /** The edit that began this target: what is said of earlier ones belongs to another. */
  private since = 0;
  private heard = 0;
  private answer: Answer | null = null;
  private choice: Choice = null;
  private pinned: Solution[] = [];
  /** What the board and the strip show: the candidates, then what is pinned. */
  private moving: Moving[] = [];
  private hints = true;
  private begunWith = "null";
  private filling: ReturnType<typeof setTimeout> | undefined;
  private part = 0;
  private playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  private board: Board;
  private strip: Strip;
  private size: SizeChip;
  private connection: Connection | null = null;
  private desk: Desk;
  private pace = new Pace();
  private voice = new Voice();
  private said = new Said(byId("status"), byId<HTMLProgressElement>("progress"), this.voice);
  private guide = new Guide();
  private underlay = new Underlay(() => this.showUnderlay());
  private photograph = new PhotographPanel(
    this.underlay,
    () => this.board,
    (tool) => this.use(tool),
    (text) => this.say(text),
    () => this.note(),
  );
  private table = new Table(
    byId("table"),
    (task) => this.replace(task),
    (text) => this.say(text),
  );
  private nine = new Nine(byId("nine"), () => {
    this.choice = followed(this.choice, this.candidates());
    this.draw();
  });
  private helps = new Helps(byId("helps"), (make, said) => {
    this.replace(make(this.task));
    this.say(`Changed: ${said}.`);
  });
  private stays = new Stays(byId("stays"), () => this.replace(pathAlone(this.task)));
  private coordinates = byId<HTMLTextAreaElement>("coordinates");
  /** What the page has written there; anything else is the user's, until it is taken. */
  private written = "";
  private kept = new Kept(byId("kept"), (make) => this.replace(make(this.task)));

  constructor() {
    this.board = new Board(
      byId("board"),
      {
        drawn: (points, closed) => {
          this.pace.penUp();
          this.guide.done("draw");
          this.replace(drawnAnew(this.task, points, closed), { fresh: true });
          this.stays.show(this.task);
        },
        grasp: () => this.note(),
        letGo: () => {
          const before = this.steps.giveUp();
          if (before) this.restore(before);
        },
        drag: (index, to, last) => this.drag(index, to, last),
        add: (at, after) => this.replace(withAdded(this.task, after, at)),
        remove: (index) => this.replace(withRemoved(this.task, index)),
        box: (kind, box, last) => {
          this.put({ ...this.task, [kind]: box ?? undefined }, { moving: !last });
          if (last && this.board.tool === kind) this.use("draw");
        },
        tolerance: (index, radius, last) => this.put(withToleranceAt(this.task, index, radius), { moving: !last }),
        marked: () => this.photograph.marked(),
      },
      (text) => this.say(text),
      this.underlay,
    );
    this.strip = new Strip(
      byId("strip"),
      (i) => this.choose(i),
      (i) => this.pin(i),
    );
    this.desk = new Desk(byId("desk"), byId("share"), {
      task: () => this.task,
      chosen: () => this.chosen(),
      pinned: () => this.pinned,
      take: (task) => {
        this.open(taskOf({ ...task, version: 0 }));
      },
      keep: (one) => this.keepShown(one),
    });
    this.size = new SizeChip(byId("board"), (by) => {
      this.note();
      if (this.underlay.placed) this.underlay.lengthsTimes(by);
      this.board.look(rescaled(this.board.looking, by));
      this.put(withLengthsTimes(this.task, by), {});
    });
    this.listen();
  }

  /** Takes another problem, and brings its path into the middle. */
  private open(task: Task) {
    this.replace(task, { fresh: true });
    this.board.fitPath(task);
  }

  async begin() {
    const kept = remembered();
    let view = kept?.view;
    if (kept) ({ task: this.task, pinned: this.pinned, hints: this.hints, begunWith: this.begunWith } = kept);
    try {
      const begunWith = await api.beginning();
      const given = JSON.parse(begunWith) as Task | null;
      if (given && this.begunWith !== begunWith) {
        if (kept) this.note();
        view = undefined;
        this.task = taskOf({ ...given, version: 0 });
      }
      this.begunWith = begunWith;
    } catch {
      // The studio has ended or is busy: what is remembered is shown all the same, and what was given waits for a reload.
    }
    byId("hints").hidden = !this.hints;
    this.board.show(this.task, null, []);
    if (view) this.board.look(view);
    else if (this.task.points.length > 0) this.board.fitPath(this.task);
    else this.board.open(this.task.unit);
    this.showUnderlay();
    this.connection = new Connection(
      (answer) => this.hear(answer),
      (open, tries) => {
        document.body.dataset.connected = String(open);
        if (!open && tries > 1)
          void api.whyClosed().then((why) => document.body.dataset.connected === "false" && this.say(why));
      },
    );
    this.put(this.task, {});
    void this.desk.begin();
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

  /** Another task in place of the one that stands, which can be undone. */
  private replace(task: Task, how: { fresh?: boolean } = {}) {
    if (JSON.stringify(task) !== JSON.stringify(this.task)) this.note();
    this.put(task, how);
  }

  private drag(index: number, to: Point, last: boolean) {
    if (last) this.guide.done("drag");
    // Nine points are precise: none takes its neighbours along.
    this.put(withMoved(this.task, moved(this.task.points, index, to, this.task.closed)), { moving: !last });
  }

  private use(tool: Tool) {
    this.board.tool = tool;
    if (tool === "points" && this.task.points.length > 0)
      this.desk.say(
        "A click on the path puts a point there, a click beside it one behind the last. Clear begins anew.",
      );
    for (const button of document.querySelectorAll("[id^=tool-]"))
      button.setAttribute("aria-pressed", String(button.id === `tool-${tool}`));
  }

  private showUnderlay() {
    this.board?.redraw();
    this.photograph?.show();
  }

  private async takeText(text: string, name: string) {
    const read = await taskOfText(text, name, this.task, input("samples").valueAsNumber || undefined);
    if (typeof read === "string") return this.said.refuse(`These are no coordinates: ${read}`);
    if (text === this.coordinates.value) this.written = text;
    this.open(read.task);
    return this.say(`Taken: ${read.said}.`);
  }

  /** Takes a task: shown, remembered, sent. */
  private put(edited: Task, how: { moving?: boolean; fresh?: boolean }) {
    const task = withoutStale(this.task, edited);
    if (edited.expect && !task.expect)
      this.desk.say(
        "The figures published for this problem hold for it as it was opened: they are let go. Undo brings them back.",
      );
    this.task = task;
    this.version += 1;
    const short = task.points.length < 3;
    if (how.fresh || short) {
      this.since = this.version;
      this.choice = null;
      this.answer = null;
      this.nine.hear(null);
    }
    this.stays.show(null);
    // The controls and the strip can wait for a hand that moves; the board cannot.
    clearTimeout(this.filling);
    if (how.moving) {
      this.drawBoard();
      this.filling = setTimeout(() => this.settle(), 100);
    } else {
      this.draw();
      this.settle();
    }
    document.body.dataset.asked = String(this.version);
    if (short) this.say("A path has at least three points: draw on the board, or click points.");
    // Too few points are sent all the same: they end the search. Until a new target is answered it is said to be new.
    const fresh = this.heard < this.since;
    this.connection?.send({
      ...task,
      version: this.version,
      ...(how.moving ? { moving: true } : {}),
      ...(fresh ? { fresh } : {}),
    });
  }

  /** Brings the controls to what the task says, and remembers it. */
  private settle() {
    this.fill();
    this.keep();
  }

  private hear(answer: Answer) {
    if (answer.version !== 0 && answer.version < this.since) return;
    this.heard = answer.version || this.heard;
    if (answer.doing === "refused") {
      if (answer.version !== 0 && answer.version !== this.version) return;
      if (this.task.points.length >= 3) this.say(`This cannot be searched: ${answer.said}`);
      document.body.dataset.doing = "refused";
      return;
    }
    this.answer = this.asRestored(answer);
    this.pace.answered(answer, this.version);
    this.nine.hear(answer);
    const choice = followed(this.choice, this.candidates());
    if (this.choice && !choice && answer.candidates.length > 0)
      this.desk.say("The linkage that was chosen is not among these any more: the best one is shown.");
    this.choice = choice;
    document.body.dataset.doing = answer.doing;
    document.body.dataset.answered = String(answer.version);
    this.draw();
    const best = this.answer.candidates[0];
    const unit = this.task.unit ? ` ${this.task.unit}` : "";
    const near =
      best && (best.ability || isExact(best))
        ? "exactly through the points"
        : `rms ${figure(best?.rms ?? 0, 3)}${unit}`;
    const head = best ? `Best: ${near}, ${inWords(best)}. ` : "";
    this.desk.changed(answer.doing === "done");
    this.voice.answered(answer, head + answer.said);
    this.said.tell(head + answer.said, answer.doing === "searching" ? answer.progress : undefined);
  }

  /** An answer with the linkages that a step back has brought back, unless it has better ones. */
  private asRestored(answer: Answer): Answer {
    const before = this.restored;
    if (!before || before.version !== this.version) return answer;
    const [was, is] = [before.answer.candidates[0], answer.candidates[0]];
    if (answer.doing === "done" && (!was || (is && is.rms < BETTER * was.rms))) {
      this.restored = null;
      return answer;
    }
    return { ...answer, candidates: before.answer.candidates };
  }

  /** The candidates that are shown: of many through nine points those that were chosen. */
  private candidates() {
    return this.nine.filtered(this.answer?.candidates ?? []);
  }

  /** What the strip shows: candidates for what stands, then what is pinned, each with its own task. */
  private all(): Solution[] {
    return [...this.candidates().map((shown) => ({ shown, task: this.task })), ...this.pinned];
  }

  private place() {
    return placeOf(this.choice, this.candidates(), this.pinned);
  }

  private chosen(): Solution | null {
    return this.all()[this.place()] ?? null;
  }

  private draw() {
    const all = this.all();
    const found = all.length - this.pinned.length;
    this.moving = all.map(({ shown, task }) => movingOf(shown, task.points));
    this.drawBoard();
    this.strip.show(
      this.moving,
      all.map(({ task }) => task),
      found,
      this.place(),
    );
    byId("nothing").hidden = all.length > 0;
    this.helps.show(this.answer?.relaxations ?? [], this.task.unit);
    this.showSteps();
    byId<HTMLButtonElement>("linkage-file").disabled = !this.chosen();
    this.strip.pose(this.part);
  }

  /** The board alone: the target as it stands, the linkage that was last answered. */
  private drawBoard() {
    const shown = this.moving[this.place()] ?? null;
    const pins = this.moving.slice(this.moving.length - this.pinned.length);
    this.board.show(
      this.task,
      shown,
      pins.filter((one) => one !== shown),
    );
    this.board.pose(this.part);
  }

  private showSteps() {
    byId<HTMLButtonElement>("undo").disabled = !this.steps.canUndo;
    byId<HTMLButtonElement>("redo").disabled = !this.steps.canRedo;
  }

  private choose(index: number) {
    const one = this.all()[index];
    this.choice = index < this.candidates().length ? { candidate: one.shown } : { pin: one };
    this.draw();
    this.desk.chose();
  }

  /** Keeps a linkage to compare others with. */
  private keepShown(one: Solution) {
    if (this.pinned.length >= MOST_PINNED)
      return this.desk.say(`${MOST_PINNED} are pinned already: unpin one of them first.`);
    this.pinned = [...this.pinned, one];
    this.keep();
    this.draw();
  }

  /** Pins a candidate to compare others with it, or lets a pinned one go. */
  private pin(index: number) {
    const one = this.all()[index];
    if (index < this.candidates().length) {
      this.guide.done("pin");
      return this.keepShown(one);
    }
    this.pinned = this.pinned.filter((pin) => pin !== one);
    if (this.choice && "pin" in this.choice && this.choice.pin === one) this.choice = null;
    this.keep();
    this.draw();
  }

  private keep() {
    const { task, pinned, begunWith, hints } = this;
    remember({ task, pinned, begunWith, hints, view: this.board.looking });
  }

  private say(text: string) {
    this.said.say(text);
  }

  /** Brings the controls to what the task says. */
  private fill() {
    const { task } = this;
    input("closed").checked = task.closed;
    for (const unit of document.querySelectorAll(".unit")) unit.textContent = task.unit ?? "";
    fillRequirements(task);
    this.size.show(task);
    this.kept.show(task);
    this.table.show(task);
    const text = this.coordinates;
    if (document.activeElement !== text && [this.written, ""].includes(text.value)) {
      text.value = task.points.map((p) => p.join(", ")).join("\n");
      this.written = text.value;
    }
    byId("point-count").textContent = String(task.points.length);
  }

  private listen() {
    const click = (id: string, act: () => void) => byId(id).addEventListener("click", act);
    for (const tool of ["draw", "points", "pivots_in", "footprint_in", "photo-move", "photo-scale"] as Tool[]) {
      // Pressed again, a tool is laid down.
      click(`tool-${tool}`, () => this.use(this.board.tool === tool ? "draw" : tool));
    }
    click("undo", () => this.back("undo"));
    click("redo", () => this.back("redo"));
    click("clear", () => {
      this.replace(withPoints(this.task, [], false), { fresh: true });
      this.board.open(this.task.unit);
    });
    const choice = byId<HTMLSelectElement>("example-choice");
    choice.replaceChildren(new Option("choose one", ""), ...EXAMPLES.map(([name], i) => new Option(name, String(i))));
    click("example", () => {
      if (choice.value === "") return this.desk.say("Choose first which example.");
      return this.open(EXAMPLES[Number(choice.value)][1]);
    });
    listenToRequirements(
      () => this.task,
      (task) => this.replace(task),
      () => this.board.fit(),
    );
    watchFiles(
      byId("board"),
      input("file"),
      (text, name) => void this.takeText(text, name),
      (file) => void this.photograph.take(file),
    );
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
      changing(
        byId("hints"),
        () => {
          byId("hints").hidden = true;
        },
        this.board.svg,
      );
      this.keep();
    });
    click("problem-file", () => void this.save(this.task.name, api.problemOf(this.task)));
    click("linkage-file", () => {
      const [chosen, place, found] = [this.chosen(), this.place(), this.candidates().length];
      if (!chosen) return;
      const name = `${chosen.task.name}-${place < found ? place + 1 : `pinned-${place - found + 1}`}`.slice(-64);
      void this.save(name, api.linkageOf(name, chosen));
    });
    input("closed").addEventListener("change", () =>
      this.replace(settled({ ...this.task, closed: input("closed").checked })),
    );
    click("take-coordinates", () => void this.takeText(this.coordinates.value, ""));
    document.addEventListener("keydown", (event) => {
      if (takesText(event.target) || !(event.ctrlKey || event.metaKey)) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      this.back(key === "y" || event.shiftKey ? "redo" : "undo");
    });
  }

  private showPlaying() {
    byId("play").textContent = this.playing ? "Pause" : "Play";
  }

  private now(): State {
    const { task, answer, choice } = this;
    const candidates = answer?.candidates ?? [];
    const chosen =
      choice &&
      ("pin" in choice
        ? { pin: this.pinned.indexOf(choice.pin) }
        : { candidate: candidates.indexOf(choice.candidate) });
    return { task, photo: this.underlay.placed, view: this.board.looking, answer, chosen };
  }

  /** Notes what stands before a change, so that it can be undone. */
  private note() {
    this.steps.note(this.now());
    this.showSteps();
  }

  private back(way: "undo" | "redo") {
    const then = way === "undo" ? this.steps.undo(this.now()) : this.steps.redo(this.now());
    if (then) this.restore(then);
  }

  private restore(then: State) {
    if (then.photo) this.underlay.place(then.photo);
    this.board.look(then.view);
    this.put(then.task, {});
    const { answer, chosen } = then;
    if (!answer || answer.candidates.length === 0) return;
    this.answer = answer;
    this.restored = { version: this.version, answer };
    this.nine.hear(answer);
    const candidate = chosen && "candidate" in chosen ? answer.candidates[chosen.candidate] : undefined;
    const pin = chosen && "pin" in chosen ? this.pinned[chosen.pin] : undefined;
    this.choice = candidate ? { candidate } : pin ? { pin } : null;
    this.draw();
  }

  private async save(name: string, text: Promise<string>) {
    try {
      api.saved(new Blob([await text], { type: "application/toml" }), `${name}.toml`);
      this.say(`Saved as ${name}.toml.`);
    } catch (error) {
      this.say(`This cannot be saved: ${api.wordsOf(error)}`);
    }
  }
}

void new Page().begin();
