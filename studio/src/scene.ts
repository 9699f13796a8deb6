// What moves: the board, the cards and the gallery show the same part of the motion, and the linkage that is meant.

import type { Board } from "./board";
import type { ByHand } from "./byhand";
import { isSame } from "./choice";
import { Clock } from "./clock";
import { type Moving, movingOf } from "./figures";
import type { Gallery } from "./gallery";
import type { Box, Shown, Solution, Task } from "./messages";
import type { Showing } from "./showing";
import type { Strip } from "./strip";
import { isSamePath } from "./task";

/** The parts of the page that a scene moves. */
export interface Parts {
  board: Board;
  strip: Strip;
  gallery: Gallery;
  showing: Showing;
  byHand: ByHand;
  play: HTMLElement;
  turn: HTMLInputElement;
  task(): Task;
}

export class Scene {
  /** What the board and the strip show: the candidates, what is pinned, then what is in the hand. */
  private moving: Moving[] = [];
  /** The linkage that the board has shown last. */
  private onBoard: Shown | null = null;
  private isOdd = false;
  private clock = new Clock((part) => this.pose(part));

  constructor(private parts: Parts) {
    parts.play.addEventListener("click", () => this.play(!this.clock.playing));
    parts.turn.addEventListener("input", () => {
      this.play(false);
      this.clock.set(parts.turn.valueAsNumber);
    });
  }

  get isPlaying(): boolean {
    return this.clock.playing;
  }

  play(on: boolean) {
    this.clock.play(on);
    this.parts.play.textContent = on ? "Pause" : "Play";
  }

  /** Stands still with the crank at an angle, degrees. */
  turn(crankDeg: number) {
    const moving = this.moving[this.place];
    if (!moving) return;
    this.play(false);
    this.clock.set(moving.partOf(crankDeg));
  }

  /** Another target begins: what comes next takes nothing's place. */
  clear() {
    this.onBoard = null;
  }

  /** The place of the linkage on the board among what is shown. */
  private get place(): number {
    return this.parts.byHand.shown ? this.moving.length - 1 : this.parts.showing.place();
  }

  /** The linkage that the board shows: the one in the hand, or the chosen one. */
  chosen(): Solution | null {
    const { byHand, showing, task } = this.parts;
    return byHand.solution() ?? showing.chosen(task());
  }

  /** Its number in the list, for the names of files: one in the hand that was not changed has it too. */
  rank(): string {
    const { byHand, showing } = this.parts;
    if (byHand.isChanged) return "by-hand";
    const [place, found] = [showing.place(), showing.candidates().length];
    return place < found ? String(place + 1) : `pinned-${place - found + 1}`;
  }

  /** What it is called where it is spoken of. */
  name(): string {
    const rank = this.rank();
    return Number(rank) ? `Linkage ${rank}` : rank === "by-hand" ? "your linkage" : rank.replace("pinned-", "Pinned ");
  }

  /** The box of the linkage on the board over its motion. */
  box(): Box | null {
    return (this.moving[this.place]?.box() as Box | undefined) ?? null;
  }

  /** Draws the board, and the cards unless they wait; gives how many cards there are. */
  draw(waiting = false): number {
    const { board, byHand, showing, strip, task } = this.parts;
    const all = showing.all(task());
    const inHand = byHand.solution();
    this.moving = [...all, ...(inHand ? [inHand] : [])].map(({ shown, task }) => movingOf(shown, task.points));
    this.drawBoard();
    if (waiting) return all.length;
    const cards = this.moving.slice(0, all.length);
    const place = inHand ? -1 : showing.place();
    strip.show(cards, all, showing.candidates().length, place, showing.own, task(), board.isWalker);
    strip.pose(this.clock.part);
    return all.length;
  }

  /** The board alone: the target as it stands, the linkage that was last answered. */
  drawBoard() {
    const { board, byHand, showing, task } = this.parts;
    const shown = this.moving[this.place] ?? null;
    const found = showing.candidates().length;
    const pins = showing.pinned.map(({ colour = 0 }, i) => ({ moving: this.moving[found + i], colour }));
    const another = shown !== null && this.onBoard !== null && !isSame(shown.shown, this.onBoard);
    this.onBoard = shown?.shown ?? this.onBoard;
    const now = task();
    const meant = this.chosen()?.task ?? now;
    board.show(
      // The pairs of a function are no places.
      now.function ? { ...now, points: [] } : now,
      shown,
      pins.filter(({ moving }) => moving && moving !== shown),
      meant === now || isSamePath(meant, now),
      another,
    );
    board.offer(byHand.shown ? null : showing.offer());
  }

  private pose(part: number) {
    const { board, strip, gallery, turn } = this.parts;
    board.pose(part);
    if (document.activeElement !== turn) turn.value = part.toFixed(3);
    // The small pictures move in every other picture of the board.
    this.isOdd = !this.isOdd;
    if (this.isOdd && this.clock.playing) return;
    strip.pose(part);
    gallery.pose(part);
  }
}
