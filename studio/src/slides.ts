// Wishes of linkages with a slider, below the kind of linkage: they come with the second script.

import { element } from "../../src/report/html/player/svg.mjs";
import { byId } from "./ids";
import type { Page } from "./kit";
import { labelOf } from "./labels";
import type { LinkageKind, Task } from "./messages";
import { settled } from "./task";

/** The numbers that a slider-crank's slider has to keep: their fields, with the keys that ask for them. */
const NUMBERS = [
  ["slide-stroke", "stroke"],
  ["slide-ratio", "time_ratio"],
] as const;

/** Whether linkages with a slider are searched for. */
export const hasSliders = ({ mechanism }: Task) => (mechanism ?? []).some((kind) => kind !== "four-bar");

/** The keys of a problem file that hold a rail. */
const OF_RAILS = ["design.line_deg", "design.line_point"];

/** What a motor on the crank asks of four-bars. */
const MOTOR: Task["types"] = ["crank-rocker", "double-crank"];

/** The same task for other kinds of linkages: a crank that is to turn fully stays so, and what other kinds have not goes. */
export function ofKinds(task: Task, kinds: LinkageKind[]): Task {
  const { stroke, time_ratio, input: _, kept, ...rest } = task;
  const turns = task.input === "full-turn" || (task.types.length > 0 && task.types.every((one) => MOTOR.includes(one)));
  const mechanism = kinds.join() === "four-bar" ? undefined : kinds;
  const hasRail = kinds.includes("slider-crank");
  const stays = Object.entries(kept ?? {}).filter(([key]) => hasRail || !OF_RAILS.includes(key));
  const next: Task = { ...rest, mechanism, kept: stays.length > 0 ? Object.fromEntries(stays) : undefined };
  if (!hasSliders(next)) return settled({ ...next, types: task.types.length > 0 || !turns ? task.types : MOTOR });
  if (mechanism?.join() === "slider-crank") Object.assign(next, { stroke, time_ratio });
  // They are fitted by least squares alone.
  return { ...next, types: [], input: turns ? "full-turn" : undefined, method: undefined, objective: undefined };
}

export class Slides {
  private full = element("input", { type: "checkbox", id: "slide-full" }) as HTMLInputElement;
  private fields = NUMBERS.map(
    ([id]) => element("input", { type: "number", id, min: "0", step: "any", placeholder: "any" }) as HTMLInputElement,
  );
  private units = NUMBERS.map(() => element("span"));
  private lengths: HTMLElement[];
  private turning: HTMLElement;
  private types = byId("type").closest("label") as HTMLElement;
  private objective = byId("objective").closest("label") as HTMLElement;

  constructor(page: Page) {
    this.full.addEventListener("change", () =>
      page.replace({ ...page.task(), input: this.full.checked ? "full-turn" : undefined }),
    );
    this.lengths = NUMBERS.map(([, key], i) => {
      const field = this.fields[i];
      field.addEventListener("change", () => {
        const { value, valueAsNumber: number } = field;
        if (value !== "" && !Number.isFinite(number)) return;
        page.replace({ ...page.task(), [key]: value === "" ? undefined : [number, number] });
      });
      const text = labelOf(`require.${key}`);
      return element("label", {}, [
        `${text[0].toUpperCase()}${text.slice(1)} `,
        element("span", { class: "field" }, [field, this.units[i]]),
      ]);
    });
    this.units[0].className = "unit";
    this.turning = element("label", { class: "check" }, [this.full, ` ${labelOf("require.input")}`]);
    this.types.after(this.turning, ...this.lengths);
  }

  /** Brings the controls to what the task says. */
  fill(task: Task) {
    const slides = hasSliders(task);
    // Of four-bars a problem file may ask for it.
    this.turning.hidden = !slides && task.input !== "full-turn";
    this.types.hidden = slides && !task.mechanism?.includes("four-bar");
    this.objective.hidden = slides;
    this.full.checked = task.input === "full-turn";
    const isCrank = task.mechanism?.join() === "slider-crank";
    NUMBERS.forEach(([, key], i) => {
      this.lengths[i].hidden = !isCrank;
      if (document.activeElement === this.fields[i]) return;
      const [low, high] = task[key] ?? [];
      this.fields[i].value = low === undefined ? "" : String(low);
      // A range of a problem file is kept until a number is typed.
      this.fields[i].title = low === high ? "" : `from ${low} to ${high}`;
    });
  }
}
