// The clock of everything that moves on the page: a turn in some seconds, 30 pictures a second, none while it is stopped
// or the page is not seen.

/** Seconds of a turn. */
const TURN = 5;
/** Milliseconds between two pictures; a little less, as the browser's frames come when they come. */
const BETWEEN = 1000 / 30 - 4;

export class Clock {
  /** The part of the motion that is shown, 0 to 1. */
  part = 0;
  private going = false;
  private last = 0;
  /** Whether the page is not seen. */
  private waiting = false;

  /** `tick` shows a part of the motion. */
  constructor(private tick: (part: number) => void) {
    document.addEventListener("visibilitychange", () => {
      if (this.waiting && !document.hidden) this.frame(performance.now());
    });
  }

  get playing() {
    return this.going;
  }

  play(on: boolean) {
    if (on === this.going) return;
    this.going = on;
    if (!on) return;
    this.last = performance.now();
    requestAnimationFrame((now) => this.frame(now));
  }

  /** Shows another part of the motion. */
  set(part: number) {
    this.part = ((part % 1) + 1) % 1;
    this.tick(this.part);
  }

  private frame(now: number) {
    if (!this.going) return;
    // Nothing is asked of the browser until the page is seen again.
    this.waiting = document.hidden;
    if (this.waiting) return;
    if (now - this.last >= BETWEEN) {
      // After a pause of the browser it goes on from where it was.
      this.set(this.part + Math.min(now - this.last, 100) / 1000 / TURN);
      this.last = now;
    }
    requestAnimationFrame((now) => this.frame(now));
  }
}
