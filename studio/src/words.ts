// The quality of a linkage in words: how near its curve comes, how well it transmits, how large it is.

import { figure } from "../../src/report/html/player/svg.mjs";
import type { Shown } from "./messages";

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

export function transmissionInWords(deg: number): Graded {
  const angle = `transmission ${deg < 0.05 ? 0 : figure(deg, 2)}°`;
  if (deg >= WELL) return { grade: "good", text: `${angle} (good)` };
  if (deg >= FAIRLY) return { grade: "fair", text: `${angle} (fair)` };
  if (deg >= POORLY) return { grade: "poor", text: `${angle} (poor)` };
  return { grade: "poor", text: `${angle} (it jams)` };
}

/** The longest of ground, a, b, c, d and e. */
export function longestOf({ A, B, a, b, c, d, e }: Shown["linkage"]): number {
  return Math.max(Math.hypot(B[0] - A[0], B[1] - A[1]), ...[a, b, c, d, e].map(Math.abs));
}

/** The longest link as a multiple of the path. */
export const sizeInWords = (linkage: Shown["linkage"], size: number): string =>
  `longest link ${Number((longestOf(linkage) / size).toPrecision(2))} × the path`;

/** The limit on which a linkage lies, in words; empty if on none. */
export function limitedBy(
  shown: Shown,
  limits: { longest: number | null; transmission?: number; ratio?: number },
): string {
  const said: string[] = [];
  const near = (value: number, limit: number) => Math.abs(value - limit) <= 2e-3 * limit;
  if (limits.longest !== null && near(longestOf(shown.linkage), limits.longest)) said.push("longest link");
  if (limits.transmission && near(shown.transmission_deg, limits.transmission)) said.push("transmission angle");
  if (limits.ratio && near(shown.link_ratio, limits.ratio)) said.push("link ratio");
  return said.length > 0 ? `limited by: ${said.join(", ")}` : "";
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
  words[best(({ shown }) => 180 - shown.transmission_deg).i].push("best transmission");
  return words;
}
