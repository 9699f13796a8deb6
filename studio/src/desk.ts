// The desk below the board, in drawers: everything about the chosen linkage, long searches, sharing. It knows the page by Host alone.

import { element } from "../../src/report/html/player/svg.mjs";
import { DetailsPanel } from "./details";
import { JobsPanel } from "./jobs";
import type { Kit } from "./kit";
import type { Solution, Task } from "./messages";
import { Share } from "./share";

export interface Host {
  task(): Task;
  /** The linkage that is chosen in the strip. */
  chosen(): Solution | null;
  /** What that one is called. */
  name(): string;
  /** What is pinned, to be compared. */
  pinned(): Solution[];
  /** Takes another problem. */
  take(task: Task): void;
  /** Keeps a linkage to compare others with. */
  keep(one: Solution): void;
  /** The second script. */
  kit(): Promise<Kit>;
  /** Says something that stays until it can have been read; what went wrong stays until it is closed. */
  say(text: string, wrong?: boolean): void;
}

/** Milliseconds that a word stays, and more for each letter. */
const STAYS = 3000;
const A_LETTER = 60;

export class Desk {
  readonly host: Host;
  private details: DetailsPanel;
  private jobs: JobsPanel;
  private share: Share;

  private said = element("p", { id: "desk-said", role: "status", "aria-live": "polite" }) as HTMLParagraphElement;
  private close = element("button", { class: "drop", "aria-label": "Close this message", hidden: "" }, [
    "×",
  ]) as HTMLButtonElement;
  private timer = 0;

  constructor(place: HTMLElement, sharePlace: HTMLElement, page: Omit<Host, "say">) {
    const host: Host = { ...page, say: (text, wrong) => this.say(text, wrong) };
    this.host = host;
    document.body.append(element("div", { id: "desk-message" }, [this.said, this.close]));
    this.close.addEventListener("click", () => this.say(""));
    this.details = new DetailsPanel(place, host);
    this.jobs = new JobsPanel(place, host, (name, task) => this.details.ofJob(name, 1, task));
    this.share = new Share(sharePlace, host);
    place.addEventListener("keydown", (event) => {
      const open = event.key === "Escape" && place.querySelector<HTMLDetailsElement>("details.desk-card[open]");
      if (!open) return;
      open.open = false;
      open.querySelector("summary")?.focus();
    });
    void this.jobs.refresh();
  }

  /** Beside the status, which the next answer of the search replaces. */
  say(text: string, wrong = false) {
    clearTimeout(this.timer);
    this.said.textContent = text;
    this.close.hidden = text === "";
    if (text !== "" && !wrong)
      this.timer = setTimeout(() => this.say(""), STAYS + A_LETTER * text.length) as unknown as number;
  }

  /** Takes what the address holds, if it holds a problem. */
  async begin() {
    await this.share.fromAddress();
  }

  /** Another linkage is chosen, or the same has new figures. */
  changed(settled: boolean) {
    this.details.changed(settled);
    this.jobs.suggest();
  }

  /** A card of the strip was chosen by hand. */
  chose() {
    this.details.ofStrip();
  }
}
