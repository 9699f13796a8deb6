// What is remembered: steps to go back, and everything over a reload.

import type { Answer, Shown, Solution, Task } from "./messages";
import type { View } from "./view";

const KEY = "linkwright-studio";
const STEPS = 200;

export interface Remembered {
  task: Task;
  pinned: Solution[];
  begunWith: string;
  hints: boolean;
  view?: View;
  isWalker?: boolean;
  /** What was found for the task, and which of it is chosen. */
  answer?: Answer;
  chosen?: Place;
  /** The linkage in the hand. */
  byHand?: Shown | null;
  /** What stands in the fields of the Build tab. */
  build?: Record<string, string>;
}

/** Which linkage is chosen, by its place; null: none but the best. */
export type Place = { pin: number } | { candidate: number } | null;

/** What this tab has kept under a name; of a new tab what the latest has. */
export function kept<What>(key: string): What | null {
  try {
    return JSON.parse(sessionStorage.getItem(key) ?? localStorage.getItem(key) ?? "null") as What | null;
  } catch {
    return null;
  }
}

/** Keeps something for this tab, and for the next new one. */
export function keep(key: string, what: unknown) {
  const text = JSON.stringify(what);
  for (const store of [() => sessionStorage, () => localStorage]) {
    try {
      store().setItem(key, text);
    } catch {
      // A browser that keeps nothing, or not so much: the page works until it is closed.
    }
  }
}

export function remembered(): Remembered | null {
  const what = kept<Remembered>(KEY);
  if (!what || !Array.isArray(what.task?.points) || !Array.isArray(what.pinned)) return null;
  const view = [what.view?.x, what.view?.y, what.view?.scale].every(Number.isFinite) ? what.view : undefined;
  const pinned = what.pinned.filter((one) => one?.shown?.linkage && Array.isArray(one.task?.points));
  // The numbers of linkages are those of a connection that is no more.
  const candidates = what.answer?.candidates?.map(({ number: _, ...shown }) => shown) ?? [];
  const answer = what.answer && candidates.every((one) => one.linkage) ? { ...what.answer, candidates } : undefined;
  const byHand = what.byHand?.linkage ? what.byHand : null;
  return { ...what, view, pinned, answer, byHand };
}

export const remember = (what: Remembered) => keep(KEY, what);

/** The steps back and forth between states. */
export class Steps<State> {
  private back: string[] = [];
  private forth: string[] = [];

  /** Notes the state as it was before a change. */
  note(before: State) {
    const text = JSON.stringify(before);
    if (this.back[this.back.length - 1] === text) return;
    this.back.push(text);
    if (this.back.length > STEPS) this.back.shift();
    this.forth = [];
  }

  /** The state before the latest change, which is given up and not to be redone. */
  giveUp(): State | null {
    const text = this.back.pop();
    return text === undefined ? null : (JSON.parse(text) as State);
  }

  undo(now: State): State | null {
    return this.step(this.back, this.forth, now);
  }

  redo(now: State): State | null {
    return this.step(this.forth, this.back, now);
  }

  get canUndo() {
    return this.back.length > 0;
  }

  get canRedo() {
    return this.forth.length > 0;
  }

  private step(from: string[], to: string[], now: State): State | null {
    const text = from.pop();
    if (text === undefined) return null;
    to.push(JSON.stringify(now));
    return JSON.parse(text) as State;
  }
}
