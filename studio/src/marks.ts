// The points of the target on the board: dots, handles to hold them by, circles of their tolerances with rims to draw.

import { px, shape } from "../../src/report/html/player/svg.mjs";
import type { Point, Task } from "./messages";
import { toleranceAt } from "./task";

/** A path of more points is dense, and held at so many of them. */
const DENSE = 24;
const HANDLES = 10;
/** Circles of fewer pixels are not drawn, and ones of fewer have no rim to hold. */
const [SEEN, HELD] = [1.5, 8];

/** The points that are held: of a dense path a few, its ends not among them, as there the next stroke may begin. */
function heldOf(n: number, selected: number): Set<number> {
  const few = n > DENSE;
  const held = Array.from({ length: few ? HANDLES : n }, (_, k) => (few ? Math.floor(((k + 0.5) * n) / HANDLES) : k));
  return new Set(selected >= 0 ? [...held, selected] : held);
}

/** A circle around a point of the board. */
const circle = (name: string, [x, y]: Point, r: number, more: Record<string, number> = {}) =>
  shape("circle", { class: name, cx: px(x), cy: px(y), r: px(r), ...more });

/** The shapes of points at places on the board: what lies under the linkage, what lies over it, and which are held. */
export function pointShapes(task: Task, spots: Point[], scale: number, selected: number) {
  const many = spots.length > DENSE;
  const held = heldOf(spots.length, selected);
  const radii = spots.map((_, i) => (toleranceAt(task, i) ?? 0) * scale);
  const allowed = spots.flatMap((spot, i) => (radii[i] > SEEN ? [circle("allowed", spot, radii[i])] : []));
  const points = spots.flatMap((spot, i) => {
    if (!held.has(i)) return [];
    const chosen = i === selected;
    const name = `target-point${i === 0 ? " first" : ""}${chosen ? " chosen" : ""}`;
    return [
      circle(name, spot, chosen ? 6.5 : many ? 4.4 : 5),
      circle("handle", spot, many ? 9 : 16, { "data-point": i }),
    ];
  });
  // The rim of a circle can be drawn outwards and inwards where it does not lie on the point itself; the chosen one's lies on top.
  const rims = spots.flatMap(([x, y], i) => {
    if ((many && i !== selected) || radii[i] <= HELD) return [];
    const aside = radii[i] * Math.SQRT1_2;
    const [at, name]: [Point, Record<string, number>] = [[x + aside, y - aside], { "data-rim": i }];
    return [{ i, rim: [circle("rim", at, 5, name), circle("touch", at, 9, name)] }];
  });
  rims.sort((one, other) => Number(one.i === selected) - Number(other.i === selected));
  return { allowed, marks: [...points, ...rims.flatMap(({ rim }) => rim)], held: [...held] };
}
