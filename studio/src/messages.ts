// What the studio and the page say to each other: see /schemas.json.

export type Point = [number, number];

/** xmin, ymin, xmax, ymax. */
export type Box = [number, number, number, number];

export interface Ask {
  version: number;
  name: string;
  unit?: string;
  source?: string;
  points: Point[];
  closed: boolean;
  tolerance?: number;
  tolerances?: number[];
  weights?: number[];
  timing?: { crank_deg: number[]; offset: "free" | "fixed" | "ground" };
  raw?: { points: Point[]; smooth?: number; samples?: number };
  types: string[];
  transmission_deg_min?: number;
  link_ratio_max?: number;
  transmission_over?: "cycle" | "used";
  pivots_in?: Box;
  footprint_in?: Box;
  order?: "required" | "any";
  direction?: "any" | "ccw" | "cw";
  circuit?: "one" | "any";
  branch?: "one" | "any";
  closing?: "one-way" | "any";
  method?: string;
  objective?: "sum-of-squares" | "max-deviation";
  /** Other keys of the problem file, as they are typed there. */
  kept?: Record<string, string>;
  /** What is known of the problem's answer: the studio reads it where the problem is still the one it is known of. */
  expect?: { of: string; answer: { best_known_sum_sq?: number; published?: unknown[]; exact?: unknown } };
  seed: number;
  moving?: boolean;
  held?: number;
  fresh?: boolean;
}

/** What of an Ask is the user's: the rest is the connection's. */
export type Task = Omit<Ask, "version" | "moving" | "held" | "fresh">;

export interface Shown {
  rank: number;
  number?: number;
  linkage: { A: Point; B: Point; a: number; b: number; c: number; d: number; e: number; t1: number; t2: number };
  drive: { kind: "turn" | "rock" | "through" | "none"; middle_deg: number; half_width_deg: number; t1: number };
  crank_deg: number[];
  t1_at: number[];
  worst: number;
  rms: number;
  max: number;
  type: string;
  transmission_deg: number;
  link_ratio: number;
  accepted: boolean;
  unmet: string[];
  ability?: string;
  certified_within?: number;
}

/** A linkage with what was asked of it. */
export interface Solution {
  shown: Shown;
  task: Task;
  /** Of a pinned one: the number of its colour. */
  colour?: number;
}

/** The linkages through nine points, counted. */
export interface Counted {
  classes: number;
  real: number;
  one_circuit: number;
  in_order: number;
  free_of_defects: number;
  said: string[];
}

export type Value = number | number[] | number[][] | string | string[];

/** Changes of the problem after which something acceptable was found. */
export interface Relaxation {
  set: { key: string; from: Value; to: Value }[];
  rms: number;
}

/** A text that was read: see `POST /read`. */
export interface Reading {
  ask: Ask;
  whole: boolean;
  warnings: string[];
}

export interface Answer {
  version: number;
  doing: "following" | "searching" | "done" | "refused";
  said: string;
  sure?: "sure" | "fairly" | "not";
  progress?: number;
  candidates: Shown[];
  nine?: Counted;
  relaxations?: Relaxation[];
}
