// Examples to begin with: each shows one thing that can be asked.

import type { Point, Task } from "./messages";

/** An example: what the gallery calls it, the problem, and whether it is shown as a walking machine. */
export interface Example {
  name: string;
  task: Task;
  isWalker?: boolean;
}

/** Examples that come with the second script: motions, functions, and a shape that no four-bar draws. */
export const MORE = [
  "Hood hinge",
  "Sofa bed",
  "Drop leaf",
  "Bulldozer",
  "Excavator",
  "Logarithm",
  "Dial by pairs",
  "Letter A",
];

/** The step of a foot, flat on the ground and lifted on the way back, under hips that stand above it. */
const WALKING: Task = {
  name: "walking-leg",
  unit: "mm",
  points: [
    [-35, 0],
    [-26.25, 0],
    [-17.5, 0],
    [-8.75, 0],
    [0, 0],
    [8.75, 0],
    [17.5, 0],
    [26.25, 0],
    [35, 0],
    [37.6, 4.8],
    [33, 7.9],
    [25.7, 10.3],
    [16.3, 12],
    [5.6, 12.9],
    [-5.6, 12.9],
    [-16.3, 12],
    [-25.7, 10.3],
    [-33, 7.9],
    [-37.6, 4.8],
  ],
  weights: [4, 4, 4, 4, 4, 4, 4, 4, 4, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1],
  closed: true,
  types: ["crank-rocker", "double-crank"],
  transmission_deg_min: 30,
  pivots_in: [-80, 60, 80, 180],
  seed: 1,
};

const along = (n: number, at: (part: number) => Point): Point[] => Array.from({ length: n }, (_, i) => at(i / (n - 1)));

/** A straight stroke of a motor, passed while the crank turns by even steps, within tolerances that are tight in the
 * middle. */
const STRAIGHT: Task = {
  name: "straight-stroke",
  unit: "mm",
  points: along(9, (part) => [Number((80 * part - 40).toFixed(3)), 0]),
  closed: false,
  types: ["crank-rocker", "double-crank"],
  timing: { crank_deg: along(9, (part) => [180 * part, 0]).map((p) => p[0]), offset: "free" },
  tolerances: [2, 1, 0.6, 0.4, 0.4, 0.4, 0.6, 1, 2],
  transmission_deg_min: 30,
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

/** So many points evenly around a closed curve, of its parts 0 to 1. */
const around = (n: number, at: (angle: number) => Point): Point[] =>
  Array.from({ length: n }, (_, i) => {
    const [x, y] = at((2 * Math.PI * i) / n);
    return [Number(x.toFixed(2)), Number(y.toFixed(2))];
  });

/** A curve as it would be drawn: closed, with a motor that turns. */
const drawn = (name: string, points: Point[], transmission_deg_min?: number): Task => ({
  name,
  unit: "mm",
  points,
  closed: true,
  types: ["crank-rocker", "double-crank"],
  transmission_deg_min,
  seed: 1,
});

const EGG = drawn(
  "egg",
  around(40, (t) => [48 * Math.cos(t) + 6 * Math.cos(2 * t), 32 * Math.sin(t)]),
  35,
);

const EIGHT = drawn(
  "figure-eight",
  around(48, (t) => [42 * Math.sin(t), 12 * Math.sin(2 * t) + 3 * Math.cos(t)]),
  25,
);

/** A drop with its point at the right. */
const DROP = drawn(
  "drop",
  around(48, (t) => [42 * Math.cos(t), 34 * Math.sin(t) * Math.sin(t / 2) ** 1.5]),
  30,
);

export const EXAMPLES: Example[] = [
  { name: "Walking leg", task: WALKING, isWalker: true },
  { name: "Straight stroke, timed", task: STRAIGHT },
  { name: "Egg", task: EGG },
  { name: "Figure eight", task: EIGHT },
  { name: "Drop", task: DROP },
  { name: "Nine points, all linkages", task: NINE },
  { name: "Pivots in a box", task: BOXED },
];
