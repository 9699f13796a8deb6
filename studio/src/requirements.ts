// Requirements and what stands beside the points, as controls with units and plain words.

import { KINDS } from "./boxes";
import { byId, input } from "./ids";
import { unitAfter } from "./labels";
import type { Box, LinkageKind, Task, Unit } from "./messages";
import { nameFault } from "./names";
import {
  boxOf,
  boxOfSides,
  canBeExact,
  EXACT,
  extentTimes,
  isExact,
  longestTimes,
  pivotsBeside,
  roundTo,
  settled,
  sidesOf,
  sizeOf,
  spaceAround,
  withExtent,
  withLongest,
  withTiming,
  withTolerances,
  withWeights,
} from "./task";

const select = (id: string) => byId<HTMLSelectElement>(id);

/** From so many sizes of the path on a slider of a size stands for any. */
const ANY_SIZE = 10;

/** The sliders of sizes, as multiples of the path. */
const SIZES = [
  { id: "longest", of: longestTimes, set: withLongest, any: "any length", most: "at most" },
  { id: "extent", of: extentTimes, set: withExtent, any: "any size", most: "at most" },
] as const;

const TYPES: Record<string, Task["types"]> = {
  any: [],
  motor: ["crank-rocker", "double-crank"],
  "crank-rocker": ["crank-rocker"],
  "double-crank": ["double-crank"],
  rocking: ["double-rocker", "triple-rocker", "rocker-crank"],
};

const KINDS_OF_LINKAGES: LinkageKind[] = ["four-bar", "slider-crank", "inverted-slider-crank"];
/** The kinds of two values of the choice that stand for several. */
const SEVERAL: Record<string, LinkageKind[]> = {
  all: KINDS_OF_LINKAGES,
  dyads: ["four-bar", "six-bar", "eight-bar"],
};

const SIDES = ["left", "bottom", "right", "top"];
const BOXES = [
  { key: KINDS[0], box: "pivots", numbers: "box-numbers", prefix: "", around: pivotsBeside },
  { key: KINDS[1], box: "space", numbers: "space-numbers", prefix: "space-", around: spaceAround },
] as const;
/** Fields of one number, and what of the task they are. */
const NUMBERS = [
  ["tolerance", "tolerance"],
  ["transmission", "transmission_deg_min"],
  ["ratio", "link_ratio_max"],
] as const;
/** Checked: required, which is the default. */
const CHECKS = [
  ["order", "required"],
  ["circuit", "one"],
  ["branch", "one"],
  ["closing", "one-way"],
] as const;

/** The sides of the box for everything. */
const FITS = ["fit-width", "fit-height"];

const FITS_SAID =
  "Joints and P stay in the box on the board; plates reach past it by half a hole and the material around it. Drag its corners to move it.";

/** What the controls need of the page. */
export interface Asking {
  now(): Task;
  change(task: Task): void;
  /** Other kinds of linkages are asked for. */
  ofKinds(kinds: LinkageKind[]): void;
  /** A box has come: it is brought into view. */
  shown(): void;
  isWalker(): boolean;
  /** The box of the linkage on the board over its motion. */
  standing(): Box | null;
  say(text: string): void;
}

/** Listens to the controls; every change makes another task of the one that stands. */
export function listenToRequirements({ now, change, ofKinds, shown, isWalker, standing, say }: Asking) {
  const on = (id: string, act: () => Task | null) =>
    byId(id).addEventListener("change", () => {
      const task = act();
      if (task) change(task);
    });
  for (const { key, box, prefix, around } of BOXES) {
    byId(box).addEventListener("change", () => {
      change({ ...now(), [key]: input(box).checked ? around(now().points, isWalker()) : undefined });
      if (input(box).checked) shown();
    });
    SIDES.forEach((side, i) => {
      on(prefix + side, () => {
        const next = [...(now()[key] ?? around(now().points))] as Box;
        next[i] = input(prefix + side).valueAsNumber;
        return next.every(Number.isFinite) ? { ...now(), [key]: next } : null;
      });
    });
  }
  for (const id of FITS)
    on(id, () => {
      const task = now();
      const sides = FITS.map((one) => input(one).valueAsNumber);
      const around = task.footprint_in ?? standing() ?? boxOf(task.points);
      // One that is emptied takes the box away; one alone waits for the other.
      if (!(input(id).valueAsNumber > 0) || !around) return { ...task, footprint_in: undefined };
      const missing = sides.findIndex((side) => !(side > 0));
      if (missing >= 0) {
        input(FITS[missing]).setAttribute("aria-invalid", "true");
        return null;
      }
      change({ ...task, footprint_in: boxOfSides(sides, task.points, around) });
      if (!task.footprint_in) shown();
      say(FITS_SAID);
      return null;
    });
  for (const [id, usual] of CHECKS) on(id, () => ({ ...now(), [id]: input(id).checked ? usual : "any" }));
  on("over", () => ({ ...now(), transmission_over: (select("over").value || undefined) as Task["transmission_over"] }));
  on("direction", () => ({ ...now(), direction: select("direction").value as Task["direction"] }));
  on("unit", () => ({ ...now(), unit: (select("unit").value || undefined) as Unit | undefined }));
  on("name", () => {
    const name = input("name").value.trim();
    const fault = nameFault(name);
    // A name that cannot be used is marked, and the problem keeps the one that it has: its search goes on.
    input("name").setAttribute("aria-invalid", String(fault !== null));
    byId("name-fault").textContent = fault === null ? "" : `${fault}. It is still called ${now().name}.`;
    return fault === null ? { ...now(), name } : null;
  });
  on("objective", () => ({ ...now(), objective: select("objective").value as Task["objective"] }));
  on("timing", () => settled(withTiming(now(), select("timing").value as "none")));
  on("each-tolerance", () => withTolerances(now(), input("each-tolerance").checked));
  on("each-weight", () => withWeights(now(), input("each-weight").checked));
  for (const [id, key] of NUMBERS) {
    on(id, () => {
      const { value, valueAsNumber } = input(id);
      if (value !== "" && !Number.isFinite(valueAsNumber)) return null;
      return { ...now(), [key]: value === "" ? undefined : valueAsNumber };
    });
  }
  on("kind", () => {
    const kind = select("kind").value;
    ofKinds(SEVERAL[kind] ?? ([kind] as LinkageKind[]));
    return null;
  });
  on("type", () => ({ ...now(), types: TYPES[select("type").value] ?? now().types }));
  for (const size of SIZES) {
    const slider = input(size.id);
    const times = () => (slider.valueAsNumber >= ANY_SIZE ? null : slider.valueAsNumber);
    slider.addEventListener("input", () => tellSize(size, times(), now()));
    on(size.id, () => size.set(now(), times()));
  }
  on("exact", () => ({ ...now(), method: input("exact").checked ? EXACT : undefined }));
}

function tellSize({ id, any, most }: (typeof SIZES)[number], times: number | null, { points, unit }: Task) {
  const length = Number(((times ?? 0) * sizeOf(points)).toPrecision(3));
  const text =
    times === null
      ? any
      : `${most} ${Number(times.toPrecision(3))} × the path${points.length > 1 ? ` (${length}${unitAfter(unit)})` : ""}`;
  byId(`${id}-said`).textContent = text;
  input(id).setAttribute("aria-valuetext", text);
}

/** Brings the controls to what the task says. */
export function fillRequirements(task: Task) {
  const set = (id: string, value: number | undefined) => {
    if (document.activeElement !== input(id)) input(id).value = value === undefined ? "" : String(value);
  };
  for (const { key, box, numbers, prefix } of BOXES) {
    input(box).checked = task[key] !== undefined;
    byId(numbers).hidden = task[key] === undefined;
    SIDES.forEach((side, i) => {
      // Shown to four digits of its size; what is not typed over keeps all that it has.
      const one = task[key];
      set(prefix + side, one && roundTo(one[i], Math.hypot(one[2] - one[0], one[3] - one[1]) || 1, 4));
    });
  }
  FITS.forEach((id, i) => {
    const side = task.footprint_in && sidesOf(task.footprint_in)[i];
    set(id, side && roundTo(side, side, 4));
    input(id).setAttribute("aria-invalid", "false");
  });
  for (const [id, usual] of CHECKS) input(id).checked = (task[id] ?? usual) === usual;
  select("over").value = task.transmission_over ?? "";
  select("direction").value = task.direction ?? "any";
  select("unit").value = task.unit ?? "";
  if (document.activeElement !== input("name")) input("name").value = task.name;
  select("objective").value = task.objective ?? "sum-of-squares";
  select("timing").value = task.timing?.offset ?? "none";
  for (const [id, key] of NUMBERS) set(id, task[key]);
  const key = Object.keys(TYPES).find((name) => TYPES[name].join() === task.types.join());
  const kinds = task.mechanism ?? ["four-bar"];
  const several = Object.keys(SEVERAL).find((name) => SEVERAL[name].join() === kinds.join());
  const kind = kinds.length > 1 ? (several ?? "as-given") : kinds[0];
  select("kind").value = kind;
  byId("kinds-given").hidden = kind !== "as-given";
  select("type").value = key ?? "as-given";
  byId("as-given").hidden = key !== undefined;
  for (const size of SIZES) {
    const times = size.of(task);
    set(size.id, times ?? ANY_SIZE);
    tellSize(size, times, task);
  }
  input("tolerance").disabled = task.tolerances !== undefined;
  input("tolerance").placeholder = task.tolerances ? "in the table of points" : "any";
  input("each-tolerance").checked = task.tolerances !== undefined;
  input("each-weight").checked = task.weights !== undefined;
  input("exact").checked = isExact(task);
  input("exact").disabled = !canBeExact(task) && !isExact(task);
  input("exact").title = canBeExact(task)
    ? ""
    : "Needs nine points (eight of a slider), or five poses; a place alone counts half one, a given pivot two points";
}
