// One word for one thing: what is asked is called everywhere as the control that asks it.

/** By the keys of problem files: the label of the control, and the head of the row in the report's table. */
const LABELS: Record<string, [label: string, row?: string]> = {
  type: ["driven by", "type"],
  input: ["the crank turns fully", "input"],
  stroke: ["stroke of the slider"],
  time_ratio: ["time ratio of the slider's ways"],
  peak_torque_max: ["greatest torque on the crank"],
  longest_max: ["longest link", "longest link, P included"],
  extent_max: ["whole linkage in motion", "diagonal of the motion's box"],
  transmission_deg_min: ["least transmission angle", "worst transmission angle, °"],
  link_ratio_max: ["longest over shortest link", "longest to shortest link"],
  pivots_in: ["both fixed pivots inside a box", "fixed pivots inside"],
  pivot_on: ["a fixed pivot on its line"],
  footprint_in: ["everything inside a box", "motion inside"],
  transmission_over: ["transmission angle judged"],
  direction: ["the crank turns", "direction"],
  order: ["passes the points in their order", "order of the points"],
  circuit: ["is not taken apart on the way", "circuit"],
  branch: ["passes no toggle on the way", "branch"],
  closing: ["comes back to the start of a closed path without reversing", "return to the first point"],
  tolerance: ["largest error at a point", "error at the worst point"],
  tolerance_deg: ["largest error of the angle"],
};
/** A unit as it is written after a length. */
export const unitAfter = (unit: string | null | undefined) => (unit ? ` ${unit}` : "");

/** The unit of a task's errors: those of a function are degrees. */
export const errorUnit = (task: { unit?: string; function?: object }) => (task.function ? "°" : unitAfter(task.unit));

/** What one of a task's targets is called. */
export const nounOf = (task: { body?: object; function?: object }) =>
  task.body ? "pose" : task.function ? "pair" : "point";

const ROWS = new Map(Object.values(LABELS).map(([label, row]) => [row, label]));
const SIDES: Record<string, string> = { xmin: "left", ymin: "bottom", xmax: "right", ymax: "top" };

/** What a key of a problem file or of an answer asks: `pivots_in`, `require.type`, `design.a`. */
export function labelOf(key: string): string {
  const [name] = LABELS[key.replace(/^(require|task\.\w+)\./, "")] ?? [];
  return name ?? key.replace(/^design\.(A|B)[xy]$/, "place of $1").replace(/^design\./, "bounds of ");
}

/** A text of the report or of a refusal with labels in place of keys. */
export function labelled(text: string): string {
  const row = ROWS.get(text);
  if (row) return row;
  // A list of nothing but keys.
  if (text.startsWith("not: ")) return text.replace(/[\w.]+(?=,|$)/g, labelOf);
  return text
    .replace(/`?\b(require\.\w+|task\.\w+\.tolerance|[a-z]+_[a-z_]+)\b`?/g, (all, key) => {
      const label = labelOf(key);
      return label === key ? all : label;
    })
    .replace(/( box)? ([xy]m(in|ax))\b/g, (_, box, side) => `${box ? " box," : ""} ${SIDES[side]}`);
}
