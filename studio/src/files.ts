// Files and texts that are dropped, pasted or chosen: what they are, and how the studio reads them.

import * as api from "./api";
import type { Point, Reading, Task } from "./messages";
import { ofText } from "./target";
import { taskOf, withPoints } from "./task";

/** What the studio's server reads at most. */
const MOST = 200_000;

export type Kind = "csv" | "svg" | "problem";

/** What a text is, by its name and its beginning; null: bare numbers. */
export function kindOf(text: string, name = ""): Kind | null {
  const ending = name.toLowerCase().match(/\.(csv|svg|toml)$/)?.[1];
  if (ending) return ending === "toml" ? "problem" : (ending as Kind);
  const start = text.trimStart().slice(0, 400).toLowerCase();
  if (/^(<\?xml|<!doctype svg|<!--|<svg)/.test(start)) return "svg";
  if (/^\s*(format\s*=|\[task|#[^\n]*\n\s*format\s*=)/m.test(text)) return "problem";
  const line = text.split(/\r?\n/).find((one) => one.trim() !== "" && !one.startsWith("#")) ?? "";
  return /[a-z]/i.test(line.replace(/\d+(\.\d+)?e[+-]?\d+/gi, "")) ? "csv" : null;
}

/** The task of a text, or what is wrong with it. */
export async function taskOfText(
  text: string,
  name: string,
  task: Task,
  samples?: number,
): Promise<{ task: Task; said: string } | string> {
  if (text.length > MOST) return `this is too long: ${MOST} characters at most are read`;
  const kind = kindOf(text, name);
  if (!kind) {
    const points = ofText(text);
    return typeof points === "string"
      ? points
      : { task: withPoints(task, points, task.closed), said: `${points.length} points` };
  }
  let reading: Reading;
  try {
    const drawing = kind === "svg" ? { unit: task.unit, samples: samples || undefined } : {};
    reading = await api.read({ kind, name: name || "pasted", text, ...drawing });
  } catch (error) {
    return api.wordsOf(error);
  }
  const { ask, whole, warnings } = reading;
  const said = [`${ask.points.length} points`, ...warnings].join(". ");
  if (whole) return { task: taskOf(ask), said: `The problem ${ask.name}: ${said}` };
  const { tolerances, weights, timing, unit } = ask;
  const next: Task = {
    ...withPoints({ ...task, timing: undefined }, ask.points as Point[], kind === "svg" ? ask.closed : task.closed),
    weights,
    timing,
    name: ask.name,
    source: undefined,
  };
  if (tolerances) Object.assign(next, { tolerances, tolerance: undefined });
  if (timing) next.method = undefined;
  if (unit) next.unit = unit;
  return { task: next, said };
}

/** Whether what is typed or pasted there is a text of its own. */
export const takesText = (target: EventTarget | null) =>
  (target as Element | null)?.closest?.("textarea, input:not([type=checkbox], [type=range], [type=file])") != null;

/** Watches for files and texts that come from outside; pictures and texts go different ways. */
export function watchFiles(
  board: HTMLElement,
  chooser: HTMLInputElement,
  text: (text: string, name: string) => void,
  picture: (file: Blob) => void,
) {
  const take = async (file: File) => {
    if (/^image\/(?!svg)/.test(file.type)) picture(file);
    else text(file.size > MOST ? " ".repeat(MOST + 1) : await file.text(), file.name);
  };
  const over = (event: DragEvent) => {
    event.preventDefault();
    board.classList.add("receiving");
  };
  document.addEventListener("dragover", over);
  document.addEventListener("dragleave", () => board.classList.remove("receiving"));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    board.classList.remove("receiving");
    const file = event.dataTransfer?.files[0];
    const plain = event.dataTransfer?.getData("text/plain");
    if (file) void take(file);
    else if (plain) text(plain, "");
  });
  document.addEventListener("paste", (event) => {
    if (takesText(event.target)) return;
    const file = event.clipboardData?.files[0];
    const plain = event.clipboardData?.getData("text/plain");
    if (file) void take(file);
    else if (plain?.trim()) text(plain, "");
  });
  chooser.addEventListener("change", () => {
    const file = chooser.files?.[0];
    chooser.value = "";
    if (file) void take(file);
  });
}
