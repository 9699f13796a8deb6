// What the studio and the page say to each other: see /schemas.json.

export type Point = [number, number];

export interface Ask {
  version: number;
  name: string;
  unit?: string;
  points: Point[];
  closed: boolean;
  tolerance?: number;
  types: string[];
  transmission_deg_min?: number;
  link_ratio_max?: number;
  pivots_in?: [number, number, number, number];
  seed: number;
  moving?: boolean;
  fresh?: boolean;
}

/** What of an Ask is the user's: the rest is the connection's. */
export type Task = Omit<Ask, "version" | "moving" | "fresh">;

export interface Shown {
  rank: number;
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
}

export interface Answer {
  version: number;
  doing: "following" | "searching" | "done" | "refused";
  said: string;
  progress?: number;
  candidates: Shown[];
}
