// What is asked, kept in step with itself: lists beside the points are as long as the points are many.

import { unitAfter } from "./labels";
import type { Answer, AnyAsk, Box, Linkage, Point, Shown, Task } from "./messages";
import { jams } from "./words";

/** So many points have finitely many linkages; with a body that has its angle there a pose counts twice, and one more is met. */
const EXACT_POINTS = 9;
/** A place that is given, in place of a range. */
const FIXED = /^\[[^[\],]+,[^[\],]+\]$/;
export const EXACT = "continuation";

export const isExact = (task: Task) => task.method === EXACT;
/** Whether as many points, poses and fixed pivots are asked for as have finitely many linkages of one kind. */
export function canBeExact({ points, timing, body, function: pairs, mechanism, kept }: Task): boolean {
  if (timing || pairs) return false;
  const poses = body?.angle_deg.filter((deg) => Number.isFinite(deg)).length ?? 0;
  const pivots = ["design.A", "design.B"].filter((key) => FIXED.test(kept?.[key] ?? "")).length;
  if (mechanism)
    return /^[^,]*slider-crank$/.test(mechanism.join()) && points.length === EXACT_POINTS - 1 && poses + pivots === 0;
  // With one pivot and more poses one link would have too much to meet and the other too little.
  if (pivots === 1 && poses > 3) return false;
  return points.length + poses + 2 * pivots === EXACT_POINTS + (poses > 0 ? 1 : 0);
}

/** Crank angles spread evenly over a turn, or over half a turn of an open path. */
function evenAngles(n: number, closed: boolean): number[] {
  const step = closed ? 360 / n : 180 / Math.max(n - 1, 1);
  return Array.from({ length: n }, (_, i) => Number((i * step).toFixed(3)));
}

/** Leaves out what belongs to points that are no more, and the exact mode where there are not nine. */
export function settled(task: Task): Task {
  const { raw: _, ...rest } = task;
  const n = rest.points.length;
  const next: Task = { ...rest };
  if (next.timing && next.timing.crank_deg.length !== n)
    next.timing = { ...next.timing, crank_deg: evenAngles(n, next.closed) };
  if (next.tolerances && next.tolerances.length !== n) {
    next.tolerance = n > 0 ? Math.max(...next.tolerances) : next.tolerance;
    next.tolerances = undefined;
  }
  if (next.weights && next.weights.length !== n) next.weights = undefined;
  if (next.body && next.body.angle_deg.length !== n) {
    const { angle_deg, tolerances_deg } = next.body;
    const fitted = (list: number[]) => next.points.map((_, i) => list[i] ?? list.at(-1) ?? 0);
    next.body = {
      ...next.body,
      angle_deg: fitted(angle_deg),
      tolerances_deg: tolerances_deg && fitted(tolerances_deg),
    };
  }
  if (isExact(next) && !canBeExact(next)) next.method = undefined;
  return next;
}

/** A task with other points in place of all its points. */
export const withPoints = (task: Task, points: Point[], closed: boolean): Task => settled({ ...task, points, closed });

/** The key of the limit on the longest link, and its usual value in sizes of the path. */
const LONGEST = "require.longest_max";
const USUAL_LONGEST = 3;

const EXTENT = "require.extent_max";
/** Keys of a problem file that bound a length, and those that bound a place. */
const BOUND_LENGTHS = ["a", "b", "c", "d", "e", "ground", "coupler_x", "coupler_y"].map((key) => `design.${key}`);
const BOUND_PLACES = ["design.A", "design.B", "design.line_point"];

/** The length that no link may exceed: what is asked, or what a problem file has by itself; null: any. */
export function longestMax(task: Task): number | null {
  const given = task.kept?.[LONGEST];
  if (given !== undefined) return Number.isFinite(Number(given)) ? Number(given) : null;
  const isBounded = [EXTENT, ...BOUND_LENGTHS].some((key) => task.kept?.[key] !== undefined);
  return task.timing || task.body || task.function || isBounded ? null : USUAL_LONGEST * sizeOf(task.points);
}

/** The limit in sizes of the path; null: any. */
export function longestTimes(task: Task): number | null {
  const longest = longestMax(task);
  return longest === null ? null : longest / sizeOf(task.points);
}

/** No link longer than so many sizes of the path; null: any. */
export function withLongest(task: Task, times: number | null): Task {
  const { [LONGEST]: _, ...kept } = task.kept ?? {};
  const free = { ...task, kept: Object.keys(kept).length > 0 ? kept : undefined };
  if (longestTimes(free) === times) return free;
  const value = times === null ? '"any"' : String(Number((times * sizeOf(task.points)).toPrecision(6)));
  return { ...task, kept: { ...kept, [LONGEST]: value } };
}

/** The same with its limit on the longest link said, where it is the usual one. */
export function withLongestSaid(task: Task): Task {
  const longest = longestMax(task);
  if (longest === null || task.kept?.[LONGEST] !== undefined) return task;
  return { ...task, kept: { ...task.kept, [LONGEST]: String(Number(longest.toPrecision(6))) } };
}

/** The limit on the extent of the whole linkage in sizes of the path; null: any. */
export function extentTimes(task: Task): number | null {
  const given = Number(task.kept?.[EXTENT]);
  return Number.isFinite(given) ? given / sizeOf(task.points) : null;
}

/** The whole linkage in motion no larger than so many sizes of the path; null: any. */
export function withExtent(task: Task, times: number | null): Task {
  const { [EXTENT]: _, ...kept } = task.kept ?? {};
  const rest = Object.keys(kept).length > 0 ? kept : undefined;
  if (times === null) return { ...task, kept: rest };
  // A file that bounds the extent says nothing of the longest link: on the page that limit stays.
  const said = withLongestSaid({ ...task, kept: rest });
  return { ...task, kept: { ...said.kept, [EXTENT]: String(Number((times * sizeOf(task.points)).toPrecision(6))) } };
}

/** What a problem file says beyond the controls of the page. */
export const withoutControls = (kept: Record<string, string> | undefined): [string, string][] =>
  Object.entries(kept ?? {}).filter(([key]) => key !== LONGEST && key !== EXTENT);

/** The numbers of a text. */
const NUMBER = /[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?/gi;

/** The same problem with all lengths so many times as long. */
export function withLengthsTimes(task: Task, by: number): Task {
  const length = (value: number) => Number((value * by).toPrecision(12));
  const box = (one: Box | undefined) => one?.map(length) as Box | undefined;
  const isLength = (key: string) => [LONGEST, EXTENT, ...BOUND_LENGTHS, ...BOUND_PLACES].includes(key);
  const all = (text: string) => text.replace(NUMBER, (n) => String(length(Number(n))));
  const kept = Object.entries(task.kept ?? {}).map(([key, text]) => [key, isLength(key) ? all(text) : text]);
  return settled({
    ...task,
    points: task.points.map((p) => p.map(length) as Point),
    tolerance: task.tolerance === undefined ? undefined : length(task.tolerance),
    tolerances: task.tolerances?.map(length),
    stroke: (task.stroke as number[] | undefined)?.map(length) as Task["stroke"],
    pivots_in: box(task.pivots_in),
    footprint_in: box(task.footprint_in),
    body: task.body && {
      ...task.body,
      angle_weight: task.body.angle_weight && length(task.body.angle_weight),
      outline: task.body.outline?.map((line) => line.map((p) => p.map(length) as Point)),
    },
    kept: task.kept && Object.fromEntries(kept),
  });
}

/** The same linkage, as large for a path that is so many times as large. */
export function shownTimes(shown: Shown, by: number): Shown {
  const { kind: _k, t1: _1, t2: _2, line_deg: _d, ...lengths } = shown.linkage;
  const times = (value: unknown): unknown => (Array.isArray(value) ? value.map(times) : by * (value as number));
  const larger = Object.fromEntries(Object.entries(lengths).map(([name, value]) => [name, times(value)]));
  const linkage = { ...shown.linkage, ...larger } as Linkage;
  const within = shown.certified_within && shown.certified_within * by;
  return { ...shown, linkage, rms: shown.rms * by, max: shown.max * by, certified_within: within };
}

/** What is asked of the linkage, of a path that is drawn anew: what belonged to the points of another is gone. */
export function drawnAnew(task: Task, points: Point[], closed: boolean): Task {
  const fresh = drawnAlone(task, points, closed);
  if (task.points.length <= 2) return fresh;
  const bounded = task.kept?.[EXTENT] ? withExtent(fresh, extentTimes(task)) : fresh;
  return task.kept?.[LONGEST] ? withLongest(bounded, longestTimes(task)) : bounded;
}

const drawnAlone = (task: Task, points: Point[], closed: boolean): Task => ({
  ...task,
  points,
  closed,
  name: "drawing",
  source: undefined,
  timing: undefined,
  tolerances: undefined,
  weights: undefined,
  raw: undefined,
  kept: undefined,
  method: undefined,
  body: undefined,
  function: undefined,
});

/** The path alone. */
export const pathAlone = ({ name, unit, source, points, closed, mechanism, seed }: Task): Task => ({
  name,
  unit,
  source,
  points,
  closed,
  mechanism,
  types: [],
  seed,
});

/** Points that have moved, as many as before. */
export const withMoved = (task: Task, points: Point[]): Task => settled({ ...task, points });

/** One point more, after the point `index`: what stands beside it is its neighbour's. */
export function withAdded(task: Task, index: number, at: Point): Task {
  const insert = <T>(list: T[] | undefined, value: T) =>
    list && [...list.slice(0, index + 1), value, ...list.slice(index + 1)];
  const angles = task.timing?.crank_deg;
  const [before, after] = [angles?.[index] ?? 0, angles?.[index + 1]];
  const step = angles && index > 0 ? before - angles[index - 1] : 30;
  const angle = after === undefined ? before + step : (before + after) / 2;
  return settled({
    ...task,
    points: insert(task.points, at) as Point[],
    timing: task.timing && { ...task.timing, crank_deg: insert(angles, angle) as number[] },
    tolerances: insert(task.tolerances, task.tolerances?.[index] ?? task.tolerances?.[0] ?? 0),
    weights: insert(task.weights, 1),
    body: withAngles(task.body, (list) => insert(list, list[Math.max(index, 0)] ?? 0) as number[]),
  });
}

export function withRemoved(task: Task, index: number): Task {
  const drop = <T>(list: T[] | undefined) => list?.filter((_, i) => i !== index);
  return settled({
    ...task,
    points: drop(task.points) as Point[],
    timing: task.timing && { ...task.timing, crank_deg: drop(task.timing.crank_deg) as number[] },
    tolerances: drop(task.tolerances),
    weights: drop(task.weights),
    body: withAngles(task.body, (list) => drop(list) as number[]),
  });
}

/** A body whose lists beside the points are changed. */
function withAngles(body: Task["body"], change: (list: number[]) => number[]): Task["body"] {
  const each = body?.tolerances_deg;
  return body && { ...body, angle_deg: change(body.angle_deg), tolerances_deg: each && change(each) };
}

export function withTiming(task: Task, offset: "none" | "free" | "fixed" | "ground"): Task {
  if (offset === "none") return { ...task, timing: undefined };
  const crank_deg = task.timing?.crank_deg ?? evenAngles(task.points.length, task.closed);
  return settled({ ...task, timing: { crank_deg, offset } });
}

/** A hundredth of the size, to two digits: a tolerance to begin with. */
export function usualTolerance(task: Task): number {
  return Number((0.01 * (task.points.length > 0 ? sizeOf(task.points) : 100)).toPrecision(2));
}

export function withTolerances(task: Task, each: boolean): Task {
  if (!each)
    return {
      ...task,
      tolerance: task.tolerances ? Math.max(...task.tolerances) : task.tolerance,
      tolerances: undefined,
    };
  return { ...task, tolerances: task.points.map(() => task.tolerance ?? usualTolerance(task)), tolerance: undefined };
}

export const withWeights = (task: Task, each: boolean): Task => ({
  ...task,
  weights: each ? task.points.map(() => 1) : undefined,
});

export const toleranceAt = (task: Task, index: number): number | undefined =>
  task.tolerances?.[index] ?? task.tolerance;

/** The tolerance at a point, or of all where they have one. */
export function withToleranceAt(task: Task, index: number, radius: number): Task {
  const value = Number(Math.max(radius, 0).toPrecision(3));
  if (!task.tolerances) return { ...task, tolerance: value };
  return { ...task, tolerances: task.tolerances.map((t, i) => (i === index ? value : t)) };
}

export function boxOf(points: Point[]): Box | null {
  if (points.length === 0) return null;
  const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** The width and the height of a box. */
export const sidesOf = ([left, low, right, high]: Box): [number, number] => [right - left, high - low];

/** A box of these sides about the middle of `around`, moved as far as the path needs it. */
export function boxOfSides(sides: number[], points: Point[], around: Box): Box {
  const path = boxOf(points) ?? around;
  const [left, low] = sides.map((side, i) => {
    const [from, to] = [path[i + 2] - side, path[i]];
    const asked = (around[i] + around[i + 2] - side) / 2;
    return from > to ? (from + to) / 2 : Math.min(Math.max(asked, from), to);
  });
  return [left, low, left + sides[0], low + sides[1]];
}

/** How large a target is: the diagonal of its box. */
export function sizeOf(points: Point[]): number {
  const [left, low, right, high] = boxOf(points) ?? [0, 0, 0, 0];
  return Math.hypot(right - left, high - low) || 1;
}

/** A number to so many digits of a size that it belongs to, not of its own: far from the origin none of them is lost. */
export function roundTo(value: number, size: number, digits: number): number {
  const unit = 10 ** (Math.floor(Math.log10(size)) + 1 - digits);
  return Number((Math.round(value / unit) * unit).toPrecision(15));
}

const rounded = (box: Box) =>
  box.map((value) => roundTo(value, Math.hypot(box[2] - box[0], box[3] - box[1]), 3)) as Box;

/** A box for the pivots below the target, as wide as it; of a walking machine above, as its legs hang from there. */
export function pivotsBeside(points: Point[], isWalker = false): Box {
  const around = boxOf(points);
  if (!around) return [-50, -50, 50, 0];
  const [left, low, right, high] = around;
  const size = Math.max(right - left, high - low, 1e-6);
  const [from, to] = isWalker ? [high + 0.6 * size, high + 2 * size] : [low - 1.2 * size, low - 0.1 * size];
  return rounded([left - 0.3 * size, from, right + 0.3 * size, to]);
}

/** A box around the target, with room for links. */
export function spaceAround(points: Point[]): Box {
  const around = boxOf(points);
  if (!around) return [-100, -100, 100, 100];
  const [left, low, right, high] = around;
  const size = Math.max(right - left, high - low, 1e-6);
  return rounded([left - size, low - 1.5 * size, right + size, high + 0.5 * size]);
}

/** What the best answer depends on, and nothing else. */
function asked(task: Task): string {
  const { name: _n, source: _s, unit: _u, seed: _d, expect: _e, method: _m, raw: _r, kept, ...rest } = task;
  return JSON.stringify([
    Object.entries(rest)
      .filter(([, value]) => value !== undefined)
      .sort(),
    Object.entries(kept ?? {})
      .filter(([key]) => !key.startsWith("solve."))
      .sort(),
  ]);
}

/** Whether two say the same to nine digits: lengths made larger and small again lose the last ones. */
const isAlike = (one: string, other: string) => {
  const [p, q] = [one, other].map((text) => text.replace(NUMBER, (n) => String(Number(Number(n).toPrecision(9)))));
  return p === q;
};

export const isSamePath = (...both: [Task, Task]) => {
  const [p, q] = both.map(({ points, closed, unit = "mm", body }) =>
    JSON.stringify([points, closed, unit, body?.angle_deg]),
  );
  return isAlike(p, q);
};

/** Says that a pinned linkage was found for something else than what stands; empty: for the same. */
export function pinnedFor(pin: Task, now: Task): string {
  if (!isSamePath(pin, now)) return "pinned for another path";
  return isAlike(asked(pin), asked(now)) ? "" : "pinned with other wishes";
}

/** Whether two are one problem under other names. */
export function isSameButForName(one: Task, other: Task): boolean {
  const nameless = ({ name: _n, source: _s, ...rest }: Task) => JSON.stringify(Object.entries(rest).sort());
  return nameless(one) === nameless(other);
}

/** An edited task: what was known of the answer of the one before goes where it is no longer the same problem. */
export function withoutStale(before: Task, task: Task): Task {
  const { expect, ...rest } = task;
  return expect && expect.of === before.expect?.of && asked(task) !== asked(before) ? rest : task;
}

/** Another task that is offered, what it is, and what its button says if that is more. */
export type Instead = { task: Task; said: string; button?: string } | null;

/** A least transmission angle, degrees, with which a linkage runs freely. */
const FREELY = 30;

/** Where no linkage through nine points does all that is asked: the nearest one instead, within a tolerance. */
export function nearestInstead(task: Task, answer: Answer | null): Instead {
  const isFor = isExact(task) && answer?.doing === "done" && !answer.candidates.some((one) => one.accepted);
  if (!isFor) return null;
  const tolerance = task.tolerance ?? usualTolerance(task);
  return {
    task: { ...task, method: undefined, tolerance },
    said: `the nearest linkage within ${tolerance}${unitAfter(task.unit)} instead of exactly through the points`,
  };
}

/** Where a linkage meets what is asked but jams, and nothing forbids that: a wish that does. */
export function unjammed(task: Task, shown: Shown): Instead {
  if (!shown.accepted || !jams(shown) || task.transmission_deg_min) return null;
  return {
    task: { ...task, transmission_deg_min: FREELY },
    said: `least transmission angle ${FREELY}°`,
    button: `It jams: ask for at least ${FREELY}°`,
  };
}

/** The task of an edit: the rest is the connection's. What an edit leaves out has its default. */
export function taskOf(ask: AnyAsk): Task {
  const { version: _v, moving: _m, held: _h, from: _l, fresh: _f, map: _p, ...task } = ask;
  return {
    ...task,
    name: ask.name ?? "drawing",
    closed: ask.closed ?? false,
    types: ask.types ?? [],
    seed: ask.seed ?? 1,
  };
}
