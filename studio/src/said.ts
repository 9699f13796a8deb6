// The status line: what was done, what cannot be, what the search has found.

import type { Voice } from "./voice";

/** Milliseconds that a refusal stays, whatever the search says meanwhile. */
const REFUSAL_STAYS = 4000;

export class Said {
  private heldUntil = 0;
  private waiting: (() => void) | null = null;

  constructor(
    private status: HTMLElement,
    private bar: HTMLProgressElement,
    private voice: Voice,
  ) {
    // What is longer than two lines is seen whole after a tap, until the next.
    status.addEventListener("click", () => status.classList.toggle("whole"));
  }

  /** Says what was done: seen until the next answer, and heard. */
  say(text: string) {
    this.voice.say(text);
    this.show(text);
  }

  /** Says why something is not done: it stays until it can have been read, and is heard. */
  refuse(text: string) {
    this.say(text);
    this.heldUntil = performance.now() + REFUSAL_STAYS;
    setTimeout(() => {
      if (performance.now() < this.heldUntil - 1) return;
      this.waiting?.();
      this.waiting = null;
    }, REFUSAL_STAYS);
  }

  /** Tells how the search stands, once no refusal stands there; the latest counts. */
  tell(text: string, progress?: number) {
    const show = () => this.show(text, progress);
    if (performance.now() >= this.heldUntil) show();
    else this.waiting = show;
  }

  private show(text: string, progress?: number) {
    if (this.status.textContent !== text) this.status.textContent = text;
    this.bar.hidden = progress === undefined;
    this.bar.value = progress ?? 0;
  }
}
