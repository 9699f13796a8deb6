// Examples to begin with: each shows one thing that can be asked.

import type { Point, Task } from "./messages";

/** A step of a walking leg, flat below and lifted on the way back. */
const WALKING: Task = {
  name: "walking-step",
  unit: "mm",
  points: [
    [-40, 0],
    [-30, -1],
    [-20, -1.5],
    [-10, -1.8],
    [0, -2],
    [10, -1.8],
    [20, -1.5],
    [30, -1],
    [40, 0],
    [44, 5],
    [42, 11],
    [34, 17],
    [22, 22],
    [8, 25],
    [-8, 25],
    [-22, 22],
    [-34, 17],
    [-42, 11],
    [-44, 5],
  ],
  closed: true,
  types: ["crank-rocker", "double-crank"],
  transmission_deg_min: 30,
  seed: 1,
};

const along = (n: number, at: (part: number) => Point): Point[] => Array.from({ length: n }, (_, i) => at(i / (n - 1)));

/** A straight stroke, passed while the crank turns by even steps, within tolerances that are tight in the middle. */
const STRAIGHT: Task = {
  name: "straight-stroke",
  unit: "mm",
  points: along(9, (part) => [Number((80 * part - 40).toFixed(3)), 0]),
  closed: false,
  types: [],
  timing: { crank_deg: along(9, (part) => [180 * part, 0]).map((p) => p[0]), offset: "free" },
  tolerances: [2, 1, 0.6, 0.4, 0.4, 0.4, 0.6, 1, 2],
  transmission_deg_min: 25,
  seed: 1,
};

/** Nine points of a drawn loop: every linkage through them. */
const NINE: Task = {
  name: "nine-points",
  unit: "mm",
  points: [
    [0, 0],
    [11, -6],
    [24, -8],
    [37, -4],
    [45, 6],
    [42, 19],
    [30, 27],
    [14, 25],
    [3, 14],
  ],
  closed: true,
  types: [],
  method: "continuation",
  seed: 1,
};

/** A stroke whose pivots must stand in a small box below. */
const BOXED: Task = {
  name: "pivots-below",
  unit: "mm",
  points: along(12, (part) => [
    Number((60 * part - 30).toFixed(3)),
    Number((30 + 8 * Math.sin(Math.PI * part)).toFixed(3)),
  ]),
  closed: false,
  types: [],
  pivots_in: [-40, -40, 40, 0],
  tolerance: 0.5,
  seed: 1,
};

export const EXAMPLES: [string, Task][] = [
  ["Walking step", WALKING],
  ["Straight stroke, timed", STRAIGHT],
  ["Nine points, all linkages", NINE],
  ["Pivots in a box", BOXED],
];
