// The tools of the board: what a pointer that goes down holds, and what comes of it.

import { type BoxKind, between, LEAST, resized } from "./boxes";
import type { Joint } from "./grab";
import { more } from "./kit";
import type { Point } from "./messages";
import { dragging, type Grip } from "./pointers";
import type { Hand, Surface } from "./surface";
import { ofStroke, segmentAt } from "./target";
import type { Underlay } from "./underlay";
import * as view from "./view";

/** A click so near to the path, in pixels, is meant for it. */
const NEAR = 9;

export class Tools {
  constructor(
    private on: Surface,
    private hand: Hand,
    private say: (text: string) => void,
    private underlay: Underlay,
  ) {}

  /** What a pointer that goes down here holds. */
  take(event: PointerEvent): Grip | null {
    const target = event.target as Element;
    const [point, corner, rim, joint] = ["point", "corner", "rim", "joint"].map((name) =>
      target.getAttribute(`data-${name}`),
    );
    this.on.svg.focus({ preventScroll: true });
    if (!this.on.task) return null;
    const overviewed = target.closest(".overview") && this.on.onMap(event);
    if (overviewed) {
      this.on.look({ ...this.on.looking, x: overviewed[0], y: overviewed[1] });
      return null;
    }
    if (event.shiftKey) return this.pan(event);
    if (this.on.tool === "grab") return joint ? this.grab(joint, event) : this.pan(event);
    const grip = more.kit?.take(event);
    if (grip !== undefined) return grip;
    if (this.on.tool === "photo-move" && this.underlay.there) return this.moveUnderlay(event);
    if (this.on.tool === "photo-scale" && this.underlay.there) {
      this.underlay.mark(this.on.at(event));
      this.hand.marked();
      return null;
    }
    if (this.on.tool === "pivots_in" || this.on.tool === "footprint_in")
      return this.sketchBox(this.on.tool, this.on.at(event));
    if (corner) return this.resize(corner, event);
    if (rim !== null) return this.widen(Number(rim), event);
    if (point !== null) return this.carry(this.nearest(event), event);
    return this.on.tool === "points" ? this.addPoint(event) : this.pen(event);
  }

  /** A joint that is carried, or the crank that is turned. */
  private grab(name: string, start: PointerEvent): Grip | null {
    const pose = this.on.standing;
    if (!pose) return null;
    const [from, { A }] = [this.on.at(start), pose];
    if (name === "turn") {
      const step = (event: PointerEvent) => {
        const [x, y] = this.on.at(event);
        this.hand.turn((Math.atan2(y - A[1], x - A[0]) * 180) / Math.PI);
      };
      return { step, abort: () => {} };
    }
    const held = pose[name as Joint];
    return this.changing(start, (event) => {
      const now = this.on.at(event);
      this.hand.joint(pose, name as Joint, [held[0] + now[0] - from[0], held[1] + now[1] - from[1]]);
    });
  }

  /** A grip that changes something from the first real movement on; what it had changed can be given up. */
  private changing(start: PointerEvent, step: Grip["step"]): Grip {
    return dragging(
      start,
      () => this.hand.grasp(),
      step,
      () => this.hand.letGo(),
    );
  }

  private pan(start: PointerEvent): Grip {
    const held = this.on.at(start);
    const step = (event: PointerEvent) => this.on.look(view.carried(this.on.looking, held, this.on.at(event)));
    return { step, abort: () => {} };
  }

  /** Two fingers hold two points of the plane. */
  pinch(one: PointerEvent, other: PointerEvent) {
    const [p, q] = [this.on.at(one), this.on.at(other)];
    const apart = Math.max(Math.hypot(q[0] - p[0], q[1] - p[1]), 1e-9);
    return (one: PointerEvent, other: PointerEvent) => {
      const now = [this.on.at(one), this.on.at(other)];
      this.on.zoom(Math.hypot(now[1][0] - now[0][0], now[1][1] - now[0][1]) / apart);
      const [a, b] = [this.on.at(one), this.on.at(other)];
      const middle = (one: Point, other: Point): Point => [(one[0] + other[0]) / 2, (one[1] + other[1]) / 2];
      this.on.look(view.carried(this.on.looking, middle(p, q), middle(a, b)));
    };
  }

  /** The point nearest to a pointer among those by which the path is held: their handles overlap. */
  private nearest(event: PointerEvent): number {
    const [x, y] = this.on.at(event);
    const points = this.on.task?.points ?? [];
    const far = (i: number) => Math.hypot(points[i][0] - x, points[i][1] - y);
    return this.on.held.reduce((best, i) => (far(i) < far(best) ? i : best));
  }

  private carry(index: number, start: PointerEvent, begin = () => this.hand.grasp()): Grip {
    const from = this.on.at(start);
    this.select(index);
    const held = this.on.task?.points[index] ?? from;
    return dragging(
      start,
      begin,
      (event, last) => {
        const now = this.on.at(event);
        this.hand.drag(index, [held[0] + now[0] - from[0], held[1] + now[1] - from[1]], last);
      },
      () => this.hand.letGo(),
    );
  }

  /** A point is added where the path is clicked, or behind its last point; it can be carried on at once. */
  private addPoint(start: PointerEvent): Grip {
    const [at, points] = [this.on.at(start), this.on.task?.points ?? []];
    const after =
      segmentAt(points, at, this.on.task?.closed === true, NEAR / this.on.looking.scale) ?? points.length - 1;
    this.hand.add(at, after);
    const { step } = this.carry(after + 1, start, () => {});
    return { step, abort: () => this.hand.letGo() };
  }

  private resize(name: string, start: PointerEvent): Grip {
    const [kind, corner] = name.split(":") as [BoxKind, string];
    this.on.corner = { kind, corner: Number(corner) };
    this.on.redraw();
    return this.changing(start, (event, last) => {
      const box = this.on.task?.[kind];
      if (box)
        this.hand.box(kind, resized(box, Number(corner), this.on.at(event), LEAST / this.on.looking.scale), last);
    });
  }

  private sketchBox(kind: BoxKind, from: Point): Grip {
    const step = (event: PointerEvent, last: boolean) => {
      const box = between(from, this.on.at(event), LEAST / this.on.looking.scale);
      this.on.drawSketch(last ? null : box);
      if (!last) return;
      if (box) {
        this.hand.grasp();
        this.hand.box(kind, box, true);
      } else this.say("Drag from one corner of the box to the opposite one.");
    };
    return { step, abort: () => this.on.drawSketch(null) };
  }

  private widen(index: number, start: PointerEvent): Grip {
    this.select(index);
    return this.changing(start, (event, last) => {
      const [centre, now] = [this.on.task?.points[index] ?? [0, 0], this.on.at(event)];
      this.hand.tolerance(index, Math.hypot(now[0] - centre[0], now[1] - centre[1]), last);
    });
  }

  private moveUnderlay(start: PointerEvent): Grip {
    const [from, placed] = [this.on.at(start), this.underlay.placed];
    return this.changing(start, (event, last) => {
      const now = this.on.at(event);
      if (placed) this.underlay.place({ x: placed.x + now[0] - from[0], y: placed.y + now[1] - from[1] }, last);
    });
  }

  private pen(start: PointerEvent): Grip {
    const line: Point[] = [this.on.at(start)];
    const step = (event: PointerEvent, last: boolean) => {
      const more = event.getCoalescedEvents?.() ?? [];
      for (const one of more.length > 0 ? more : [event]) line.push(this.on.at(one));
      this.on.drawStroke(last ? [] : line);
      if (!last) return;
      const target = ofStroke(line, 40 / this.on.looking.scale);
      if (target) this.hand.drawn(target.points, target.closed);
    };
    return { step, abort: () => this.on.drawStroke([]) };
  }

  private select(index: number) {
    this.on.selected = index;
    this.on.redraw();
  }
}
