// Examples of motions and functions, and of shapes by six-bars.

import type { Point, Task } from "./messages";

const OWN = "drawn for the studio";

/** Poses [x, y, degrees] as a task. */
function motion(name: string, source: string, poses: [number, number, number][], more: Partial<Task> = {}): Task {
  return {
    name,
    source,
    points: poses.map(([x, y]): Point => [x, y]),
    body: { angle_deg: poses.map((pose) => pose[2]) },
    closed: false,
    types: [],
    seed: 1,
    ...more,
  };
}

/** A hood that opens, seen from its side; drawn for this page. */
const HOOD: Task = motion(
  "hood-hinge",
  OWN,
  [
    [-150, 0, 0],
    [-86, 40, -12],
    [-21, 82, -30],
    [62, 125, -53],
  ],
  {
    unit: "mm",
    pivots_in: [40, -190, 230, -70],
    transmission_deg_min: 30,
    transmission_over: "used",
  },
);
HOOD.body = {
  ...(HOOD.body as NonNullable<Task["body"]>),
  outline: [
    [
      [-330, -40],
      [-312, -6],
      [-180, 26],
      [60, 38],
      [390, 34],
      [396, 20],
      [60, 22],
      [-175, 10],
      [-298, -18],
      [-316, -44],
    ],
  ],
};

const NISHIDA = "of the Multi-Pose Interactive Linkage Design code (Nishida, Bousseau, Aliaga, Eurographics 2019)";

const SOFA = motion(
  "sofa-bed",
  `file sofa-bed_pose4 ${NISHIDA}`,
  [
    [2.6, 8.1, 0],
    [2.484379, 7.616478, 18.938157],
    [3.948416, 9.03755, 25.096754],
    [7.3, 13.7, 0],
  ],
  {
    kept: {
      "require.pivots_in": "[[1.75, 13.6875], [22.9375, 13.6875], [22.9375, 2.5625], [1.4375, 2.5]]",
      "require.pins_in": "[[-0.85, 5.5875], [20.3375, 5.5875], [20.3375, -5.5375], [-1.1625, -5.6]]",
    },
  },
);

const BLADE = motion(
  "bulldozer-blade",
  `file bulldozer_pose4 ${NISHIDA}`,
  [
    [-1.399894, 0.810538, 0],
    [-2.727258, 1.116304, -1.445469],
    [-4.813588, 6.258733, -19.128349],
    [-2.384024, 14.139744, -45.102019],
  ],
  {
    kept: {
      "require.pivots_in":
        "[[4.607, 6.917], [12.463, 6.917], [13.816, 10.613], [16.621, 10.646], [15.697, 1.273], [1.505, 0.15]]",
      "require.pins_in":
        "[[6.006894, 6.106462], [13.862894, 6.106462], [15.215894, 9.802462], [18.020894, 9.835462], [17.096894, 0.462462], [2.904894, -0.660538]]",
    },
  },
);

/** The leaf of a table, which hangs down and is lifted to the height of the top. */
const LEAF: Task = motion(
  "drop-leaf",
  OWN,
  [
    [60, -389, -90],
    [144, -282, -65],
    [179, -143, -34],
    [150, 0, 0],
  ],
  { unit: "mm", pivots_in: [-220, -190, -40, -80], transmission_deg_min: 30, transmission_over: "used" },
);
LEAF.body = {
  ...(LEAF.body as NonNullable<Task["body"]>),
  outline: [
    [
      [-140, 0],
      [160, 0],
      [160, 22],
      [-140, 22],
    ],
  ],
};

/** What those that are no motions have in common. */
const PLAIN: Pick<Task, "source" | "closed" | "types" | "transmission_deg_min" | "seed"> = {
  source: OWN,
  closed: false,
  types: [],
  transmission_deg_min: 30,
  seed: 1,
};

/** The crank turns by 60 degrees while x goes from 1 to 2, the follower by 90 as log10 x does. */
const LOGARITHM: Task = {
  name: "logarithm",
  points: Array.from({ length: 31 }, (_, k): Point => [2 * k, 90 * (Math.log10(1 + k / 30) / Math.log10(2))]),
  function: { sense: "same", of: { formula: "log10(x)", over: [1, 2] } },
  ...PLAIN,
  source: "the functions of textbooks",
};

/** A dial that turns slowly at first: pairs to begin with. */
const DIAL: Task = {
  name: "dial",
  points: [0, 1, 2, 3, 4, 5, 6].map((k): Point => [12 * k, Number((50 * (k / 6) ** 1.6).toFixed(1))]),
  function: {},
  ...PLAIN,
};

/** The bucket of an excavator: the rocker that the cylinder pushes turns by 95 degrees, the bucket by 154, fastest where it
 * curls into the ground. */
const BUCKET: Task = {
  name: "excavator-bucket",
  points: [
    [0, 0],
    [20, 36],
    [40, 70],
    [60, 102],
    [80, 132],
    [95, 154],
  ],
  function: {},
  ...PLAIN,
};

/** The letter A in one stroke, which no four-bar draws: from each corner so many points, each so far from the one before. */
const LETTER: Task = {
  name: "letter-a",
  unit: "mm",
  points: [
    [0, 0, 20, 2, 5],
    [40, 100, 20, 2, -5],
    [80, 0, 8, -2, 5],
    [64, 40, 9, -6, 0],
  ].flatMap(([x, y, n, u, v]) => Array.from({ length: n }, (_, k): Point => [x + k * u, y + k * v])),
  mechanism: ["six-bar"],
  ...PLAIN,
};

export const sights: Record<string, Task> = {
  "Hood hinge": HOOD,
  "Sofa bed": SOFA,
  "Drop leaf": LEAF,
  Bulldozer: BLADE,
  Excavator: BUCKET,
  Logarithm: LOGARITHM,
  "Dial by pairs": DIAL,
  "Letter A": LETTER,
};
