// The quality of a linkage in words: how near its curve comes, how well it transmits, how large it is.

import { figure } from "../../src/report/html/player/svg.mjs";
import { labelOf, unitAfter } from "./labels";
import { type Box, type Linkage, type Point, pivotsOf, type Shown } from "./messages";

/** How good a figure is; a sign goes with each, for those who see no colour. */
export type Grade = "good" | "fair" | "poor";
export const SIGNS: Record<Grade, string> = { good: "●", fair: "◐", poor: "○" };

export interface Graded {
  grade: Grade;
  text: string;
}

/** Parts of the path's size up to which the rms error is very close, close, and fair. */
const VERY_CLOSE = 0.003;
const CLOSE = 0.01;
const FAIR = 0.03;

/** How near the curve comes to a path of a size. */
export function nearnessInWords({ rms, max }: Pick<Shown, "rms" | "max">, size: number): Graded {
  const part = rms / size;
  const percent = (value: number) => `${figure(Math.max(100 * value, 1e-4), 2)} %`;
  if (part <= VERY_CLOSE) return { grade: "good", text: `very close: ${percent(part)} of the path` };
  if (part <= CLOSE) return { grade: "good", text: `close: ${percent(part)} of the path` };
  if (part <= FAIR) return { grade: "fair", text: `near: ${percent(part)} of the path` };
  return { grade: "poor", text: `rough: misses by ${percent(max / size)} of the path` };
}

/** Worst transmission angles in degrees from which a linkage transmits well, fairly, and poorly. */
const [WELL, FAIRLY, POORLY] = [40, 25, 10];

/** Whether a linkage hardly moves on somewhere: graded as it is written, 9.96 is 10. */
export const jams = (shown: Pick<Shown, "transmission_deg">) => Number(shown.transmission_deg.toPrecision(2)) < POORLY;

export function transmissionInWords(deg: number): Graded {
  const angle = `transmission ${deg < 0.05 ? 0 : figure(deg, 2)}°`;
  // Graded as it is written: 39.9 is 40.
  deg = Number(deg.toPrecision(2));
  if (deg >= WELL) return { grade: "good", text: `${angle} (good)` };
  if (deg >= FAIRLY) return { grade: "fair", text: `${angle} (fair)` };
  if (deg >= POORLY) return { grade: "poor", text: `${angle} (poor)` };
  return { grade: "poor", text: `${angle} (it jams)` };
}

/** The largest distance between two joints of one body of a six-bar or an eight-bar: each has its joints along and across
 * its line, the ground its pivots. */
function longestOfChain({ chain }: Linkage): number {
  const { pivots, crank, dyad, point } = chain as NonNullable<Linkage["chain"]>;
  const bodies = { ground: Object.values(pivots) as Point[] } as Record<string, Point[]>;
  const line = (from: string, to: string, length: number) => {
    bodies[`${from},${to}`] = [
      [0, 0],
      [length, 0],
    ];
  };
  line(crank.pivot, crank.joint, crank.length);
  for (const { joint, from, lengths } of dyad) from.forEach((end, i) => void line(end, joint, lengths[i]));
  for (const { on, at } of point ?? []) bodies[on.join()].push(at as Point);
  const within = (all: Point[]) => all.flatMap(([x, y]) => all.map(([u, v]) => Math.hypot(u - x, v - y)));
  return Math.max(...Object.values(bodies).flatMap(within));
}

/** The largest distance between two joints of one body: of ground, a, b, c, d and e, or of those that a linkage with a
 * slider has. */
export function longestOf(linkage: Linkage): number {
  if (linkage.chain) return longestOfChain(linkage);
  const { a, b, c, d, e, coupler_x: x, coupler_y: y, kind } = linkage;
  const [[ax, ay], [bx, by] = [ax, ay]] = pivotsOf(linkage);
  const beside = Math.hypot(x ?? 0, y ?? 0);
  const beyond = kind === "slider-crank" ? Math.hypot((x ?? 0) - (b ?? 0), y ?? 0) : 0;
  return Math.max(Math.hypot(bx - ax, by - ay), ...[a, b, c, d, e].map((one) => Math.abs(one ?? 0)), beside, beyond);
}

/** The longest link as a multiple of the path. */
export function sizeInWords(linkage: Linkage, size: number, extent?: number): string {
  const times = (length: number) => Number((length / size).toPrecision(2));
  const whole = extent === undefined ? "" : `, whole ${times(extent)}\u00a0×`;
  return `longest link ${times(longestOf(linkage))} × the path${whole}`;
}

/** The part of the path's size from which on a curve is said to leave the path. */
const STRAYS = 0.15;
/** Of so many positions of the curve one is looked at. */
const EVERY = 8;

/** Says that the curve of a linkage leaves a closed path on its way, where it does: between the points nothing is asked. */
export function strayInWords(moving: { curve: (Point | null)[] }, points: Point[], size: number): Graded[] {
  const along = points.map((p, i): [Point, Point] => [p, points[(i + 1) % points.length]]);
  const far = ([x, y]: Point) =>
    Math.min(
      ...along.map(([p, q]) => {
        const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
        const part = Math.min(Math.max(((x - p[0]) * dx + (y - p[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
        return Math.hypot(x - p[0] - part * dx, y - p[1] - part * dy);
      }),
    );
  const looked = moving.curve.filter((p, i): p is Point => p !== null && i % EVERY === 0);
  const most = Math.max(0, ...looked.map(far));
  if (most <= STRAYS * size) return [];
  return [{ grade: "poor", text: `its curve leaves the path by ${Math.round((100 * most) / size)} %` }];
}

/** How a machine walks on two legs half a turn apart, of the curve of a foot over a turn: the lower foot carries, and the
 * hips are as high above it as the leg makes them. Empty where the crank does not turn on and on. */
export function gaitInWords(curve: (Point | null)[], unit?: string): string {
  // The last place is the first.
  const feet = curve.slice(1);
  const n = feet.length;
  const [ground, lifts] = [[] as number[], [] as number[]];
  let step = 0;
  for (let i = 0; i < n; i += 1) {
    const [foot, other, next] = [feet[i], feet[(i + n / 2) % n], feet[(i + 1) % n]];
    if (!foot || !other || !next) return "";
    ground.push(Math.min(foot[1], other[1]));
    lifts.push(foot[1] - other[1]);
    if (foot[1] < other[1]) step += next[0] - foot[0];
  }
  const figures = [Math.abs(step), Math.max(...lifts), Math.max(...ground) - Math.min(...ground)];
  const [long, lift, bob] = figures.map((length) => figure(length, 3) + unitAfter(unit));
  return `steps ${long}, foot lifted ${lift}, hips bob ${bob}`;
}

/** The limit on which a linkage lies, in words; empty if on none. */
export function limitedBy(
  shown: Shown,
  limits: { longest: number | null; transmission?: number; ratio?: number; pivots?: Box },
): string {
  const said: string[] = [];
  const near = (value: number, limit: number) => Math.abs(value - limit) <= 2e-3 * limit;
  if (limits.longest !== null && near(longestOf(shown.linkage), limits.longest)) said.push("longest_max");
  if (limits.transmission && near(shown.transmission_deg, limits.transmission)) said.push("transmission_deg_min");
  if (limits.ratio && near(shown.link_ratio, limits.ratio)) said.push("link_ratio_max");
  const { pivots } = limits;
  if (pivots) {
    const slack = 1e-3 * Math.hypot(pivots[2] - pivots[0], pivots[3] - pivots[1]);
    const isAtRim = ([x, y]: Point) =>
      [x - pivots[0], y - pivots[1], pivots[2] - x, pivots[3] - y].some((d) => d < slack);
    if (pivotsOf(shown.linkage).some(isAtRim)) said.push("pivots_in");
  }
  return said.length > 0 ? `limited by: ${said.map(labelOf).join(", ")}` : "";
}

/** The marks of candidates in a list, the closest first: the first, the smallest and the one that transmits best. */
export function marks(all: { shown: Shown; extent: number }[]): string[][] {
  const words: string[][] = all.map(() => []);
  const able = all.map((one, i) => ({ ...one, i })).filter(({ shown }) => shown.accepted);
  if (able.length < 2) return words;
  words[able[0].i].push("closest");
  const best = (key: (one: (typeof able)[0]) => number) =>
    able.reduce((least, one) => (key(one) < key(least) * (1 - 1e-9) ? one : least));
  words[best(({ extent }) => extent).i].push("smallest");
  // The best of bad ones is no good one.
  const transmits = best(({ shown }) => 180 - shown.transmission_deg);
  if (transmits.shown.transmission_deg >= FAIRLY) words[transmits.i].push("best transmission");
  return words;
}
