// What the tools and the keys need of the board, and what they tell the page.

import type { BoxKind, Corner } from "./boxes";
import type { Joint, Pose } from "./grab";
import type { Box, Point, Task } from "./messages";
import type { View } from "./view";

export type Tool = "draw" | "grab" | "points" | "poses" | "body" | BoxKind | "photo-move" | "photo-scale";

export interface Hand {
  /** A new target was drawn. */
  drawn(points: Point[], closed: boolean): void;
  /** A point is about to be moved, or the box. */
  grasp(): void;
  /** What was done since then is given up. */
  letGo(): void;
  /** A point is being moved. */
  drag(index: number, to: Point, last: boolean): void;
  /** A point is added after another. */
  add(at: Point, after: number): void;
  remove(index: number): void;
  /** A box of the requirements is drawn, or a corner of it moves; null removes it. */
  box(kind: BoxKind, box: Box | null, last: boolean): void;
  /** The circle of a tolerance is made larger or smaller. */
  tolerance(index: number, radius: number, last: boolean): void;
  /** A joint of the linkage is being moved, from a pose. */
  joint(pose: Pose, joint: Joint, to: Point): void;
  /** The crank is being turned to an angle, degrees. */
  turn(crankDeg: number): void;
  /** The photograph was clicked at an end of a known length. */
  marked(): void;
  /** The view has changed. */
  looked(): void;
  /** Corners of boxes and their words, and the linkage lie at these pixels of the board. */
  drawnAt(marks: Point[], links: Point[]): void;
  /** The closer linkage that is offered is wanted. */
  takeCloser(): void;
}

/** The board as tools and keys see it. */
export interface Surface {
  readonly svg: SVGElement;
  readonly task: Task | null;
  readonly tool: Tool;
  /** The view, which only the user changes. */
  readonly looking: View;
  /** The chosen point; -1: none. */
  selected: number;
  /** The chosen corner of a box. */
  corner: Corner | null;
  /** Where the joints stand now. */
  readonly standing: Pose | null;
  /** The numbers of the points that have handles. */
  readonly held: number[];
  /** The point of the plane under a pointer. */
  at(event: { clientX: number; clientY: number }): Point;
  toPixel(p: Point): Point;
  /** The point of the plane that the small map shows under a pointer; null outside the map. */
  onMap(event: PointerEvent): Point | null;
  look(at: View): void;
  zoom(by: number): void;
  redraw(): void;
  /** Draws the line of a stroke. */
  drawStroke(line: Point[]): void;
  /** Draws a box that is being sketched; null: none. */
  drawSketch(box: Box | null): void;
}
