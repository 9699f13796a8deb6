// The points as a table to type in: coordinates, and where they are asked for crank angle, tolerance and weight.

import { element } from "../../src/report/html/player/svg.mjs";
import { changing } from "./focus";
import type { Point, Task } from "./messages";
import { withAdded, withMoved, withRemoved } from "./task";

/** Rows at once. */
const PAGE = 40;

type Column = "x" | "y" | "angle_deg" | "crank_deg" | "tolerance" | "tolerance_deg" | "weight";
type Listed = Exclude<Column, "x" | "y">;

const HEADS: Record<Column, [string, string]> = {
  x: ["x", "x"],
  y: ["y", "y"],
  angle_deg: ["angle °", "angle of the body in degrees"],
  crank_deg: ["crank °", "crank angle in degrees"],
  tolerance: ["± error", "largest error"],
  tolerance_deg: ["± angle", "largest error of the angle in degrees"],
  weight: ["weight", "weight"],
};
const OF_PAIRS = ["input", "output"];

/** The list of a column beside the points. */
const listOf = ({ body, timing, tolerances, weights }: Task, column: Listed) =>
  ({
    angle_deg: body?.angle_deg,
    crank_deg: timing?.crank_deg,
    tolerance: tolerances,
    tolerance_deg: body?.tolerances_deg,
    weight: weights,
  })[column];

const columnsOf = (task: Task): Column[] =>
  (Object.keys(HEADS) as Column[]).filter(
    (column) => column === "x" || column === "y" || listOf(task, column) !== undefined,
  );

/** What is in a cell; NaN: nothing, as of the angle of a pose where the place alone counts. */
const valueAt = (task: Task, column: Column, row: number): number =>
  column === "x" || column === "y"
    ? task.points[row][column === "x" ? 0 : 1]
    : (listOf(task, column)?.[row] ?? Number.NaN);

/** The task with one cell changed. */
export function withCell(task: Task, column: Column, row: number, value: number): Task {
  const { timing, body } = task;
  if (column === "x" || column === "y") {
    const axis = column === "x" ? 0 : 1;
    const points = task.points.map((p, i): Point => (i === row ? (axis === 0 ? [value, p[1]] : [p[0], value]) : p));
    return withMoved(task, points);
  }
  // Of an angle that is emptied the place alone counts.
  const put = Number.isNaN(value) ? null : value;
  const list = listOf(task, column)?.map((old, i) => (i === row ? put : old)) as number[];
  switch (column) {
    case "angle_deg":
      return { ...task, body: body && { ...body, angle_deg: list } };
    case "tolerance_deg":
      return { ...task, body: body && { ...body, tolerances_deg: list } };
    case "crank_deg":
      return { ...task, timing: timing && { ...timing, crank_deg: list } };
    case "tolerance":
      return { ...task, tolerances: list };
    case "weight":
      return { ...task, weights: list };
  }
}

export class Table {
  private task: Task | null = null;
  private from = 0;
  private shape = "";
  private inputs: HTMLInputElement[][] = [];
  private head = element("thead");
  private body = element("tbody");
  private earlier = element("button", {}, ["Earlier"]);
  private later = element("button", {}, ["Later"]);
  private add = element("button", {}, ["Add a point"]);
  private pages = element("span", { class: "pages" });
  private label = element("span");

  constructor(
    private place: HTMLElement,
    private edit: (task: Task) => void,
    private say: (text: string) => void,
  ) {
    const table = element("table", { class: "points", "aria-label": "Points" }, [this.head, this.body]);
    this.pages.append(this.earlier, this.label, this.later);
    place.append(table, element("div", { class: "row" }, [this.add, this.pages]));
    this.earlier.addEventListener("click", () => this.turn(-PAGE));
    this.later.addEventListener("click", () => this.turn(PAGE));
    this.add.addEventListener("click", () => this.more());
    place.closest("details")?.addEventListener("toggle", () => this.task && this.show(this.task));
  }

  private turn(by: number) {
    this.from += by;
    if (this.task) this.show(this.task);
  }

  private more() {
    const { task } = this;
    if (!task) return;
    const n = task.points.length;
    const [before, last] = [task.points[n - 2], task.points[n - 1]];
    const at: Point = !last
      ? [0, 0]
      : !before
        ? [last[0] + 10, last[1]]
        : [Number((2 * last[0] - before[0]).toPrecision(6)), Number((2 * last[1] - before[1]).toPrecision(6))];
    this.edit(withAdded(task, n - 1, at));
    this.from = Math.floor(n / PAGE) * PAGE;
    if (this.task) this.show(this.task);
    this.inputs[this.inputs.length - 1]?.[0]?.focus();
  }

  show(task: Task) {
    this.task = task;
    // While a point is dragged nobody fills a table that is not seen.
    if (this.place.closest("details")?.open === false) return;
    const n = task.points.length;
    this.from = Math.max(0, Math.min(this.from, Math.floor(Math.max(n - 1, 0) / PAGE) * PAGE));
    const columns = columnsOf(task);
    const rows = Math.min(PAGE, n - this.from);
    const shape = `${columns.join()} ${this.from} ${rows} ${!task.function}`;
    if (shape !== this.shape) changing(this.body, () => this.build(columns, rows, task), this.add);
    this.shape = shape;
    this.inputs.forEach((cells, i) => {
      cells.forEach((input, j) => {
        const value = valueAt(task, columns[j], this.from + i);
        if (document.activeElement !== input)
          input.value = Number.isFinite(value) ? String(Number(value.toPrecision(9))) : "";
      });
    });
    changing(
      this.pages,
      () => {
        this.pages.hidden = n <= PAGE;
        this.earlier.disabled = this.from === 0;
        this.later.disabled = this.from + PAGE >= n;
      },
      this.add,
    );
    this.label.textContent = `${this.from}–${this.from + rows - 1} of ${n}`;
  }

  private build(columns: Column[], rows: number, task: Task) {
    const heads = columns.map((column, i) =>
      element("th", { scope: "col", title: HEADS[column][1] }, [(task.function && OF_PAIRS[i]) || HEADS[column][0]]),
    );
    this.head.replaceChildren(
      element("tr", {}, [
        element("th", { scope: "col", title: "Points count from 0, as in the reports" }, ["#"]),
        ...heads,
        element("th"),
      ]),
    );
    this.inputs = [];
    this.body.replaceChildren(
      ...Array.from({ length: rows }, (_, i) => {
        const row = this.from + i;
        const cells = columns.map((column) => {
          const input = element("input", {
            type: "number",
            step: "any",
            "aria-label": `Point ${row}, ${HEADS[column][1]}`,
          }) as HTMLInputElement;
          input.addEventListener("change", () => this.take(column, row, input));
          input.addEventListener("keydown", (event: KeyboardEvent) => this.go(event, i, columns.indexOf(column)));
          return input;
        });
        this.inputs.push(cells);
        const drop = element("button", { class: "drop", "aria-label": `Remove point ${row}` }, ["×"]);
        drop.addEventListener("click", () => this.task && this.edit(withRemoved(this.task, row)));
        return element("tr", {}, [
          element("th", { scope: "row" }, [String(row)]),
          ...cells.map((cell) => element("td", {}, [cell])),
          element("td", {}, [drop]),
        ]);
      }),
    );
  }

  private take(column: Column, row: number, input: HTMLInputElement) {
    const value = input.valueAsNumber;
    const wrong =
      column === "angle_deg" && input.value === ""
        ? null
        : !Number.isFinite(value)
          ? "is no number"
          : column === "weight" && value <= 0
            ? "must be above 0"
            : column.startsWith("tolerance") && value < 0
              ? "must be 0 or more"
              : null;
    if (!this.task) return;
    if (wrong) {
      this.say(`Point ${row}: the ${HEADS[column][1]} ${wrong}.`);
      input.value = String(valueAt(this.task, column, row));
      return;
    }
    this.edit(withCell(this.task, column, row, value));
  }

  /** Enter and the arrows up and down go from row to row. */
  private go(event: KeyboardEvent, row: number, column: number) {
    const way = { Enter: 1, ArrowDown: 1, ArrowUp: -1 }[event.key];
    const next = way && this.inputs[row + way]?.[column];
    if (!way || !next) return;
    event.preventDefault();
    next.focus();
    next.select();
  }
}
