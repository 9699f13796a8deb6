// The map of the places of a pin under the board: warm where a point of the body moves nearly on a circle, so that a pin can
// go there. It lies with the body in its chosen pose, or in the first. Of four poses the curves of the pins that stay on circles,
// which lie with the body, and of their pivots, marked where a linkage without defects has its pin.

import { pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import type { Board } from "./board";
import type { Answer, Point, Task } from "./messages";

type PinMap = NonNullable<Answer["map"]>;

/** The letters of the lowest and of the highest level. */
const [LOWEST, HIGHEST] = [35, 91];
/** The colour of the best places, and the part of the levels that is coloured. */
const [RED, GREEN, BLUE] = [214, 110, 20];
const SEEN = 0.72;
/** The least transmission angles of the marks, degrees. */
const CLASSES: [number, string][] = [
  [40, "good"],
  [20, "fair"],
  [0, "poor"],
];

type Place = NonNullable<PinMap["curves"]>[number][number];

/** A curve in faint lines, with marks over the stretches where a linkage has its pin. */
function lines(curves: Place[][], at: (place: Place) => Point): SVGElement[] {
  const classOf = ({ deg }: Place) => (deg === undefined ? undefined : CLASSES.find(([least]) => deg >= least)?.[1]);
  return curves.flatMap((stretch) => {
    const points = stretch.map(at);
    const drawn = [shape("path", { d: pathThrough(points) })];
    for (let from = 0; from < stretch.length; ) {
      const name = classOf(stretch[from]);
      let to = from + 1;
      while (to < stretch.length && classOf(stretch[to]) === name) to += 1;
      // Up to the next place, so that neighbouring stretches meet.
      if (name) drawn.push(shape("path", { class: name, d: pathThrough(points.slice(from, to + 1)) }));
      from = to;
    }
    return drawn;
  });
}

export class PinMapLayer {
  private group = shape("g", { class: "pin-map" });
  private image = shape("image", { preserveAspectRatio: "none" });
  private best = shape("g");
  private pins = shape("g", { class: "pin-curve" });
  private pivots = shape("g", { class: "pivot-curve" });
  private map: PinMap | null = null;
  private canvas = document.createElement("canvas");

  constructor(private board: Board) {
    this.group.append(this.image, this.pins, this.best);
    board.boxGroup.before(this.group, this.pivots);
  }

  /** Takes another map; null: none. */
  show(map: PinMap | null) {
    if (map === this.map) return;
    if (map && map.levels !== this.map?.levels) this.paint(map);
    this.map = map;
    for (const group of [this.group, this.pivots]) group.classList.toggle("absent", !map);
  }

  private paint({ grid, levels }: PinMap) {
    const { canvas } = this;
    [canvas.width, canvas.height] = [grid, grid];
    const context = canvas.getContext("2d");
    if (!context) return;
    const pixels = context.createImageData(grid, grid);
    for (let row = 0; row < grid; row += 1)
      for (let column = 0; column < grid; column += 1) {
        const level = (levels.charCodeAt(row * grid + column) - LOWEST) / (HIGHEST - LOWEST);
        // The rows of a picture go down.
        const at = 4 * ((grid - 1 - row) * grid + column);
        pixels.data.set([RED, GREEN, BLUE, Math.round(215 * Math.max(0, 1 - level / SEEN) ** 1.6)], at);
      }
    context.putImageData(pixels, 0, 0);
    setAll(this.image, { href: canvas.toDataURL() });
  }

  draw(task: Task) {
    const { map, board } = this;
    const index = Math.max(board.selected, 0);
    const at = task.points[index] as Point | undefined;
    const deg = task.body?.angle_deg[index];
    for (const group of [this.group, this.pivots])
      group.classList.toggle("absent", !map || !at || !Number.isFinite(deg));
    if (!map || !at || deg === undefined || !Number.isFinite(deg)) return;
    const [x, y] = board.toPixel(at);
    const { scale } = board.looking;
    // A place is the middle of its pixel.
    const half = map.half * scale * (map.grid / (map.grid - 1));
    setAll(this.group, { transform: `translate(${px(x)} ${px(y)}) rotate(${px(-deg)})` });
    setAll(this.image, { x: px(-half), y: px(-half), width: px(2 * half), height: px(2 * half) });
    this.best.replaceChildren(
      ...map.best.map(([[u, v]]) =>
        shape("circle", { class: "best-pin", cx: px(u * scale), cy: px(-v * scale), r: 4 }),
      ),
    );
    const curves = map.curves ?? [];
    this.pins.replaceChildren(...lines(curves, ({ pin: [u, v] }) => [u * scale, -v * scale]));
    this.pivots.replaceChildren(...lines(curves, ({ pivot }) => board.toPixel(pivot as Point)));
  }
}
