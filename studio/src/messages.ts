// What the studio and the page say to each other: the types of wire.ts, which are made from the studio's descriptions.

import type { Answer, Ask as AnyAsk, Counted, Kind, Reading, Relaxation, Shown, TypedValue, Unit } from "./wire";

export type { Answer, AnyAsk, Counted, Kind, Reading, Relaxation, Shown, Unit };
export type Value = TypedValue;

export type Point = [number, number];

/** xmin, ymin, xmax, ymax. */
export type Box = [number, number, number, number];

/** An edit as the page makes it: what has a default is always said. */
export type Ask = AnyAsk & Required<Pick<AnyAsk, "version" | "name" | "closed" | "types" | "seed">>;

/** What of an Ask is the user's: the rest is the connection's. */
export type Task = Omit<Ask, "version" | "moving" | "held" | "from" | "fresh" | "map">;

/** A linkage with what was asked of it. */
export interface Solution {
  shown: Shown;
  task: Task;
  /** Of a pinned one: the number of its colour. */
  colour?: number;
}
