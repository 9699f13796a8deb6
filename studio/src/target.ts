// Targets: strokes of the hand made even, texts of coordinates read.

import type { Point } from "./messages";
import { roundTo, sizeOf } from "./task";

/** Points of a drawn curve. */
export const DRAWN = 60;
/** Above so many points a dragged point takes its neighbours along. */
const SOFT = 20;

const apart = (p: Point, q: Point) => Math.hypot(p[0] - q[0], p[1] - q[1]);

function lengthOf(points: Point[]): number {
  let sum = 0;
  for (let i = 1; i < points.length; i += 1) sum += apart(points[i], points[i - 1]);
  return sum;
}

/** So many points evenly along a line; of a closed one the first is not repeated at the end. */
export function resampled(points: Point[], count: number, closed: boolean): Point[] {
  const line = closed ? [...points, points[0]] : points;
  const step = lengthOf(line) / (closed ? count : count - 1);
  const even: Point[] = [line[0]];
  let gone = 0;
  for (let i = 1; i < line.length && even.length < count; i += 1) {
    const [from, to] = [line[i - 1], line[i]];
    const long = apart(from, to);
    while (even.length < count && even.length * step <= gone + long + 1e-9 * step) {
      const part = long > 0 ? (even.length * step - gone) / long : 0;
      even.push([from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]);
    }
    gone += long;
  }
  while (even.length < count) even.push(line[line.length - 1]);
  return even;
}

/** The mean of each point and its neighbours, weighted 1 2 1, so many times; the ends of an open line stay. */
function smoothed(points: Point[], times: number, closed: boolean): Point[] {
  let line = points;
  const n = line.length;
  for (let pass = 0; pass < times; pass += 1) {
    line = line.map((p, i): Point => {
      if (!closed && (i === 0 || i === n - 1)) return p;
      const [before, after] = [line[(i + n - 1) % n], line[(i + 1) % n]];
      return [(before[0] + 2 * p[0] + after[0]) / 4, (before[1] + 2 * p[1] + after[1]) / 4];
    });
  }
  return line;
}

/** Without digits that nobody drew: a thousandth of the extent is the last that counts, wherever the points lie. */
const rounded = (p: Point, extent: number): Point => [roundTo(p[0], extent, 5), roundTo(p[1], extent, 5)];

/** A stroke as a target; null where it is too short to be meant. Ends that meet close it. */
export function ofStroke(stroke: Point[], least: number): { points: Point[]; closed: boolean } | null {
  const length = lengthOf(stroke);
  if (stroke.length < 8 || !(length > least)) return null;
  const closed = apart(stroke[0], stroke[stroke.length - 1]) < 0.12 * length;
  const fine = smoothed(resampled(stroke, 4 * DRAWN, closed), 24, closed);
  const even = resampled(fine, DRAWN, closed);
  return { points: even.map((p) => rounded(p, sizeOf(even))), closed };
}

/** The points with one of them moved; of a dense curve its neighbours come along, less and less. */
export function moved(points: Point[], index: number, to: Point, closed: boolean): Point[] {
  const n = points.length;
  const reach = n > SOFT ? Math.round(n / 9) : 0;
  const extent = sizeOf(points);
  const [dx, dy] = [to[0] - points[index][0], to[1] - points[index][1]];
  return points.map((p, i): Point => {
    let far = Math.abs(i - index);
    if (closed) far = Math.min(far, n - far);
    if (far > reach) return p;
    const part = 0.5 + 0.5 * Math.cos((Math.PI * far) / (reach + 1));
    return rounded([p[0] + part * dx, p[1] + part * dy], extent);
  });
}

/** The point of the path after which one is added that was clicked so near to the line, if it was. */
export function segmentAt(points: Point[], at: Point, closed: boolean, near: number): number | null {
  let [best, least] = [null as number | null, near];
  points.forEach((p, i) => {
    const q = points[i + 1] ?? (closed ? points[0] : null);
    if (!q) return;
    const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
    const part = Math.min(Math.max(((at[0] - p[0]) * dx + (at[1] - p[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
    const far = apart(at, [p[0] + part * dx, p[1] + part * dy]);
    if (far < least) [best, least] = [i, far];
  });
  return best;
}

/** What is wrong with a line that is not two numbers, and the remedy. */
function wrongWith(line: string, cells: string[]): string {
  const shown = line.slice(0, 40);
  if (/;/.test(line)) return `\`${shown}\` has a semicolon: write 1.5, 2.5 with decimal points and a comma between`;
  if (/\d,\d/.test(line) && (cells.length > 2 || cells.some((cell) => cell.includes(","))))
    return `\`${shown}\`: if these are decimal commas write a decimal point, 1.5`;
  if (cells.length > 2)
    return `\`${shown}\` has ${cells.length} cells: a header such as x,y,crank_deg must say what they are`;
  return `\`${shown}\` is not two numbers`;
}

/**
 * Points of a text: two numbers a line, apart by a tab, a comma or blanks; a first line of words (a header) is passed
 * over. What could be read in two ways is refused.
 */
export function ofText(text: string): Point[] | string {
  const points: Point[] = [];
  for (const [i, raw] of text.split(/\r?\n/).entries()) {
    const line = raw.split("#")[0].trim();
    if (line === "") continue;
    const cells = line.split(/\t/.test(line) ? /\s*\t\s*/ : /,/.test(line) ? /\s*,\s*/ : /\s+/);
    const numbers = cells.map((cell) => (cell === "" ? NaN : Number(cell)));
    if (numbers.length === 2 && numbers.every(Number.isFinite)) points.push([numbers[0], numbers[1]]);
    else if (points.length > 0 || !cells.every((cell) => /^[a-z_]+$/i.test(cell)))
      return `line ${i + 1}: ${wrongWith(line, cells)}`;
  }
  return points;
}
