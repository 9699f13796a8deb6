// What a new drawing keeps of what was asked before: told, and let go by one click.

import { element } from "../../src/report/html/player/svg.mjs";
import { changing } from "./focus";
import { labelOf } from "./labels";
import type { Task } from "./messages";

const KEYS: [string, (task: Task) => unknown][] = [
  ["tolerance", (task) => task.tolerance],
  ["type", (task) => task.types.length > 0],
  ["input", (task) => task.input === "full-turn"],
  ["stroke", (task) => task.stroke],
  ["time_ratio", (task) => task.time_ratio],
  ["transmission_deg_min", (task) => task.transmission_deg_min],
  ["link_ratio_max", (task) => task.link_ratio_max],
  ["longest_max", (task) => task.kept?.["require.longest_max"]],
  ["extent_max", (task) => task.kept?.["require.extent_max"]],
  ["pivots_in", (task) => task.pivots_in],
  ["footprint_in", (task) => task.footprint_in],
  ["direction", (task) => task.direction && task.direction !== "any"],
];

/** What is asked beside the path, as its controls are called. */
export const namesOfAsked = (task: Task) => KEYS.filter(([, of]) => of(task)).map(([key]) => labelOf(key));

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
    const names = task ? namesOfAsked(task) : [];
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
