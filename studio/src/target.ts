// Targets: strokes of the hand made even, texts of coordinates read.

import type { Point } from "./messages";

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

/** A number without digits that nobody drew: a thousandth of the size is the last that counts. */
function rounded(points: Point[]): Point[] {
  const size = Math.max(...points.map((p) => Math.max(Math.abs(p[0]), Math.abs(p[1]))), 1e-9);
  const unit = 10 ** (Math.floor(Math.log10(size)) - 4);
  const round = (x: number) => Number((Math.round(x / unit) * unit).toPrecision(12));
  return points.map((p): Point => [round(p[0]), round(p[1])]);
}

/** A stroke as a target; null where it is too short to be meant. Ends that meet close it. */
export function ofStroke(stroke: Point[], least: number): { points: Point[]; closed: boolean } | null {
  const length = lengthOf(stroke);
  if (stroke.length < 8 || !(length > least)) return null;
  const closed = apart(stroke[0], stroke[stroke.length - 1]) < 0.12 * length;
  const fine = smoothed(resampled(stroke, 4 * DRAWN, closed), 24, closed);
  return { points: rounded(resampled(fine, DRAWN, closed)), closed };
}

/** The points with one of them moved; of a dense curve its neighbours come along, less and less. */
export function moved(points: Point[], index: number, to: Point, closed: boolean): Point[] {
  const n = points.length;
  const reach = n > SOFT ? Math.round(n / 9) : 0;
  const [dx, dy] = [to[0] - points[index][0], to[1] - points[index][1]];
  return rounded(points.map((p, i): Point => {
    let far = Math.abs(i - index);
    if (closed) far = Math.min(far, n - far);
    const part = far > reach ? 0 : 0.5 + 0.5 * Math.cos((Math.PI * far) / (reach + 1));
    return [p[0] + part * dx, p[1] + part * dy];
  }));
}

/** Points of a text: two numbers a line, apart by a comma or blanks; a line of words (a header) is passed over. */
export function ofText(text: string): Point[] | string {
  const points: Point[] = [];
  for (const [i, raw] of text.split(/\r?\n/).entries()) {
    const line = raw.split("#")[0].trim();
    if (line === "") continue;
    const cells = line.split(/[\s,;]+/).filter((cell) => cell !== "");
    const numbers = cells.slice(0, 2).map(Number);
    if (numbers.length === 2 && numbers.every(Number.isFinite)) points.push([numbers[0], numbers[1]]);
    else if (points.length > 0 || !cells.every((cell) => /^[a-z_]+$/i.test(cell))) return `line ${i + 1} is not two numbers: ${line.slice(0, 40)}`;
  }
  return points;
}
