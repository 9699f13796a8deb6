// Nine points: how many linkages pass through them, and which of them are shown.

import { element } from "../../src/report/html/player/svg.mjs";
import type { Answer, Counted, Shown } from "./messages";

const LEVELS = ["two circuits", "one circuit", "in order", "free of defects"] as const;

/** What a linkage through nine points can do, from 0 to 3. */
const levelOf = (shown: Shown) =>
  Math.max(LEVELS.indexOf((shown.ability ?? "two circuits") as (typeof LEVELS)[number]), 0);

export class Nine {
  private least = 0;
  private counted: Counted | null = null;
  private words = element("div", { class: "census" });
  private choices = element("div", { class: "row", role: "group", "aria-label": "Which of them are shown" });
  private buttons: HTMLButtonElement[];

  constructor(
    private place: HTMLElement,
    changed: () => void,
  ) {
    this.buttons = LEVELS.map((name, level) => {
      const button = element("button", {}, [name]) as HTMLButtonElement;
      button.addEventListener("click", () => {
        this.least = level;
        this.show();
        changed();
      });
      return button;
    });
    this.choices.append(...this.buttons);
    const summary = element("summary", {}, ["How many there are, and what is proved"]);
    place.append(this.choices, element("details", {}, [summary, this.words]));
  }

  /** Hears an answer: the census is told in words. */
  hear(answer: Answer | null) {
    this.counted = answer?.nine ?? null;
    this.show();
  }

  /** The candidates that are to be shown. */
  filtered(candidates: Shown[]): Shown[] {
    return this.counted && this.least > 0 ? candidates.filter((shown) => levelOf(shown) >= this.least) : candidates;
  }

  private show() {
    const { counted } = this;
    this.place.hidden = !counted;
    if (!counted) return;
    const says: [string, number][] = [
      ["all real", counted.real],
      ["on one circuit", counted.one_circuit],
      ["in order", counted.in_order],
      ["free of defects", counted.free_of_defects],
    ];
    this.buttons.forEach((button, level) => {
      const [what, count] = says[level];
      const text = `${count} ${what}`;
      if (button.textContent !== text) button.textContent = text;
      button.setAttribute("aria-pressed", String(level === this.least));
    });
    const key = counted.said.join("\n");
    if (this.words.dataset.said === key) return;
    this.words.dataset.said = key;
    this.words.replaceChildren(...counted.said.map((sentence) => element("p", {}, [sentence])));
  }
}
