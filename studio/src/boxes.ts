// The boxes of the requirements, drawn: for the fixed pivots, and for everything that moves.

import { px, shape } from "../../src/report/html/player/svg.mjs";
import { unitAfter } from "./labels";
import type { Box, Point, Task } from "./messages";
import { roundTo, sidesOf } from "./task";

export type BoxKind = "pivots_in" | "footprint_in";
/** The least side of a box, in pixels. */
export const LEAST = 12;
export const KINDS: BoxKind[] = ["pivots_in", "footprint_in"];

const SAYS: Record<BoxKind, string> = {
  pivots_in: "both fixed pivots in here",
  footprint_in: "all joints and P in here",
};
/** Pixels from the upper rim of a box to its words: of one that may lie around the other outside. */
const WORDS: Record<BoxKind, number> = { pivots_in: 15, footprint_in: -8 };
/** Which numbers of a box each corner holds, in the order in which keys go through them. */
const CORNERS: [number, number][] = [
  [0, 1],
  [2, 1],
  [2, 3],
  [0, 3],
];
const NAMES = ["lower left", "lower right", "upper right", "upper left"];

export interface Corner {
  kind: BoxKind;
  corner: number;
}

/** A box with one of its corners elsewhere, never narrower than `least`. */
export function resized(box: Box, corner: number, to: Point, least: number): Box {
  const [i, j] = CORNERS[corner];
  const [x, y] = to.map((value) => roundTo(value, Math.hypot(box[2] - box[0], box[3] - box[1]) || least, 4));
  const next = [...box] as Box;
  next[i] = i === 0 ? Math.min(x, box[2] - least) : Math.max(x, box[0] + least);
  next[j] = j === 1 ? Math.min(y, box[3] - least) : Math.max(y, box[1] + least);
  return next;
}

/** The box between two points; null where it would be too small to be meant. */
export function between(from: Point, to: Point, least: number): Box | null {
  const size = Math.max(Math.hypot(to[0] - from[0], to[1] - from[1]), least);
  const [x0, y0, x, y] = [...from, ...to].map((value) => roundTo(value, size, 4));
  const box: Box = [Math.min(x0, x), Math.min(y0, y), Math.max(x0, x), Math.max(y0, y)];
  return box[2] - box[0] >= least && box[3] - box[1] >= least ? box : null;
}

export function cornerOf(box: Box, corner: number): Point {
  const [i, j] = CORNERS[corner];
  return [box[i], box[j]];
}

/** The next corner in the order of keys; null after the last. */
export function nextCorner(task: Task, now: Corner | null): Corner | null {
  const all = KINDS.filter((kind) => task[kind]).flatMap((kind) => NAMES.map((_, corner) => ({ kind, corner })));
  const at = now ? all.findIndex((one) => one.kind === now.kind && one.corner === now.corner) : -1;
  return all[at + 1] ?? null;
}

/** The sides of a box: `300 × 200 mm`. */
const sizeInWords = (box: Box, unit: string | undefined) =>
  sidesOf(box)
    .map((side) => Number(side.toPrecision(4)))
    .join(" × ") + unitAfter(unit);

export const inWords = (at: Corner) =>
  `Box for ${at.kind === "pivots_in" ? "the pivots" : "everything"}, ${NAMES[at.corner]} corner`;

/** Where both boxes have corners and words, in pixels. */
export function boxSpots(task: Task, toPixel: (p: Point) => Point): Point[] {
  return KINDS.flatMap((kind) => {
    const box = task[kind];
    if (!box) return [];
    const [left, top] = toPixel(cornerOf(box, 3));
    const words = [30, 70, 110, 150, 190, 230].map((along): Point => [left + along, top + WORDS[kind] - 5]);
    return [...NAMES.map((_, corner) => toPixel(cornerOf(box, corner))), ...words];
  });
}

/** Both boxes as shapes, with handles at their corners. */
export function boxShapes(task: Task, toPixel: (p: Point) => Point, chosen: Corner | null): SVGElement[] {
  return KINDS.flatMap((kind) => {
    const box = task[kind];
    if (!box) return [];
    const [left, top] = toPixel([box[0], box[3]]);
    const [right, bottom] = toPixel([box[2], box[1]]);
    return [
      shape("rect", {
        class: `pivot-box ${kind}`,
        x: px(left),
        y: px(top),
        width: px(Math.max(right - left, 0)),
        height: px(Math.max(bottom - top, 0)),
      }),
      shape("text", { class: "number", x: px(left + 8), y: px(top + WORDS[kind]) }, [
        `${SAYS[kind]}, ${sizeInWords(box, task.unit)}`,
      ]),
      ...NAMES.flatMap((_, corner) => {
        const [x, y] = toPixel(cornerOf(box, corner));
        const here = chosen?.kind === kind && chosen.corner === corner;
        const name = { "data-corner": `${kind}:${corner}` };
        return [
          shape("rect", {
            class: `corner${here ? " chosen" : ""}`,
            x: px(x - 6),
            y: px(y - 6),
            width: 12,
            height: 12,
            ...name,
          }),
          shape("circle", { class: "touch", cx: px(x), cy: px(y), r: 11, ...name }),
        ];
      }),
    ];
  });
}
