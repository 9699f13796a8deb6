// What motions, functions, sliders, details and building add to the page: a second script, loaded when it is first needed.
// Both scripts have their own copies of what holds nothing; what holds something is handed over here.

import type { AnglesPlayer } from "./angles";
import type { Board } from "./board";
import type { BuildPanel } from "./build";
import type { Example } from "./examples";
import type { Answer, LinkageKind, Point, Task } from "./messages";
import type { Grip } from "./pointers";
import type { How } from "./store";
import type { Hand, Tool } from "./surface";

/** What the second script needs of the page. */
export interface Page {
  board: Board;
  hand: Hand;
  task(): Task;
  /** Another task that can be undone. */
  replace(task: Task, how?: How): void;
  /** Another task without a step to go back. */
  put(task: Task, how: How): void;
  use(tool: Tool): void;
  say(text: string): void;
  /** Says something that the next answer does not replace. */
  tell(text: string): void;
  /** Asks for the map of the pins, or no longer. */
  map(on: boolean): void;
}

/** What the second script gives. */
export interface Kit {
  join(page: Page): void;
  /** The panel that builds, and the player of the details. */
  panel: typeof BuildPanel;
  player: typeof AnglesPlayer;
  /** Begins a motion, unless one stands. */
  motion(): void;
  /** The board has been drawn anew, and the linkage stands at a part of its motion. */
  drawn(): void;
  posed(part: number): void;
  /** What a pointer that goes down on the board holds; undefined: what it holds without this script. */
  take(event: PointerEvent): Grip | null | undefined;
  /** Whether a key on the board was meant for it. */
  press(event: KeyboardEvent): boolean;
  /** Brings its controls to what the task says. */
  fill(task: Task): void;
  answered(answer: Answer): void;
  /** Asks for other kinds of linkages. */
  ofKinds(kinds: LinkageKind[]): void;
  /** The task with the outline of its body. */
  outlined(task: Task, outline: Point[]): Task;
  example(name: string): Example;
}

/** The second script once it is there, and whether the map of the pins is asked for. */
export const more: { kit: Kit | null; map: boolean } = { kit: null, map: false };

const AT = "/more.js";
let loading: Promise<Kit> | undefined;

/** The second script; `join` hands it the page once. */
export function kitFor(page: () => Page): Promise<Kit> {
  loading ??= import(AT).then(() => {
    const { kit } = globalThis as unknown as { kit: Kit };
    kit.join(page());
    more.kit = kit;
    return kit;
  });
  return loading;
}
