// The view of the board: which point of the plane lies at the middle, and how many pixels a length of 1 has. Nothing
// here knows the page.

import type { Box, Point } from "./messages";

export interface View {
  /** The point at the middle of the board. */
  readonly x: number;
  readonly y: number;
  /** Pixels of a length of 1. */
  readonly scale: number;
}

/** The board in pixels. */
export interface Frame {
  readonly width: number;
  readonly height: number;
}

/** Pixels of a millimetre on an empty board. */
const OPENING = 3;
/** Millimetres of the units; a length without a unit counts as one of a millimetre. */
const MILLIMETRES: Record<string, number> = { mm: 1, cm: 10, m: 1000, in: 25.4 };
/** The part of the board's shorter side that a path fills when it is brought into view, and the least with what stands
 * around it. */
const FILLED = 0.42;
const LEAST_FILLED = 0.36;
const [LEAST, MOST] = [1e-7, 1e7];
/** Pixels between what is brought into view and the rim. */
const RIM = 46;

/** The view of an empty board. */
export const opening = (unit: string | undefined): View => ({
  x: 0,
  y: 0,
  scale: OPENING * (MILLIMETRES[unit ?? ""] ?? 1),
});

export const toPixel = (view: View, frame: Frame, [x, y]: Point): Point => [
  frame.width / 2 + (x - view.x) * view.scale,
  frame.height / 2 - (y - view.y) * view.scale,
];

export const toPlane = (view: View, frame: Frame, [x, y]: Point): Point => [
  view.x + (x - frame.width / 2) / view.scale,
  view.y - (y - frame.height / 2) / view.scale,
];

const limited = (scale: number) => Math.min(Math.max(scale, LEAST), MOST);

/** Nearer or farther, while the point `around` stays where it is. */
export function zoomed(view: View, by: number, around: Point = [view.x, view.y]): View {
  const scale = limited(view.scale * by);
  const kept = view.scale / scale;
  return { scale, x: around[0] + (view.x - around[0]) * kept, y: around[1] + (view.y - around[1]) * kept };
}

/** The view in which the point `from` lies where `to` lies now. */
export const carried = (view: View, from: Point, to: Point): View => ({
  ...view,
  x: view.x + from[0] - to[0],
  y: view.y + from[1] - to[1],
});

/** The same picture of a plane whose lengths are all `by` times as long. */
export const rescaled = (view: View, by: number): View => ({
  x: view.x * by,
  y: view.y * by,
  scale: limited(view.scale / by),
});

/** A path over so much of the board that its shape is seen and links have room, with all that stands around it if the
 * path stays large enough. */
export function onPath(frame: Frame, path: Box, all: Box = path): View {
  const [left, low, right, high] = path;
  const side = Math.min(frame.width, frame.height);
  const size = Math.max(right - left, high - low) || 1e-6;
  const wide = around(frame, all);
  if (isWithin(all, path))
    return { x: (left + right) / 2, y: (low + high) / 2, scale: limited((FILLED * side) / size) };
  const least = limited((LEAST_FILLED * side) / size);
  if (wide.scale >= least) return wide;
  // As much as there is room for, the path among it.
  const near = (wished: number, from: number, to: number, room: number) =>
    Math.min(Math.max(wished, to - room), from + room);
  const [halfWide, halfHigh] = [(frame.width / 2 - RIM) / least, (frame.height / 2 - RIM) / least];
  return { x: near(wide.x, left, right, halfWide), y: near(wide.y, low, high, halfHigh), scale: least };
}

/** The nearest view that holds everything. */
export function around(frame: Frame, [left, low, right, high]: Box): View {
  const size = Math.max(right - left, high - low, 1e-6);
  const scale = Math.min(
    (frame.width - 2 * RIM) / Math.max(right - left, size / 50),
    (frame.height - 2 * RIM) / Math.max(high - low, size / 50),
  );
  return { x: (left + right) / 2, y: (low + high) / 2, scale: limited(scale) };
}

/** The view moved as little as brings a box into a frame that has become smaller; the scale stays. A box without room has
 * its middle in the middle. */
export function inSight(view: View, frame: Frame, [left, low, right, high]: Box): View {
  const near = (middle: number, from: number, to: number, pixels: number) => {
    const half = (pixels - RIM) / 2 / view.scale;
    return to - from > 2 * half ? (from + to) / 2 : Math.min(Math.max(middle, to - half), from + half);
  };
  return { ...view, x: near(view.x, left, right, frame.width), y: near(view.y, low, high, frame.height) };
}

/** What of the plane is in view. */
export function windowOf(view: View, frame: Frame): Box {
  const [left, top] = toPlane(view, frame, [0, 0]);
  const [right, bottom] = toPlane(view, frame, [frame.width, frame.height]);
  return [left, bottom, right, top];
}

/** The least box around boxes; null if none of them is finite. */
export function joined(boxes: Box[]): Box | null {
  const finite = boxes.filter((box) => box.every(Number.isFinite));
  if (finite.length === 0) return null;
  const of = (k: number) => finite.map((box) => box[k]);
  return [Math.min(...of(0)), Math.min(...of(1)), Math.max(...of(2)), Math.max(...of(3))];
}

/** Whether a box lies within another. */
export const isWithin = (inner: Box, outer: Box): boolean =>
  inner[0] >= outer[0] && inner[1] >= outer[1] && inner[2] <= outer[2] && inner[3] <= outer[3];
