// The rail beside the board: tabs of which one is seen. Where there is room for two the linkages are always seen, beside
// one of the others.

const TABS = ["linkages", "wishes", "points", "build"] as const;
export type Tab = (typeof TABS)[number];

/** From so wide a page on there is room for two. */
export const WIDE = "(min-width: 1180px)";

export class Tabs {
  private buttons: HTMLButtonElement[];
  private wide = matchMedia(WIDE);
  private now: Tab = "linkages";

  /** `opened` is told which tab is seen. */
  constructor(
    private rail: HTMLElement,
    private opened: (tab: Tab) => void,
  ) {
    this.buttons = TABS.map((tab) => rail.querySelector<HTMLButtonElement>(`#tab-${tab}`) as HTMLButtonElement);
    this.buttons.forEach((button, i) => {
      button.addEventListener("click", () => this.open(TABS[i]));
      button.addEventListener("keydown", (event) => this.key(event));
    });
    const taller = rail.querySelector("#taller") as HTMLElement;
    taller.addEventListener("click", () => {
      const isTall = rail.classList.toggle("tall");
      taller.setAttribute("aria-expanded", String(isTall));
      taller.textContent = isTall ? "▼" : "▲";
    });
    this.wide.addEventListener("change", () => this.open(this.now));
    this.open(this.now);
  }

  open(tab: Tab) {
    this.now = tab;
    const shown = this.wide.matches && tab === "linkages" ? "wishes" : tab;
    this.rail.dataset.tab = shown;
    this.buttons.forEach((button, i) => {
      const isShown = TABS[i] === shown;
      button.setAttribute("aria-selected", String(isShown));
      button.tabIndex = isShown ? 0 : -1;
    });
    this.opened(shown);
  }

  /** The arrow keys go to the tab beside. */
  private key(event: KeyboardEvent) {
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (way === undefined) return;
    const seen = this.buttons.filter((button) => button.offsetParent !== null);
    const next = seen[(seen.indexOf(event.target as HTMLButtonElement) + way + seen.length) % seen.length];
    next.focus();
    next.click();
    event.preventDefault();
  }
}
