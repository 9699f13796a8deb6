// What a new drawing keeps of what was asked before: told, and let go by one click.

import { element } from "../../src/report/html/player/svg.mjs";
import { changing } from "./focus";
import { NAMES } from "./helps";
import type { Task } from "./messages";

const KEYS: [string, (task: Task) => unknown][] = [
  ["task.path.tolerance", (task) => task.tolerance],
  ["require.type", (task) => task.types.length > 0],
  ["require.transmission_deg_min", (task) => task.transmission_deg_min],
  ["require.link_ratio_max", (task) => task.link_ratio_max],
  ["require.longest_max", (task) => task.kept?.["require.longest_max"]],
  ["require.extent_max", (task) => task.kept?.["require.extent_max"]],
  ["require.pivots_in", (task) => task.pivots_in],
  ["require.footprint_in", (task) => task.footprint_in],
  ["require.direction", (task) => task.direction && task.direction !== "any"],
];

/** What is asked beside the path, by its keys. */
const asked = (task: Task) => KEYS.filter(([, of]) => of(task)).map(([key]) => NAMES[key][0]);

export class Stays {
  private words = element("span");
  private drop = element("button", {}, ["Ask nothing but the path"]);

  constructor(
    private place: HTMLElement,
    drop: () => void,
  ) {
    place.append(this.words, this.drop);
    this.drop.addEventListener("click", drop);
  }

  /** Tells what a new drawing keeps; null: there is no new drawing any more. */
  show(task: Task | null) {
    const names = task ? asked(task) : [];
    changing(
      this.place,
      () => {
        this.place.hidden = names.length === 0;
      },
      document.querySelector<SVGElement>("#board svg") ?? this.place,
    );
    this.words.textContent = `Still asked as before: ${names.join(", ")}. `;
  }
}
