// The page: the target and what is asked of the linkage on one side, the studio's answers on the other.

import { figure } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import { Board, type Tool } from "./board";
import { BuildPanel } from "./build";
import { ByHand } from "./byhand";
import { isSame } from "./choice";
import { Clock } from "./clock";
import { Connection } from "./connection";
import { Desk } from "./desk";
import { EXAMPLES, type Example } from "./examples";
import { type Moving, movingOf } from "./figures";
import { evenly, takesText, taskOfText, watchFiles } from "./files";
import { changing } from "./focus";
import { Gallery } from "./gallery";
import type { Linkage } from "./grab";
import { Guide } from "./guide";
import { Helps, Kept } from "./helps";
import { remember, remembered, Steps } from "./memory";
import type { Answer, AnyAsk, Point, Shown, Solution, Task } from "./messages";
import { nameFault } from "./names";
import { Nine } from "./nine";
import { Pace } from "./pace";
import { PhotographPanel } from "./photograph";
import { fillRequirements, listenToRequirements } from "./requirements";
import { Said } from "./said";
import { MOST_PINNED, Showing } from "./showing";
import { SizeChip } from "./size";
import { Stays } from "./stays";
import { inWords, isExact, Strip } from "./strip";
import { SureChip } from "./sure";
import { Table } from "./table";
import { Tabs, WIDE } from "./tabs";
import { moved } from "./target";
import * as tasks from "./task";
import { type Placed, Underlay } from "./underlay";
import { rescaled, type View } from "./view";
import { Voice } from "./voice";

/** What a step back brings back. */
interface State {
  task: Task;
  photo: Placed | null;
  view: View;
  answer: Answer | null;
  chosen: { pin: number } | { candidate: number } | null;
  byHand: Shown | null;
  isWalker: boolean;
}

/** Milliseconds after which a view that rests is remembered. */
const REST = 300;

const TOOLS: Tool[] = ["draw", "points", "grab", "pivots_in", "footprint_in", "photo-move", "photo-scale"];
/** What a tool is for, said when it is taken for the first time. */
const TOOL_SAID: Partial<Record<Tool, string>> = {
  points: "A click on the path puts a point there, a click beside it one behind the last. Clear begins anew.",
  grab: "Drag a joint of the linkage, or the middle of its crank to turn it. Drag elsewhere to move the board.",
};

const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const input = (id: string) => byId<HTMLInputElement>(id);

class Page {
  private task: Task = EXAMPLES[0].task;
  private steps = new Steps<State>();
  private version = 0;
  /** The edit that began this target: what is said of earlier ones belongs to another. */
  private since = 0;
  private heard = 0;
  /** What the board and the strip show: the candidates, then what is pinned. */
  private moving: Moving[] = [];
  /** The linkage that the board has shown last. */
  private onBoard: Shown | null = null;
  private hints = true;
  /** Whether the linkage moved when it was taken into the hand. */
  private wasPlaying = false;
  private isOdd = false;
  private begunWith = "null";
  private filling: ReturnType<typeof setTimeout> | undefined;
  private looking: ReturnType<typeof setTimeout> | undefined;
  private connection: Connection | null = null;
  /** What the page has written among the coordinates; anything else is the user's, until it is taken. */
  private written = "";
  private coordinates = byId<HTMLTextAreaElement>("coordinates");

  private voice = new Voice();
  private said = new Said(byId("status"), byId<HTMLProgressElement>("progress"), this.voice);
  private pace = new Pace();
  private guide = new Guide();
  private sure = new SureChip(byId("sure"));
  private underlay = new Underlay(() => this.showUnderlay());
  private board = this.makeBoard();
  private clock = new Clock((part) => this.pose(part));
  private strip = new Strip(
    byId("strip"),
    (i) => this.choose(i),
    (i) => this.pin(i),
  );
  private nine = new Nine(byId("nine"), () => {
    this.showing.filtered();
    this.draw();
  });
  private showing = new Showing(this.nine);
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
  private helps = new Helps(byId("helps"), (make, said) => {
    this.replace(make(this.task));
    this.say(`Changed: ${said}.`);
  });
  private stays = new Stays(byId("stays"), () => this.replace(tasks.pathAlone(this.task)));
  private kept = new Kept(byId("kept"), (make) => this.replace(make(this.task)));
  private size = new SizeChip(byId("board"), (by) => this.lengthsTimes(by));
  private desk = new Desk(byId("desk"), byId("share"), {
    task: () => this.task,
    chosen: () => this.chosen(),
    pinned: () => this.showing.pinned,
    take: (task) => this.open(tasks.taskOf({ ...task, version: 0 })),
    keep: (one) => this.keepShown(one),
  });
  private byHand = new ByHand(byId("by-hand"), {
    task: () => this.task,
    changed: () => this.handChanged(),
    note: () => this.note(),
    fit: (kept, from) => this.fitAgain(kept, from),
    say: (text) => this.said.refuse(text),
  });
  private build = new BuildPanel(
    byId("build"),
    this.desk.host,
    () => this.rank(),
    () => this.board.isWalker,
  );
  private tabs = new Tabs(document.querySelector(".rail") as HTMLElement, (tab) => this.build.open(tab === "build"));
  private gallery = new Gallery(byId("gallery"), byId<HTMLButtonElement>("examples"), (example) => this.load(example));

  constructor() {
    this.listen();
  }

  private makeBoard(): Board {
    return new Board(
      byId("board"),
      {
        drawn: (points, closed) => {
          this.pace.penUp();
          this.guide.done("draw");
          this.replace(tasks.drawnAnew(this.task, points, closed), { fresh: true });
          this.stays.show(this.task);
        },
        grasp: () => this.note(),
        letGo: () => {
          const before = this.steps.giveUp();
          if (before) this.restore(before);
        },
        drag: (index, to, last) => this.drag(index, to, last),
        add: (at, after) => this.replace(tasks.withAdded(this.task, after, at)),
        remove: (index) => this.replace(tasks.withRemoved(this.task, index)),
        box: (kind, box, last) => {
          this.put({ ...this.task, [kind]: box ?? undefined }, { moving: !last });
          if (last && this.board.tool === kind) this.use("draw");
        },
        tolerance: (index, radius, last) =>
          this.put(tasks.withToleranceAt(this.task, index, radius), { moving: !last }),
        joint: (pose, joint, to) => this.byHand.drag(pose, joint, to),
        turn: (crankDeg) => this.turn(crankDeg),
        marked: () => this.photograph.marked(),
        looked: () => {
          // A view that the user has changed is remembered, once it rests.
          clearTimeout(this.looking);
          if (this.connection) this.looking = setTimeout(() => this.keep(), REST);
        },
        takeCloser: () => {
          this.showing.takeBest();
          this.draw();
        },
      },
      (text) => this.say(text),
      this.underlay,
    );
  }

  /** Takes another problem, and brings its path into the middle. */
  private open(task: Task, isWalker = false, from?: Linkage) {
    this.board.selected = -1;
    this.replace(task, { fresh: true, from });
    this.walk(isWalker);
    this.board.fitPath(task);
  }

  private load({ task, isWalker }: Example) {
    this.use("draw");
    this.open(task, isWalker);
  }

  async begin() {
    const kept = remembered();
    let view = kept?.view;
    let from: Linkage | undefined;
    let isWalker = kept ? kept.isWalker === true : EXAMPLES[0].isWalker === true;
    if (kept) {
      ({ task: this.task, hints: this.hints, begunWith: this.begunWith } = kept);
      this.showing.pinned = kept.pinned;
      if (nameFault(this.task.name) !== null) this.task = { ...this.task, name: "drawing" };
    }
    try {
      const begunWith = await api.beginning();
      const given = JSON.parse(begunWith) as AnyAsk | null;
      if (given && this.begunWith !== begunWith) {
        if (kept) this.note();
        view = undefined;
        isWalker = false;
        this.task = tasks.taskOf(given);
        from = given.from;
      }
      this.begunWith = begunWith;
      this.gallery.open(!kept && !given && innerHeight >= 600 && innerWidth >= 700);
    } catch {
      // The studio has ended or is busy: what is remembered is shown all the same, and what was given waits for a reload.
    }
    byId("hints").hidden = !this.hints;
    this.walk(isWalker);
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
    this.put(this.task, from ? { fresh: true, from } : {});
    void this.desk.begin();
    this.play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  }

  /** Another task in place of the one that stands, which can be undone. */
  private replace(task: Task, how: { fresh?: boolean; from?: Linkage } = {}) {
    if (JSON.stringify(task) !== JSON.stringify(this.task)) this.note();
    this.put(task, how);
  }

  private drag(index: number, to: Point, last: boolean) {
    if (last) this.guide.done("drag");
    // Nine points are precise: none takes its neighbours along.
    this.put(tasks.withMoved(this.task, moved(this.task.points, index, to, this.task.closed)), { moving: !last });
  }

  private lengthsTimes(by: number) {
    this.note();
    if (this.underlay.placed) this.underlay.lengthsTimes(by);
    this.board.look(rescaled(this.board.looking, by));
    this.put(tasks.withLengthsTimes(this.task, by), {});
  }

  private use(tool: Tool) {
    this.board.tool = tool;
    const said = TOOL_SAID[tool];
    delete TOOL_SAID[tool];
    if (said && this.task.points.length > 0) this.desk.say(said);
    for (const button of document.querySelectorAll("[id^=tool-]"))
      button.setAttribute("aria-pressed", String(button.id === `tool-${tool}`));
    if (tool === "grab") this.grab();
    this.board.redraw();
  }

  /** Takes the linkage on the board into the hand: it stands still, and is changed from now on. */
  private grab() {
    const chosen = this.chosen();
    if (!chosen) return this.desk.say("There is no linkage to grab yet.");
    this.wasPlaying ||= this.clock.playing;
    this.play(false);
    if (!this.byHand.shown) {
      this.note();
      this.byHand.take(chosen.shown);
    }
    if (!matchMedia(WIDE).matches) this.tabs.open("linkages");
  }

  /** Another linkage is in the hand, or none any more: the crank stays where it stands. */
  private handChanged() {
    const before = this.board.standing;
    this.draw();
    const { shown } = this.byHand;
    if (!shown) {
      if (this.board.tool === "grab") this.use("draw");
      if (this.wasPlaying) this.play(true);
      this.wasPlaying = false;
    } else if (before) {
      const { A } = shown.linkage;
      this.turn((Math.atan2(before.C[1] - A[1], before.C[0] - A[0]) * 180) / Math.PI);
    }
    this.desk.changed(true);
    this.build.later();
  }

  private turn(crankDeg: number) {
    const moving = this.moving[this.place()];
    if (!moving) return;
    this.play(false);
    this.clock.set(moving.partOf(crankDeg));
  }

  /** Searches with what is locked of the linkage in the hand. */
  private fitAgain(kept: Record<string, string>, from: Linkage) {
    const others = Object.entries(this.task.kept ?? {}).filter(([key]) => !key.startsWith("design."));
    // A bounded length ends the default of the longest link: on the page that limit stays.
    const task = tasks.withLongestSaid({ ...this.task, kept: Object.fromEntries(others) });
    this.put({ ...task, kept: { ...task.kept, ...kept } }, { fresh: true, from });
    this.desk.say("Your linkage is fitted again; others are searched beside it. What is locked stands under Wishes.");
  }

  private showUnderlay() {
    this.board?.redraw();
    this.photograph?.show();
  }

  private async takeText(text: string, name: string) {
    const read = await taskOfText(text, name, this.task, input("samples").valueAsNumber || undefined);
    if (typeof read === "string") return this.said.refuse(`These are no coordinates: ${read}`);
    if (text === this.coordinates.value) this.written = text;
    const fewer = evenly(read.task);
    if (fewer) {
      this.said.refuse(
        `These are ${read.task.points.length} points, more than the studio searches: ${fewer.points.length} evenly along them are taken instead.`,
      );
      return this.open(fewer);
    }
    this.open(read.task, false, read.from);
    return this.say(`Taken: ${read.said}.`);
  }

  /** Takes a task: shown, remembered, sent. */
  private put(edited: Task, how: { moving?: boolean; fresh?: boolean; from?: Linkage }) {
    // Another name is no reason to search again.
    if (edited.name !== this.task.name && !how.fresh && tasks.isSameButForName(edited, this.task)) {
      this.task = edited;
      this.draw();
      return this.settle();
    }
    const task = tasks.withoutStale(this.task, edited);
    if (edited.expect && !task.expect)
      this.desk.say(
        "The figures published for this problem hold for it as it was opened: they are let go. Undo brings them back.",
      );
    this.task = task;
    this.size.show(task);
    this.version += 1;
    const short = task.points.length < 3;
    if (how.fresh || short) {
      this.since = this.version;
      this.showing.clear();
      this.onBoard = null;
      this.sure.show(null, "");
      if (this.byHand.shown) this.byHand.take(null);
      if (how.from) this.showing.expectOwn(this.version);
    }
    this.stays.show(null);
    const held = how.moving ? this.showing.hold() : undefined;
    if (!how.moving) {
      this.showing.letGo();
      this.byHand.again();
    }
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
      ...(how.moving ? { moving: true, held } : {}),
      ...(fresh ? { fresh } : {}),
      ...(how.from ? { from: how.from } : {}),
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
    this.pace.answered(answer, this.version);
    if (this.showing.hear(answer, this.version).chosenIsGone)
      this.desk.say("The linkage that was chosen is not among these any more: the best one is shown.");
    document.body.dataset.doing = answer.doing;
    document.body.dataset.answered = String(answer.version);
    this.draw();
    const best = this.showing.answer?.candidates[0];
    const unit = this.task.unit ? ` ${this.task.unit}` : "";
    const near =
      best && (best.ability || isExact(best))
        ? "exactly through the points"
        : `rms ${figure(best?.rms ?? 0, 3)}${unit}`;
    const head = best ? `Best: ${near}, ${inWords(best)}. ` : "";
    // How the search went stands behind the chip that says how sure it is.
    const [short, ...rest] = answer.said.split("\n");
    const isSaid = answer.sure !== undefined;
    this.sure.show(answer.sure ?? null, isSaid ? [short, ...rest].join("\n") : "");
    this.desk.changed(answer.doing === "done");
    this.build.later();
    const status = head + (isSaid ? short : answer.said);
    this.voice.answered(answer, status);
    this.said.tell(status, answer.doing === "searching" ? answer.progress : undefined);
  }

  private place() {
    return this.byHand.shown ? this.moving.length - 1 : this.showing.place();
  }

  /** The linkage that the board shows: the one in the hand, or the chosen one. */
  private chosen(): Solution | null {
    return this.byHand.solution() ?? this.showing.chosen(this.task);
  }

  /** Its number in the list, for the names of files: one in the hand that was not changed has it too. */
  private rank(): string {
    if (this.byHand.isChanged) return "by-hand";
    const [place, found] = [this.showing.place(), this.showing.candidates().length];
    return place < found ? String(place + 1) : `pinned-${place - found + 1}`;
  }

  private draw() {
    const all = this.showing.all(this.task);
    const inHand = this.byHand.solution();
    this.moving = [...all, ...(inHand ? [inHand] : [])].map(({ shown, task }) => movingOf(shown, task.points));
    this.drawBoard();
    const cards = this.moving.slice(0, all.length);
    const { own } = this.showing;
    this.strip.show(cards, all, this.showing.candidates().length, inHand ? -1 : this.showing.place(), own);
    byId("nothing").hidden = all.length > 0;
    const { answer } = this.showing;
    this.helps.show(answer?.relaxations ?? [], this.task.unit, tasks.nearestInstead(this.task, answer));
    this.showSteps();
    byId<HTMLButtonElement>("linkage-file").disabled = !this.chosen();
    this.strip.pose(this.clock.part);
  }

  /** The board alone: the target as it stands, the linkage that was last answered. */
  private drawBoard() {
    const shown = this.moving[this.place()] ?? null;
    const { pinned } = this.showing;
    const found = this.showing.candidates().length;
    const pins = pinned.map(({ colour = 0 }, i) => ({ moving: this.moving[found + i], colour }));
    const another = shown !== null && this.onBoard !== null && !isSame(shown.shown, this.onBoard);
    this.onBoard = shown?.shown ?? this.onBoard;
    this.board.show(
      this.task,
      shown,
      pins.filter(({ moving }) => moving && moving !== shown),
      another,
    );
    this.board.offer(this.byHand.shown ? null : this.showing.offer());
  }

  private pose(part: number) {
    this.board.pose(part);
    if (document.activeElement !== input("turn")) input("turn").value = part.toFixed(3);
    // The small pictures move in every other picture of the board.
    this.isOdd = !this.isOdd;
    if (this.isOdd && this.clock.playing) return;
    this.strip.pose(part);
    this.gallery.pose(part);
  }

  private showSteps() {
    byId<HTMLButtonElement>("undo").disabled = !this.steps.canUndo;
    byId<HTMLButtonElement>("redo").disabled = !this.steps.canRedo;
  }

  private choose(index: number) {
    if (this.byHand.shown) {
      this.note();
      this.byHand.take(null);
    }
    this.showing.choose(index, this.task);
    this.draw();
    this.desk.chose();
    this.build.later();
  }

  /** Keeps a linkage to compare others with. */
  private keepShown(one: Solution) {
    if (!this.showing.pin(one)) return this.desk.say(`${MOST_PINNED} are pinned already: unpin one of them first.`);
    this.keep();
    this.draw();
  }

  /** Pins a candidate to compare others with it, or lets a pinned one go. */
  private pin(index: number) {
    const one = this.showing.all(this.task)[index];
    if (index < this.showing.candidates().length) {
      this.guide.done("pin");
      return this.keepShown(one);
    }
    this.showing.unpin(one);
    this.keep();
    this.draw();
  }

  private keep() {
    const { task, begunWith, hints } = this;
    const { isWalker } = this.board;
    remember({ task, pinned: this.showing.pinned, begunWith, hints, view: this.board.looking, isWalker });
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
    this.kept.show(task);
    this.table.show(task);
    const text = this.coordinates;
    if (document.activeElement !== text && [this.written, ""].includes(text.value)) {
      text.value = task.points.map((p) => p.join(", ")).join("\n");
      this.written = text.value;
    }
    byId("point-count").textContent = String(task.points.length);
    byId("point-word").textContent = task.points.length === 1 ? "point" : "points";
  }

  private listen() {
    const click = (id: string, act: () => void) => byId(id).addEventListener("click", act);
    // Pressed again, a tool is laid down.
    for (const tool of TOOLS) click(`tool-${tool}`, () => this.use(this.board.tool === tool ? "draw" : tool));
    click("undo", () => this.back("undo"));
    click("redo", () => this.back("redo"));
    click("clear", () => {
      // Everything: the path and what was asked of it. Undo brings it back.
      this.replace(tasks.pathAlone({ ...this.task, name: "drawing", source: undefined, points: [], closed: false }), {
        fresh: true,
      });
      this.walk(false);
      this.gallery.open(false);
      this.board.open(this.task.unit);
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
      (file) => {
        this.tabs.open("points");
        void this.photograph.take(file);
      },
    );
    click("fit", () => this.board.fit());
    click("nearer", () => this.board.zoom(1.25));
    click("farther", () => this.board.zoom(0.8));
    click("play", () => this.play(!this.clock.playing));
    input("turn").addEventListener("input", () => {
      this.play(false);
      this.clock.set(input("turn").valueAsNumber);
    });
    input("walker").addEventListener("change", () => {
      this.note();
      this.walk(input("walker").checked);
      this.keep();
    });
    byId("board").addEventListener("pointerdown", () => this.gallery.open(false));
    click("hide-hints", () => {
      this.hints = false;
      changing(
        byId("gallery"),
        () => {
          byId("hints").hidden = true;
          this.gallery.open(false);
        },
        this.board.svg,
      );
      this.keep();
    });
    click("problem-file", () => void this.save(this.task.name, api.problemOf(this.task)));
    click("linkage-file", () => {
      const chosen = this.chosen();
      if (!chosen) return;
      const name = `${chosen.task.name}-${this.rank()}`.slice(-64);
      void this.save(name, api.linkageOf(name, chosen));
    });
    input("closed").addEventListener("change", () =>
      this.replace(tasks.settled({ ...this.task, closed: input("closed").checked })),
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

  private play(on: boolean) {
    this.clock.play(on);
    byId("play").textContent = on ? "Pause" : "Play";
  }

  /** Shows the ground and a second leg, or takes them away. */
  private walk(on: boolean) {
    this.board.isWalker = on;
    input("walker").checked = on;
    this.board.redraw();
  }

  private now(): State {
    return {
      task: this.task,
      photo: this.underlay.placed,
      view: this.board.looking,
      answer: this.showing.answer,
      chosen: this.showing.chosenPlace(),
      byHand: this.byHand.shown,
      isWalker: this.board.isWalker,
    };
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
    this.walk(then.isWalker);
    this.put(then.task, {});
    const { answer, chosen } = then;
    if (answer && answer.candidates.length > 0) this.showing.restore(answer, this.version, chosen);
    if (then.byHand || this.byHand.shown) this.byHand.take(then.byHand, then.byHand !== null);
    if (then.byHand && this.board.tool !== "grab") this.use("grab");
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
