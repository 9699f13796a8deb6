// The chip that says how sure the search is; the figures of the search behind it.

import { element } from "../../src/report/html/player/svg.mjs";
import type { Answer } from "./messages";

const WORDS: Record<NonNullable<Answer["sure"]>, string> = {
  sure: "● sure",
  fairly: "◐ fairly sure",
  not: "○ not sure",
};

export class SureChip {
  private summary = element("summary");
  private figures = element("p");
  private node = element("details", {}, [this.summary, this.figures]);

  constructor(private place: HTMLElement) {
    place.append(this.node);
  }

  /** `said`: how the search went; null: nothing can be said yet. */
  show(sure: NonNullable<Answer["sure"]> | null, said: string) {
    this.place.hidden = sure === null;
    if (sure === null) return;
    this.summary.textContent = `How sure: ${WORDS[sure]}`;
    this.figures.textContent = said;
  }
}
