// What a screen reader is told, apart from what is seen: of what the hand does at once, of the search when it rests.
// Two regions, so that neither takes the other's word.

import { element } from "../../src/report/html/player/svg.mjs";
import type { Answer } from "./messages";

/** A search that runs for so long is told of before its end, milliseconds. */
const LONG = 2500;

export class Voice {
  private hand = region("spoken");
  private search = region("told");
  private timer: ReturnType<typeof setTimeout> | undefined;
  private version = -1;

  constructor() {
    document.body.append(this.hand, this.search);
  }

  /** Where a point is, what was done or refused. */
  say(text: string) {
    // The same once more is news too.
    this.hand.textContent = this.hand.textContent === text ? `${text}\u00a0` : text;
  }

  /** An answer in words: its end at once, what leads there only where it takes long. */
  answered(answer: Answer, text: string) {
    if (answer.doing === "done") {
      clearTimeout(this.timer);
      this.version = -1;
      if (this.search.textContent !== text) this.search.textContent = text;
    } else if (answer.version !== this.version) {
      clearTimeout(this.timer);
      this.version = answer.version;
      this.timer = setTimeout(() => {
        this.search.textContent = "The search goes on.";
      }, LONG);
    }
  }
}

const region = (id: string) => element("p", { id, class: "heard", role: "status", "aria-live": "polite" });
