// What is remembered: steps to go back, and everything over a reload.

import type { Shown, Task } from "./messages";

const KEY = "linkwright-studio";
const STEPS = 200;

export interface Remembered {
  task: Task;
  pinned: Shown[];
  begunWith: string;
  hints: boolean;
}

export function remembered(): Remembered | null {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? "null") as Remembered | null;
    return kept && Array.isArray(kept.task?.points) && Array.isArray(kept.pinned) ? kept : null;
  } catch {
    return null;
  }
}

export function remember(what: Remembered) {
  try {
    localStorage.setItem(KEY, JSON.stringify(what));
  } catch {
    // A browser that keeps nothing: the page works until it is closed.
  }
}

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
