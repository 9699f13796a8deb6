// Which linkage is meant: one that is pinned, or one of the candidates, which move and change their places.

import { type Linkage, pivotsOf, type Shown, type Solution } from "./messages";

/** None: the best candidate, whichever that is. */
export type Choice = { pin: Solution } | { candidate: Shown } | null;

/** A linkage that differs by more, in parts of its size, is another one. */
const ANOTHER = 0.3;

/** How unlike two linkages are, in parts of their size. */
function unlike({ linkage: p }: Shown, { linkage: q }: Shown): number {
  if (p.kind !== q.kind || p.t1 !== q.t1 || p.t2 !== q.t2) return Infinity;
  // Of several loops the numbers of the chain, in their order.
  const flat = (value: unknown): number[] =>
    typeof value === "number" ? [value] : typeof value === "object" && value ? Object.values(value).flatMap(flat) : [];
  const numbers = ({ kind: _k, t1: _1, t2: _2, line_deg: _d, ...rest }: Linkage) => flat(rest);
  const [ps, qs] = [numbers(p), numbers(q)];
  const [[x, y], [x2, y2] = [x, y]] = pivotsOf(p);
  const size = Math.max(Math.hypot(x2 - x, y2 - y), ...[p.a ?? 0, p.b ?? 0, p.c ?? 0].map(Math.abs));
  if (ps.length !== qs.length) return Infinity;
  const apart = Math.max(...ps.map((value, i) => Math.abs(value - qs[i]))) / (size || 1);
  // The direction of a rail, as the part of its length by which it leads elsewhere.
  return Math.max(apart, 2 * Math.abs(Math.sin((((p.line_deg ?? 0) - (q.line_deg ?? 0)) * Math.PI) / 360)));
}

/** Whether two are one linkage, which the hand has moved. */
export function isSame(one: Shown, other: Shown): boolean {
  return (one.number !== undefined && one.number === other.number) || unlike(one, other) < ANOTHER;
}

/** Whether two are one linkage to the last digit that is seen. */
export const isTheSame = (one: Shown, other: Shown) => unlike(one, other) < 1e-6;

/** The choice among candidates that have changed: the same linkage, or what it has become; null where it is gone. */
export function followed(choice: Choice, candidates: Shown[]): Choice {
  if (!choice || "pin" in choice) return choice;
  const { number } = choice.candidate;
  const itself = number === undefined ? undefined : candidates.find((one) => one.number === number);
  if (itself) return { candidate: itself };
  const far = candidates.map((one) => unlike(choice.candidate, one));
  const nearest = far.indexOf(Math.min(...far));
  return far[nearest] < ANOTHER ? { candidate: candidates[nearest] } : null;
}

/** Its place among candidates and what is pinned behind them; -1: there is none. */
export function placeOf(choice: Choice, candidates: Shown[], pinned: Solution[]): number {
  if (!choice) return candidates.length > 0 ? 0 : -1;
  return "pin" in choice ? candidates.length + pinned.indexOf(choice.pin) : candidates.indexOf(choice.candidate);
}
