// What the studio and the page say to each other: the types of wire.ts, which are made from the studio's descriptions.

import type {
  Answer,
  Ask as AnyAsk,
  Counted,
  Kind,
  LinkageKind,
  Reading,
  Relaxation,
  Shown,
  TypedValue,
  Unit,
} from "./wire";

export type { Answer, AnyAsk, Counted, Kind, LinkageKind, Reading, Relaxation, Shown, Unit };
export type Value = TypedValue;

export type Point = [number, number];

/** A linkage of any kind, as in records: four-bars have no `kind`. */
export type Linkage = Shown["linkage"];

/** A four-bar by its joints and lengths. */
export interface FourBar {
  A: Point;
  B: Point;
  a: number;
  b: number;
  c: number;
  d: number;
  e: number;
  t1: number;
  t2: number;
}

/** The same linkage as a four-bar; null of another kind. */
export const fourBarOf = (linkage: Linkage) => (linkage.kind ? null : (linkage as FourBar));

/** The fixed pivots of a linkage, A first: a slider-crank has one, a six-bar two or three. */
export const pivotsOf = ({ A, B, chain }: Linkage): Point[] =>
  chain ? (Object.values(chain.pivots) as Point[]) : ([A, B].filter((pivot) => pivot) as Point[]);

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
