// The Build tab until it is opened: then its panel is made.

import type { BuildPanel } from "./build";

export class BuildTab {
  private panel: BuildPanel | null = null;
  private isOpen = false;
  private kept: Record<string, string> = {};

  constructor(private make: () => Promise<BuildPanel>) {}

  /** What stands in the fields. */
  get sizes(): Record<string, string> {
    return this.panel?.sizes ?? this.kept;
  }

  set sizes(sizes: Record<string, string>) {
    this.kept = sizes;
  }

  later() {
    this.panel?.later();
  }

  /** The tab is seen, or no longer. */
  async open(on: boolean) {
    this.isOpen = on;
    if (on && !this.panel) {
      const panel = await this.make();
      // Opened twice meanwhile, it is made once.
      if (!this.panel) panel.sizes = this.kept;
      this.panel ??= panel;
    }
    this.panel?.open(this.isOpen);
  }
}
