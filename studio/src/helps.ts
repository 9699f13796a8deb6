// What stands in the way: changes that help, each a button; and what of a problem file the page does not show.

import { element, figure, minus } from "../../src/report/html/player/svg.mjs";
import { changing } from "./focus";
import { labelOf, unitAfter } from "./labels";
import type { Relaxation, Task, Value } from "./messages";
import { EXACT, type Instead, withoutControls } from "./task";

/** What is counted in degrees, and what in nothing; the rest are lengths. */
const UNITS: Record<string, string> = { transmission_deg_min: "°" };
for (const key of ["type", "link_ratio_max", "time_ratio", "order", "direction", "circuit", "branch", "closing"])
  UNITS[key] = "";

/** The requirements that the page has no control for: only what is kept of a file can state them. */
const UNSHOWN = ["require.extent_max", "require.longest_max"];

/** What is less is no length that anybody has drawn. */
const ROUNDING = 1e-11;

/** A number as it would be typed. */
const plain = (value: number) => minus(String(Number(value.toPrecision(5))));

const words = (value: Value): string => {
  if (typeof value === "number") return plain(value);
  if (typeof value === "string") return value;
  if (value.length === 0) return "any";
  return value
    .map((one) => (Array.isArray(one) ? `${one.map(plain).join(" to ")}` : typeof one === "number" ? plain(one) : one))
    .join(", ");
};

/** A change in plain words: `least transmission angle 18° instead of 45°`. */
function inWords(key: string, from: Value, to: Value, unit: string | undefined): string {
  if (key === "require.input") return "a crank that may rock";
  const after = UNITS[key.replace("require.", "")] ?? unitAfter(unit);
  return `${labelOf(key)} ${words(to)}${after} instead of ${words(from)}${after}`;
}

/** The task with a change made. */
export function changed(task: Task, key: string, to: Value): Task {
  if (key === "task.path.tolerance") return { ...task, tolerance: to as number, tolerances: undefined };
  if (key === "require.type") return { ...task, types: to as Task["types"] };
  if (key.startsWith("require.") && !UNSHOWN.includes(key) && task.kept?.[key] === undefined)
    return { ...task, [key.slice(8)]: to };
  // JSON of numbers, words and lists of them is TOML too.
  return { ...task, kept: { ...task.kept, [key]: JSON.stringify(to) } };
}

export class Helps {
  private told = "";

  constructor(
    private list: HTMLElement,
    private take: (make: (task: Task) => Task, said: string) => void,
  ) {}

  /** `instead`: another task that is offered too. */
  show(relaxations: Relaxation[], unit: string | undefined, instead: Instead) {
    const key = JSON.stringify([relaxations, unit, instead]);
    if (key === this.told) return;
    this.told = key;
    const items = relaxations.map(({ set, rms }) => {
      const what = set.map((change) => inWords(change.key, change.from, change.to, unit)).join(" and ");
      const button = element("button", {}, [what]);
      button.addEventListener("click", () =>
        this.take((task) => set.reduce((next, change) => changed(next, change.key, change.to), task), what),
      );
      return element("li", {}, [
        button,
        element("span", {}, [
          rms < ROUNDING ? "goes exactly through the points" : `gives rms ${figure(rms, 3)}${unitAfter(unit)}`,
        ]),
      ]);
    });
    if (instead) {
      const button = element("button", {}, [instead.button ?? instead.said]);
      button.addEventListener("click", () => this.take(() => instead.task, instead.said));
      items.push(element("li", {}, [button]));
    }
    changing(this.list, () => {
      this.list.hidden = items.length === 0;
      this.list.replaceChildren(...items);
    });
  }
}

/** `best sum of squares 0.00903, 3 published answers; until the target or a requirement changes` */
function knownInWords({ best_known_sum_sq: best, published, exact }: NonNullable<Task["expect"]>["answer"]): string {
  const n = published?.length ?? 0;
  const known = [
    best === undefined ? "" : `best sum of squares ${figure(best, 3)}`,
    n > 0 ? `${n} published ${n === 1 ? "answer" : "answers"}` : "",
    exact ? "how many linkages there are" : "",
  ];
  return `${known.filter((one) => one).join(", ") || "nothing"}; until the target or a requirement changes`;
}

/** What is kept of a problem file though the page has no control for it. */
export class Kept {
  constructor(
    private place: HTMLElement,
    private change: (task: (task: Task) => Task) => void,
  ) {}

  show(task: Task) {
    const all = withoutControls(task.kept);
    if (task.method && task.method !== EXACT && task.method !== "auto") all.push(["solve.method", task.method]);
    if (task.raw) all.push(["smoothing", `${task.raw.points.length} digitised points, until a point is moved`]);
    if (task.expect) all.push(["expect", knownInWords(task.expect.answer)]);
    const list = this.place.querySelector("ul");
    const key = JSON.stringify(all);
    if (!list || list.dataset.key === key) return;
    list.dataset.key = key;
    const items = all.map(([name, value]) => {
      const item = element("li", {}, [element("code", {}, [`${name} = ${value}`])]);
      if (task.kept?.[name] === undefined) return item;
      const drop = element("button", { class: "drop", "aria-label": `Let go ${name}` }, ["×"]);
      drop.addEventListener("click", () =>
        this.change((now) => {
          const { [name]: _, ...kept } = now.kept ?? {};
          return { ...now, kept };
        }),
      );
      item.append(drop);
      return item;
    });
    changing(this.place, () => {
      this.place.hidden = all.length === 0;
      list.replaceChildren(...items);
    });
  }
}
