// Files and texts that are dropped, pasted or chosen: what they are, and how the studio reads them.

import * as api from "./api";
import { more } from "./kit";
import type { Linkage, Point, Reading, Task } from "./messages";
import { ofText, resampled } from "./target";
import { roundTo, settled, sizeOf, taskOf, withPoints } from "./task";

/** What the studio's server reads at most. */
const MOST = 200_000;

/** The data of a report; the rest of it, which may be long, is not sent. */
const REPORT = /<script type="application\/json" id="data">([^<]*)<\/script>/;
const MOST_OF_A_REPORT = 50_000_000;

export type Kind = "csv" | "svg" | "problem" | "report";

/** What a text is, by its name and its beginning; null: bare numbers. */
export function kindOf(text: string, name = ""): Kind | null {
  const ending = name.toLowerCase().match(/\.(csv|svg|toml|html?)$/)?.[1];
  if (ending) return ending === "toml" ? "problem" : ending.startsWith("htm") ? "report" : (ending as Kind);
  const start = text.trimStart().slice(0, 400).toLowerCase();
  if (/^<!doctype html/.test(start)) return "report";
  if (/^(<\?xml|<!doctype svg|<!--|<svg)/.test(start)) return "svg";
  if (/^\s*(format\s*=|\[task|#[^\n]*\n\s*format\s*=)/m.test(text)) return "problem";
  const line = text.split(/\r?\n/).find((one) => one.trim() !== "" && !one.startsWith("#")) ?? "";
  return /[a-z]/i.test(line.replace(/\d+(\.\d+)?e[+-]?\d+/gi, "")) ? "csv" : null;
}

/** What of a report is read: its problem and the linkage that it shows first. */
function ofReport(text: string): string {
  try {
    const { first, mechanisms, problem } = JSON.parse(text.match(REPORT)?.[1] ?? "");
    const { key, linkage } = mechanisms.find((one: { key: string }) => one.key === first) ?? {};
    return JSON.stringify({ first, mechanisms: linkage ? [{ key, linkage }] : [], problem });
  } catch {
    // The studio says what is wrong with it.
    return "";
  }
}

/** The task of a text, or what is wrong with it. */
export async function taskOfText(
  text: string,
  name: string,
  task: Task,
  samples?: number,
): Promise<{ task: Task; said: string; from?: Linkage } | string> {
  const kind = kindOf(text, name);
  if (kind === "report") text = ofReport(text);
  if (text.length > MOST) return `this is too long: ${MOST} characters at most are read`;
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
  if (whole) return { task: taskOf(ask), from: ask.from, said: `The problem ${ask.name}: ${said}` };
  const { tolerances, weights, timing, unit, body, function: pairs } = ask;
  if (kind === "svg" && task.body && more.kit)
    return { task: more.kit.outlined(task, ask.points as Point[]), said: "the outline of the body" };
  const next: Task = {
    ...withPoints(
      { ...task, timing: undefined, body, function: pairs },
      ask.points,
      kind === "svg" ? ask.closed === true : task.closed,
    ),
    weights,
    timing,
    name: ask.name ?? task.name,
    source: undefined,
  };
  if (tolerances) Object.assign(next, { tolerances, tolerance: undefined });
  if (timing) next.method = undefined;
  if (unit) next.unit = unit;
  return { task: next, said };
}

/** The most points that are searched, and as many as are taken of more. */
const MOST_POINTS = 1000;
const EVENLY = 200;

/** A task with fewer points, evenly along the path, where it has more than can be searched; else null. */
export function evenly(task: Task): Task | null {
  if (task.points.length <= MOST_POINTS) return null;
  const { timing: _t, tolerances: _e, weights: _w, body: _b, ...rest } = task;
  const size = sizeOf(task.points);
  const points = resampled(task.points, EVENLY, task.closed);
  return settled({ ...rest, points: points.map((p) => p.map((x) => roundTo(x, size, 7)) as Point) });
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
    else {
      const most = /\.html?$/i.test(file.name) ? MOST_OF_A_REPORT : MOST;
      text(file.size > most ? " ".repeat(MOST + 1) : await file.text(), file.name);
    }
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
