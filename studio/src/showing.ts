// What is shown of all that was found: the candidates of the latest answer, what is pinned, and which one of them the
// board shows.

import { type Choice, followed, isSame, isTheSame, placeOf } from "./choice";
import type { Place } from "./memory";
import type { Answer, Shown, Solution, Task } from "./messages";
import type { Nine } from "./nine";
import { isSamePath, shownTimes, withLengthsTimes } from "./task";

export const MOST_PINNED = 3;
/** An answer that is less than so much better than the one that was brought back does not replace it. */
const BETTER = 0.999;
/** A linkage that is offered in place of the one that is held comes nearer by so much. */
const WORTH_OFFERING = 0.98;

export class Showing {
  answer: Answer | null = null;
  choice: Choice = null;
  pinned: Solution[] = [];
  /** The version whose first linkage is the user's own, fitted again; and the number of that linkage. */
  private ownOf: number | null = null;
  own: number | null = null;
  /** The linkage that stays on the board while the hand moves, whatever is found meanwhile. */
  private held: Shown | null = null;
  /** The version that a step back or forth brought, with the answer that stood there. */
  private restored: { version: number; answer: Answer } | null = null;

  constructor(private nine: Nine) {}

  /** The first linkage that is answered to a version is the user's own: it is shown. */
  expectOwn(version: number) {
    this.ownOf = version;
  }

  /** Forgets what was found, for another target. */
  clear() {
    this.choice = null;
    this.own = null;
    this.held = null;
    this.answer = null;
    this.nine.hear(null);
  }

  /** Takes an answer; says whether the chosen linkage is gone. */
  hear(answer: Answer, version: number): { chosenIsGone: boolean } {
    this.answer = this.asRestored(answer, version);
    this.nine.hear(answer);
    const all = this.candidates();
    if (this.ownOf === version && answer.version === version && all[0]) {
      this.own = all[0].number ?? null;
      this.choice = { candidate: all[0] };
      this.ownOf = null;
    }
    const choice = followed(this.choice, all);
    const chosenIsGone = this.choice !== null && choice === null && all.length > 0;
    this.choice = choice;
    const held = this.held && followed({ candidate: this.held }, all);
    this.held = held && "candidate" in held ? held.candidate : null;
    return { chosenIsGone };
  }

  /** Others of the candidates are to be shown. */
  filtered() {
    this.choice = followed(this.choice, this.candidates());
  }

  /** Brings back what a step back or forth found. */
  restore(answer: Answer, version: number, chosen: Place) {
    this.answer = answer;
    this.held = null;
    this.restored = { version, answer };
    this.nine.hear(answer);
    const candidate = chosen && "candidate" in chosen ? answer.candidates[chosen.candidate] : undefined;
    const pin = chosen && "pin" in chosen ? this.pinned[chosen.pin] : undefined;
    this.choice = candidate ? { candidate } : pin ? { pin } : null;
  }

  /** An answer with the linkages that a step back has brought back, unless it has better ones. */
  private asRestored(answer: Answer, version: number): Answer {
    const before = this.restored;
    if (!before || before.version !== version) return answer;
    const [was, is] = [before.answer.candidates[0], answer.candidates[0]];
    if (answer.doing === "done" && (!was || (is && is.rms < BETTER * was.rms))) {
      this.restored = null;
      return answer;
    }
    return { ...answer, candidates: before.answer.candidates };
  }

  /** The candidates that are shown: of many through nine points those that were chosen. */
  candidates(): Shown[] {
    return this.nine.filtered(this.answer?.candidates ?? []);
  }

  /** Candidates for what stands, then what is pinned, each with its own task. */
  all(task: Task): Solution[] {
    return [...this.candidates().map((shown) => ({ shown, task })), ...this.pinned];
  }

  /** The place of the linkage on the board in that list; -1: there is none. */
  place(): number {
    const candidates = this.candidates();
    return placeOf(this.choice ?? (this.held && { candidate: this.held }), candidates, this.pinned);
  }

  chosen(task: Task): Solution | null {
    return this.all(task)[this.place()] ?? null;
  }

  /** Holds on to what the board shows while the hand moves; gives the number under which the studio knows it. */
  hold(): number | undefined {
    const shown = this.candidates()[this.place()];
    this.held = shown ?? null;
    return shown?.number;
  }

  /** The hand has let go: the best one is shown, unless one was chosen. */
  letGo() {
    this.held = null;
  }

  /** Shows the best one from now on. */
  takeBest() {
    this.choice = null;
    this.held = this.held && (this.candidates()[0] ?? null);
  }

  /** How much nearer another linkage comes than the one that is held, in parts; null: none does. */
  offer(): number | null {
    const [best, shown] = [this.candidates()[0], this.candidates()[this.place()]];
    if (!this.held || !best || !shown || best === shown || isSame(best, shown)) return null;
    const worth = (best.accepted || !shown.accepted) && best.rms < WORTH_OFFERING * shown.rms;
    return worth ? 1 - best.rms / shown.rms : null;
  }

  /** Which one is chosen, by its place among those that are remembered. */
  chosenPlace(): Place {
    const { choice } = this;
    if (!choice) return null;
    if ("pin" in choice) return { pin: this.pinned.indexOf(choice.pin) };
    return { candidate: (this.answer?.candidates ?? []).indexOf(choice.candidate) };
  }

  choose(index: number, task: Task) {
    const one = this.all(task)[index];
    this.choice = index < this.candidates().length ? { candidate: one.shown } : { pin: one };
  }

  /** Keeps a linkage to compare others with, in a colour that no other has; false: there are enough. */
  pin(one: Solution): boolean {
    if (this.pinned.length >= MOST_PINNED) return false;
    const colours = Array.from({ length: MOST_PINNED }, (_, i) => i);
    const colour = colours.find((i) => !this.pinned.some((pin) => pin.colour === i)) ?? 0;
    this.pinned = [...this.pinned, { ...one, colour }];
    return true;
  }

  /** The pin of a linkage, if it has one. */
  pinOf({ shown }: Solution): Solution | undefined {
    return this.pinned.find((pin) => isTheSame(pin.shown, shown));
  }

  /** What is pinned for a path becomes so many times as large as the path does. */
  pinsTimes(path: Task, by: number) {
    for (const pin of this.pinned.filter(({ task }) => isSamePath(task, path)))
      Object.assign(pin, { shown: shownTimes(pin.shown, by), task: withLengthsTimes(pin.task, by) });
  }

  unpin(one: Solution) {
    this.pinned = this.pinned.filter((pin) => pin !== one);
    if (this.choice && "pin" in this.choice && this.choice.pin === one) this.choice = null;
  }
}
