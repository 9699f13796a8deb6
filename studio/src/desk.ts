// The desk below the board: everything about the chosen linkage, long searches, sharing. It knows the page by Host alone.

import { DetailsPanel } from "./details";
import { JobsPanel } from "./jobs";
import type { Shown, Task } from "./messages";
import { Share } from "./share";

export interface Host {
  task(): Task;
  /** The linkage that is chosen in the strip. */
  chosen(): Shown | null;
  /** Takes another problem. */
  take(task: Task): void;
  /** Keeps a linkage to compare others with. */
  keep(shown: Shown): void;
  say(text: string): void;
}

export class Desk {
  private details: DetailsPanel;
  private share: Share;

  constructor(place: HTMLElement, sharePlace: HTMLElement, host: Host) {
    this.details = new DetailsPanel(place, host);
    const jobs = new JobsPanel(place, host, (name, rank) => this.details.ofJob(name, rank));
    this.share = new Share(sharePlace, host);
    void jobs.refresh();
  }

  /** Takes what the address holds, if it holds a problem. */
  async begin() {
    await this.share.fromAddress();
  }

  /** Another linkage is chosen, or the same has new figures. */
  changed(settled: boolean) {
    this.details.changed(settled);
  }

  /** A card of the strip was chosen by hand. */
  chose() {
    this.details.ofStrip();
  }
}
