// A small picture of a linkage over its target, which moves.

import { pathThrough, setAll, shape } from "../../src/report/html/player/svg.mjs";
import { Figure, type Moving } from "./figures";
import type { Point } from "./messages";

/** Pixels between what is drawn and the rim. */
const RIM = 8;

export class Picture {
  private figure: Figure;
  private target = shape("path", { class: "target-line" });
  readonly svg: SVGSVGElement;
  private drawn: unknown[] = [];

  constructor(
    private width: number,
    private height: number,
    scale = 0.55,
  ) {
    this.figure = new Figure(scale);
    const viewBox = `0 0 ${width} ${height}`;
    this.svg = shape("svg", { class: "stage", viewBox, width, height, "aria-hidden": "true" });
    this.svg.append(this.target, this.figure.group);
  }

  /** Draws a linkage over its target, unless it is drawn already. */
  show(moving: Moving, points: Point[], closed: boolean, part: number) {
    const now = [moving, points, closed];
    if (now.every((one, i) => one === this.drawn[i])) return;
    this.drawn = now;
    const [left, low, right, high] = moving.box();
    const { width, height } = this;
    const scale = Math.min((width - 2 * RIM) / (right - left || 1), (height - 2 * RIM) / (high - low || 1));
    const toward = ([x, y]: Point): Point => [
      width / 2 + (x - (left + right) / 2) * scale,
      height / 2 - (y - (low + high) / 2) * scale,
    ];
    setAll(this.target, { d: pathThrough(points.map(toward)) + (closed && points.length > 0 ? "Z" : "") });
    this.figure.show(moving, toward);
    this.pose(part);
  }

  pose(part: number) {
    this.figure.pose(part);
  }
}
