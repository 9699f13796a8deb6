// The task that stands, its versions, and the steps back and forth. Nothing here knows the page.

import { Steps } from "./memory";
import type { Linkage, Task } from "./messages";
import { isSameButForName, withoutStale } from "./task";

/** How an edit is meant. */
export interface How {
  /** The hand still moves. */
  moving?: boolean;
  /** Another target begins. */
  fresh?: boolean;
  /** The linkage from which the search goes on. */
  from?: Linkage;
}

/** What an edit has done. */
export interface Edit {
  /** It has changed the name alone: nothing is searched anew. */
  isName: boolean;
  /** What was known of the best answer belongs to another problem now. */
  isStale: boolean;
  /** Another target begins, or there are too few points for one. */
  isFresh: boolean;
}

/** So many points are a path, and so many poses a motion. */
const [LEAST_POINTS, LEAST_POSES] = [3, 2];

export class Store<State> {
  /** The number of the latest edit. */
  version = 0;
  /** The edit that began this target: what is answered to earlier ones belongs to another. */
  since = 0;
  private steps = new Steps<State>();

  /** `now` gives what a step back brings back; `noted` is told of every change of the steps. */
  constructor(
    public task: Task,
    private now: () => State,
    private noted: (steps: { canUndo: boolean; canRedo: boolean }) => void,
  ) {
    noted(this.steps);
  }

  /** Whether there are too few points to be searched. */
  get isShort(): boolean {
    const { points, body, function: pairs } = this.task;
    return points.length < (body || pairs ? LEAST_POSES : LEAST_POINTS);
  }

  /** Takes an edited task in place of the one that stands. */
  take(edited: Task, how: How): Edit {
    const before = this.task;
    if (edited.name !== before.name && !how.fresh && isSameButForName(edited, before)) {
      this.task = edited;
      return { isName: true, isStale: false, isFresh: false };
    }
    this.task = withoutStale(before, edited);
    this.version += 1;
    const isFresh = how.fresh === true || this.isShort;
    if (isFresh) this.since = this.version;
    return { isName: false, isStale: edited.expect !== undefined && this.task.expect === undefined, isFresh };
  }

  /** Notes what stands before a change, so that it can be undone. */
  note() {
    this.steps.note(this.now());
    this.noted(this.steps);
  }

  /** What stood before the latest change, which is given up. */
  giveUp(): State | null {
    return this.told(this.steps.giveUp());
  }

  /** What a step back or forth brings back; null: there is none. */
  back(way: "undo" | "redo"): State | null {
    return this.told(this.steps[way](this.now()));
  }

  private told(then: State | null): State | null {
    this.noted(this.steps);
    return then;
  }
}
