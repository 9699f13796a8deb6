// How fast the studio answers, measured where it is seen. `performance.getEntriesByType("measure")` tells: "first
// candidate" from the pen's going up until the linkages are painted, "re-fit" between two painted answers to a moving hand.

import type { Answer } from "./messages";

/** Answers farther apart belong to two movements, milliseconds. */
const APART = 500;

export class Pace {
  private up = -1;
  private last = -1;

  penUp() {
    this.up = performance.now();
  }

  answered(answer: Answer, version: number) {
    const first = this.up >= 0 && answer.candidates.length > 0 && answer.version === version ? this.up : -1;
    if (first >= 0) this.up = -1;
    const following = answer.doing === "following";
    if (first < 0 && !following) return;
    // After the frame that shows it.
    requestAnimationFrame(() =>
      setTimeout(() => {
        const now = performance.now();
        if (first >= 0) performance.measure("first candidate", { start: first, end: now });
        if (!following) return;
        if (this.last >= 0 && now - this.last < APART) performance.measure("re-fit", { start: this.last, end: now });
        this.last = now;
      }),
    );
  }
}
