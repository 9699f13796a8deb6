// The page: the target and what is asked of the linkage on one side, the studio's answers on the other. The store holds
// the task, the exchange talks to the studio, the scene shows what was found; here they meet.

import { figure } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import { Board } from "./board";
import { BuildTab } from "./buildtab";
import { ByHand } from "./byhand";
import { listenToControls } from "./controls";
import { Desk } from "./desk";
import { EXAMPLES, type Example } from "./examples";
import { Exchange } from "./exchange";
import { evenly, taskOfText } from "./files";
import { Gallery } from "./gallery";
import { Guide } from "./guide";
import { Helps, Kept } from "./helps";
import { byId, input } from "./ids";
import { type Kit, kitFor, more } from "./kit";
import { errorUnit, labelled, nounOf } from "./labels";
import { type Place, remember, remembered } from "./memory";
import {
  type Answer,
  type AnyAsk,
  fourBarOf,
  type Linkage,
  type Point,
  pivotsOf,
  type Shown,
  type Task,
} from "./messages";
import { nameFault } from "./names";
import { Nine } from "./nine";
import { PhotographPanel } from "./photograph";
import { fillRequirements, listenToRequirements } from "./requirements";
import { Said } from "./said";
import { Scene } from "./scene";
import { MOST_PINNED, Showing } from "./showing";
import { SizeChip } from "./size";
import { namesOfAsked, Stays } from "./stays";
import { type How, Store } from "./store";
import { inWords, isExact, MANY, Strip } from "./strip";
import { SureChip } from "./sure";
import type { Hand, Tool } from "./surface";
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
  chosen: Place;
  byHand: Shown | null;
  isWalker: boolean;
  lengths: number;
}

/** Milliseconds after which a view or a linkage in the hand that rests is remembered. */
const VIEW_RESTS = 300;
/** Milliseconds for which the controls wait while the hand moves. */
const CONTROLS_WAIT = 100;

const TOOLS: Tool[] = ["draw", "points", "poses", "grab", "pivots_in", "footprint_in", "photo-move", "photo-scale"];
const CORNERS = "Drag from corner to corner.";
/** What a tool is for, said when it is taken for the first time. */
const TOOL_SAID: Partial<Record<Tool, string>> = {
  points: "A click on the path puts a point there, a click beside it one behind the last. Clear begins anew.",
  pivots_in: CORNERS,
  footprint_in: CORNERS,
  grab: "Drag a joint of the linkage, or the middle of its crank to turn it. Drag elsewhere to move the board.",
};

class Page {
  private hints = true;
  /** Whether the linkage moved when it was taken into the hand. */
  private wasPlaying = false;
  private begunWith = "null";
  /** How many times as long as at first all lengths have been made. */
  private lengths = 1;
  /** The time until which many cards wait for a hand that moves. */
  private cardsWait = 0;
  private filling: ReturnType<typeof setTimeout> | undefined;
  private looking: ReturnType<typeof setTimeout> | undefined;
  /** What the page has written among the coordinates; anything else is the user's, until it is taken. */
  private written = "";
  private coordinates = byId<HTMLTextAreaElement>("coordinates");

  private store = new Store<State>(
    EXAMPLES[0].task,
    () => this.now(),
    ({ canUndo, canRedo }) => {
      byId<HTMLButtonElement>("undo").disabled = !canUndo;
      byId<HTMLButtonElement>("redo").disabled = !canRedo;
    },
  );
  private voice = new Voice();
  private said = new Said(byId("status"), byId<HTMLProgressElement>("progress"), this.voice);
  private exchange = new Exchange(this.store, {
    answered: (answer) => this.answered(answer),
    refused: (said) => this.say(`This cannot be searched: ${labelled(said)}`),
    closed: (why) => this.say(why),
  });
  private guide = new Guide();
  private sure = new SureChip(byId("sure"));
  private underlay = new Underlay(() => this.showUnderlay());
  private board = new Board(byId("stage"), this.hand(), (text) => this.say(text), this.underlay);
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
    () => this.store.note(),
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
  private size = new SizeChip(byId("stage"), (by) => this.lengthsTimes(by));
  private desk = new Desk(byId("desk"), byId("share"), {
    task: () => this.task,
    chosen: () => this.scene.chosen(),
    name: () => this.scene.name(),
    pinned: () => this.showing.pinned,
    take: (task) => this.open(tasks.taskOf({ ...task, version: 0 })),
    keep: (one) => this.keepShown(one),
    kit: () => this.kit((kit) => kit),
  });
  private byHand = new ByHand(byId("by-hand"), {
    task: () => this.task,
    changed: () => this.handChanged(),
    note: () => this.store.note(),
    fit: (kept, from) => this.fitAgain(kept, from),
    say: (text) => this.said.refuse(text),
  });
  private gallery = new Gallery(
    byId("gallery"),
    byId<HTMLButtonElement>("examples"),
    (example) => this.load(example),
    (name) => void this.kit((kit) => this.load(kit.example(name))),
  );
  private scene = new Scene({
    board: this.board,
    strip: this.strip,
    gallery: this.gallery,
    showing: this.showing,
    byHand: this.byHand,
    play: byId("play"),
    turn: input("turn"),
    task: () => this.task,
  });
  private build = new BuildTab(() =>
    this.kit(
      ({ panel: Panel }) =>
        new Panel(
          byId("build"),
          this.desk.host,
          () => this.scene.rank(),
          () => this.board.isWalker,
          () => this.keep(),
        ),
    ),
  );
  private tabs = new Tabs(
    document.querySelector(".rail") as HTMLElement,
    (tab) => void this.build.open(tab === "build"),
  );

  constructor() {
    // Pressed again, a tool is laid down.
    for (const tool of TOOLS)
      byId(`tool-${tool}`).addEventListener("click", () => {
        if (tool === "poses") void this.kit((kit) => kit.motion());
        this.use(this.board.tool === tool ? this.idle : tool);
      });
    byId("board").addEventListener("pointerdown", () => this.gallery.open(false));
    listenToRequirements({
      now: () => this.task,
      change: (task) => this.replace(task),
      ofKinds: (kinds) => void this.kit((kit) => kit.ofKinds(kinds)),
      shown: () => this.board.fit(),
      isWalker: () => this.board.isWalker,
      standing: () => this.scene.box(),
      say: (text) => this.desk.say(text),
    });
    listenToControls({
      back: (way) => this.back(way),
      clear: () => this.clear(),
      fit: () => this.board.fit(),
      zoom: (by) => this.board.zoom(by),
      walk: (on) => {
        this.store.note();
        this.walk(on);
        this.draw();
        this.keep();
        const hips = on && this.scene.chosen()?.shown.linkage;
        const ground = tasks.boxOf(this.task.points)?.[1] ?? 0;
        if (hips && pivotsOf(hips).some(([, y]) => y < ground))
          this.desk.say("The hips lie below the ground: tick “both fixed pivots inside a box” under Wishes.");
      },
      close: (closed) => this.replace(tasks.settled({ ...this.task, closed })),
      hideHints: () => {
        this.hints = false;
        byId("hints").hidden = true;
        this.gallery.open(false);
        this.keep();
      },
      saveProblem: () => void this.save(this.task.name, api.problemOf(this.task)),
      saveLinkage: () => {
        const chosen = this.scene.chosen();
        if (!chosen) return;
        const name = `${chosen.task.name}-${this.scene.rank()}`.slice(-64);
        void this.save(name, api.linkageOf(name, chosen));
      },
      takeText: (text, name) => void this.takeText(text, name),
      takePicture: (file) => {
        this.tabs.open("points");
        void this.photograph.take(file);
      },
    });
  }

  private get task(): Task {
    return this.store.task;
  }

  /** Does something with the second script once it is there. */
  private async kit<What>(act: (kit: Kit) => What): Promise<What> {
    try {
      return act(
        await kitFor(() => ({
          board: this.board,
          hand: this.hand(),
          task: () => this.task,
          replace: (task, how) => this.replace(task, how),
          put: (task, how) => this.put(task, how),
          use: (tool) => this.use(tool),
          say: (text) => this.say(text),
          tell: (text) => this.desk.say(text),
          map: (on) => {
            more.map = on;
            this.exchange.send({}, undefined);
          },
        })),
      );
    } catch (error) {
      this.desk.say(`A part of the page cannot be loaded: ${api.wordsOf(error)}`, true);
      throw error;
    }
  }

  /** What the board tells of the hand on it. */
  private hand(): Hand {
    return {
      drawn: (points, closed) => {
        this.exchange.penUp();
        this.guide.done("draw");
        this.replace(tasks.drawnAnew(this.task, points, closed), { fresh: true });
        this.stays.show(this.task);
      },
      grasp: () => this.store.note(),
      letGo: () => {
        const before = this.store.giveUp();
        if (before) this.restore(before);
      },
      drag: (index, to, last) => this.drag(index, to, last),
      add: (at, after) => this.replace(tasks.withAdded(this.task, after, at)),
      remove: (index) => this.replace(tasks.withRemoved(this.task, index)),
      box: (kind, box, last) => {
        this.put({ ...this.task, [kind]: box ?? undefined }, { moving: !last });
        if (last && this.board.tool === kind) this.use(this.idle);
      },
      tolerance: (index, radius, last) => this.put(tasks.withToleranceAt(this.task, index, radius), { moving: !last }),
      joint: (pose, joint, to) => this.byHand.drag(pose, joint, to),
      turn: (crankDeg) => this.scene.turn(crankDeg),
      marked: () => this.photograph.marked(),
      drawnAt: (marks, links) => this.size?.clearOf(marks, links),
      looked: () => this.keepLater(),
      takeCloser: () => {
        this.showing.takeBest();
        this.draw();
      },
    };
  }

  /** Takes another problem, and brings its path into the middle. */
  private open(task: Task, isWalker = false, from?: Linkage) {
    this.board.selected = -1;
    this.replace(task, { fresh: true, from });
    this.walk(isWalker);
    if (task.body || task.function || this.board.tool === "poses") this.use(this.idle);
    this.board.fitPath(task);
  }

  private load({ task, isWalker }: Example) {
    this.use("draw");
    this.open(task, isWalker);
  }

  /** Clears everything: the path and what was asked of it. Undo brings it back. */
  private clear() {
    const asked = namesOfAsked(this.task);
    const nothing = tasks.pathAlone({ ...this.task, name: "drawing", source: undefined, points: [], closed: false });
    const body = this.task.body && { angle_deg: [] };
    this.replace({ ...nothing, body }, { fresh: true });
    // Points are clicked anew; a box is not drawn beside nothing.
    if (this.board.tool !== "points") this.use(this.idle);
    this.walk(false);
    this.gallery.open(false);
    this.board.open(this.task.unit);
    if (asked.length > 0) this.say(`Cleared, with what was asked: ${asked.join(", ")}. Undo brings it back.`);
  }

  async begin() {
    const kept = remembered();
    let view = kept?.view;
    let { answer } = kept ?? {};
    let from: Linkage | undefined;
    let isWalker = kept ? kept.isWalker === true : EXAMPLES[0].isWalker === true;
    if (kept) {
      ({ hints: this.hints, begunWith: this.begunWith } = kept);
      this.store.task = nameFault(kept.task.name) === null ? kept.task : { ...kept.task, name: "drawing" };
      this.showing.pinned = kept.pinned;
      this.build.sizes = kept.build ?? {};
    }
    try {
      const begunWith = await api.beginning();
      const given = JSON.parse(begunWith) as AnyAsk | null;
      if (given && this.begunWith !== begunWith) {
        if (kept) this.store.note();
        view = answer = undefined;
        isWalker = false;
        this.store.task = tasks.taskOf(given);
        from = given.from;
      }
      this.begunWith = begunWith;
      this.gallery.open(!kept && !given && innerHeight >= 600 && innerWidth >= 700);
    } catch {
      // The studio has ended or is busy: what is remembered is shown all the same, and what was given waits for a reload.
    }
    byId("hints").hidden = !this.hints;
    this.use(this.idle);
    this.walk(isWalker);
    this.board.show(this.task, null, []);
    if (view) this.board.look(view);
    else if (this.task.points.length > 0) this.board.fitPath(this.task);
    else this.board.open(this.task.unit);
    this.showUnderlay();
    this.exchange.begin();
    this.put(this.task, from ? { fresh: true, from } : {});
    if (answer) {
      const { version } = this.store;
      this.showing.restore({ ...answer, version }, version, kept?.chosen ?? null);
      this.holdAgain(kept?.byHand ?? null);
      this.draw();
      this.keep();
    }
    void this.desk.begin();
    const moves = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (this.byHand.shown) this.wasPlaying = moves;
    else this.scene.play(moves);
  }

  /** Another task in place of the one that stands, which can be undone. */
  private replace(task: Task, how: How = {}) {
    if (JSON.stringify(task) !== JSON.stringify(this.task)) this.store.note();
    this.put(task, how);
  }

  private drag(index: number, to: Point, last: boolean) {
    if (last) this.guide.done("drag");
    // Nine points are precise: none takes its neighbours along.
    this.put(tasks.withMoved(this.task, moved(this.task.points, index, to, this.task.closed)), { moving: !last });
  }

  private lengthsTimes(by: number) {
    this.store.note();
    if (this.underlay.placed) this.underlay.lengthsTimes(by);
    this.board.look(rescaled(this.board.looking, by));
    this.makeLengths(this.lengths * by);
    this.put(tasks.withLengthsTimes(this.task, by), {});
  }

  /** What is pinned for this path grows with it, and shrinks with a step back. */
  private makeLengths(lengths: number) {
    if (lengths !== this.lengths) this.showing.pinsTimes(this.task, lengths / this.lengths);
    this.lengths = lengths;
  }

  /** What one of the targets is called. */
  private get noun(): string {
    return nounOf(this.task);
  }

  /** The tool that is taken where no other is. */
  private get idle(): Tool {
    return this.task.body || this.task.function ? "poses" : "draw";
  }

  private use(tool: Tool) {
    this.board.tool = tool;
    const said = TOOL_SAID[tool];
    if (said !== CORNERS) delete TOOL_SAID[tool];
    if (said && (said === CORNERS || this.task.points.length > 0)) this.desk.say(said);
    // Of a function nothing is held on the board.
    const pressed = this.task.function && tool === "poses" ? "" : `tool-${tool}`;
    for (const button of document.querySelectorAll("[id^=tool-]"))
      button.setAttribute("aria-pressed", String(button.id === pressed));
    if (tool === "grab") this.grab();
    this.board.redraw();
  }

  /** Takes the linkage on the board into the hand: it stands still, and is changed from now on. */
  private grab() {
    const chosen = this.scene.chosen();
    if (!chosen) return this.desk.say("There is no linkage to grab yet.");
    if (!fourBarOf(chosen.shown.linkage))
      return this.desk.say("The hand changes four-bars; one with a slider follows what is drawn and asked.");
    this.wasPlaying ||= this.scene.isPlaying;
    this.scene.play(false);
    if (!this.byHand.shown) {
      this.store.note();
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
      if (this.board.tool === "grab") this.use(this.idle);
      if (this.wasPlaying) this.scene.play(true);
      this.wasPlaying = false;
    } else if (before) {
      const [A] = pivotsOf(shown.linkage);
      this.scene.turn((Math.atan2(before.C[1] - A[1], before.C[0] - A[0]) * 180) / Math.PI);
    }
    this.desk.changed(true);
    this.build.later();
    this.keepLater();
  }

  /** Takes the linkage into the hand that a state had there; null: none. */
  private holdAgain(byHand: Shown | null) {
    if (byHand || this.byHand.shown) this.byHand.take(byHand, byHand !== null);
    if (byHand && this.board.tool !== "grab") this.use("grab");
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
  private put(edited: Task, how: How) {
    const { isName, isStale, isFresh } = this.store.take(edited, how);
    const { task, version } = this.store;
    if (isName) {
      this.draw();
      return this.settle();
    }
    if (isStale)
      this.desk.say(
        "The figures published for this problem hold for it as it was opened: they go. Undo brings them back.",
      );
    this.size.show(task);
    if (!more.kit && (task.body || task.function || task.mechanism || task.input))
      void this.kit(() => {
        this.board.redraw();
        this.settle();
      });
    if (isFresh) {
      this.showing.clear();
      if (this.idle === "poses") this.walk(false);
      this.scene.clear();
      this.sure.show(null, "");
      if (this.byHand.shown) this.byHand.take(null);
      if (how.from) this.showing.expectOwn(version);
      this.build.later();
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
      this.scene.drawBoard();
      this.filling = setTimeout(() => this.settle(), CONTROLS_WAIT);
    } else {
      this.draw();
      this.settle();
    }
    if (this.store.isShort)
      this.say(
        task.body
          ? "A motion has at least two poses: click on the board, and drag to turn."
          : "A path has at least three points: draw on the board, or click points.",
      );
    this.exchange.send(how, held);
  }

  /** Brings the controls to what the task says, and remembers it. */
  private settle() {
    this.fill();
    this.keep();
  }

  private answered(answer: Answer) {
    if (this.showing.hear(answer, this.store.version).chosenIsGone)
      this.desk.say("The linkage that was chosen is not among these any more: the best one is shown.");
    const now = performance.now();
    const waiting = answer.doing === "following" && answer.candidates.length > MANY && now < this.cardsWait;
    if (!waiting) this.cardsWait = now + CONTROLS_WAIT;
    this.draw(waiting);
    const best = this.showing.answer?.candidates[0];
    const near =
      best && (best.ability || isExact(best))
        ? `exactly through the ${this.noun}s`
        : `rms ${figure(best?.rms ?? 0, 3)}${errorUnit(this.task)}`;
    const head = best ? `Best: ${near}, ${inWords(best)}. ` : "";
    // How the search went stands behind the chip that says how sure it is.
    const [short, ...rest] = answer.said.split("\n");
    const isSaid = answer.sure !== undefined;
    this.sure.show(answer.sure ?? null, isSaid ? [short, ...rest].join("\n") : "");
    more.kit?.answered(answer);
    if (answer.doing === "done") this.keep();
    this.desk.changed(answer.doing === "done");
    this.build.later();
    const status = head + (isSaid ? short : answer.said);
    this.voice.answered(answer, status);
    this.said.tell(status, answer.doing === "searching" ? answer.progress : undefined);
  }

  private draw(waiting = false) {
    byId("nothing").hidden = this.scene.draw(waiting) > 0;
    byId("compare").hidden = this.showing.pinned.length === 0;
    const { answer } = this.showing;
    const chosen = this.scene.chosen();
    // What is asked now is not what a pinned one jams for; one in the hand is changed by the hand.
    const isFound = chosen?.task === this.task && !this.byHand.shown && answer?.doing === "done";
    const instead =
      tasks.nearestInstead(this.task, answer) ?? (isFound ? tasks.unjammed(this.task, chosen.shown) : null);
    this.helps.show(answer?.relaxations ?? [], this.task.unit, instead);
    byId<HTMLButtonElement>("linkage-file").disabled = !chosen;
  }

  private choose(index: number) {
    if (this.byHand.shown) {
      this.store.note();
      this.byHand.take(null);
    }
    this.showing.choose(index, this.task);
    this.keep();
    this.draw();
    this.desk.chose();
    this.build.later();
  }

  /** Keeps a linkage to compare others with. */
  private keepShown(one: { shown: Shown; task: Task }) {
    if (!this.showing.pin(one)) return this.desk.say(`${MOST_PINNED} are pinned already: unpin one of them first.`);
    this.keep();
    this.draw();
    this.desk.say(
      `Pinned ${this.showing.pinned.length} is its card, the last one; its curve on the board has that card's colour.`,
    );
  }

  /** Pins a candidate to compare others with it; lets one go that is pinned. */
  private pin(index: number) {
    const one = this.showing.all(this.task)[index];
    const pin = index < this.showing.candidates().length ? this.showing.pinOf(one) : one;
    if (!pin) {
      this.guide.done("pin");
      return this.keepShown(one);
    }
    this.showing.unpin(pin);
    this.keep();
    this.draw();
  }

  /** Remembers what the hand changes, once it rests. */
  private keepLater() {
    clearTimeout(this.looking);
    if (this.exchange.isBegun) this.looking = setTimeout(() => this.keep(), VIEW_RESTS);
  }

  private keep() {
    const { task, begunWith, hints } = this;
    const { pinned, answer } = this.showing;
    remember({
      task,
      pinned,
      begunWith,
      hints,
      view: this.board.looking,
      isWalker: this.board.isWalker,
      build: this.build.sizes,
      // What is found for another task is nothing for this one.
      ...(answer?.version === this.store.version
        ? { answer, chosen: this.showing.chosenPlace(), byHand: this.byHand.shown }
        : {}),
    });
  }

  private say(text: string) {
    this.said.say(text);
  }

  /** Brings the controls to what the task says. */
  private fill() {
    const { task } = this;
    more.kit?.fill(task);
    input("closed").checked = task.closed;
    for (const unit of document.querySelectorAll(".unit")) unit.textContent = task.unit ?? "";
    fillRequirements(task);
    this.kept.show(task);
    this.table.show(task);
    const text = this.coordinates;
    if (document.activeElement !== text && [this.written, ""].includes(text.value)) {
      const { body } = task;
      const lines = task.points.map((p, i) => [...p, ...(body ? [body.angle_deg[i]] : [])].join(body ? "," : ", "));
      text.value = [...(body ? ["x,y,angle_deg"] : []), ...lines].join("\n");
      this.written = text.value;
    }
    byId("point-count").textContent = String(task.points.length);
    byId("point-word").textContent = task.points.length === 1 ? this.noun : `${this.noun}s`;
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
      lengths: this.lengths,
    };
  }

  private back(way: "undo" | "redo") {
    const then = this.store.back(way);
    if (then) this.restore(then);
  }

  private restore(then: State) {
    if (then.photo) this.underlay.place(then.photo);
    this.board.look(then.view);
    this.walk(then.isWalker);
    this.makeLengths(then.lengths);
    this.put(then.task, {});
    if (["draw", "poses", "body"].includes(this.board.tool)) this.use(this.idle);
    const { answer, chosen } = then;
    if (answer && answer.candidates.length > 0) this.showing.restore(answer, this.store.version, chosen);
    this.holdAgain(then.byHand);
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
