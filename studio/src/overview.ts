// A small map in the corner of the board, while the linkage runs off its edge: the linkage, the path, what is in view.

import { pathThrough, px, setAll, shape } from "../../src/report/html/player/svg.mjs";
import type { Moving } from "./figures";
import type { Box, Point } from "./messages";
import * as view from "./view";

const FRAME: view.Frame = { width: 132, height: 96 };
const RIM = 8;
/** The part of the board's width and height that it covers at most. */
const PART = 0.24;

export class Overview {
  readonly group = shape("g", { class: "overview", "aria-hidden": "true" });
  private sheet = shape("rect", { class: "map", width: FRAME.width, height: FRAME.height, rx: 6 });
  private curve = shape("path", { class: "curve" });
  private links = shape("path", { class: "bar" });
  private path = shape("rect", { class: "path" });
  private seen = shape("rect", { class: "seen" });
  private map: view.View | null = null;
  /** Where it lies on the board: its corner, and pixels there for one of its own. */
  private at = { x: 0, y: 0, by: 1 };

  constructor() {
    this.group.append(this.sheet, this.curve, this.links, this.path, this.seen);
  }

  /** The point of the plane that is shown at a pixel of the board; null outside the map. */
  pointAt([x, y]: Point): Point | null {
    const own: Point = [(x - this.at.x) / this.at.by, (y - this.at.y) / this.at.by];
    const isOutside = own[0] < 0 || own[1] < 0 || own[0] > FRAME.width || own[1] > FRAME.height;
    if (!this.map || isOutside || this.group.classList.contains("absent")) return null;
    return view.toPlane(this.map, FRAME, own);
  }

  /** Gives places of the map on the board; none where it is hidden. */
  show(path: Box | null, moving: Moving | null, window: Box, board: view.Frame): Point[] {
    const linkage = moving?.box() as Box | undefined;
    const everything = view.joined([...(linkage ? [linkage] : []), ...(path ? [path] : [])]);
    const isHidden = !everything || !linkage || !moving || view.isWithin(everything, window);
    this.group.classList.toggle("absent", isHidden);
    if (isHidden) return [];
    const by = Math.min(1, (PART * board.width) / FRAME.width, (PART * board.height) / FRAME.height);
    this.at = { x: board.width - FRAME.width * by - 8, y: board.height - FRAME.height * by - 8, by };
    setAll(this.group, { transform: `translate(${px(this.at.x)} ${px(this.at.y)}) scale(${by})` });
    const all = view.joined([everything, window]) as Box;
    const within: view.Frame = { width: FRAME.width + 76 - 2 * RIM, height: FRAME.height + 76 - 2 * RIM };
    const map = view.around(within, all);
    this.map = map;
    const toward = (p: Point) => view.toPixel(map, FRAME, p);
    setAll(this.curve, { d: pathThrough(moving.curve.map((p) => p && toward(p))) });
    setAll(this.links, { d: pathThrough(moving.links.map(toward)) });
    const box = (node: SVGElement, [left, low, right, high]: Box) => {
      const [x, y] = toward([left, high]);
      const [x2, y2] = toward([right, low]);
      setAll(node, { x: px(x), y: px(y), width: px(Math.max(x2 - x, 2)), height: px(Math.max(y2 - y, 2)) });
    };
    if (path) box(this.path, path);
    box(this.seen, window);
    return [0, 0.5, 1].map((part) => [this.at.x + part * FRAME.width * by, this.at.y]);
  }
}
