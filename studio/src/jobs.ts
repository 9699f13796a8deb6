// Long searches: begun here, watched, stopped, taken up again, opened, compared. The list is the folder's.

import { element, figure } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import type { Host } from "./desk";
import { changing, setChildren } from "./focus";
import { byId } from "./ids";
import { unitAfter } from "./labels";
import type { Solution, Task } from "./messages";
import { taskOf } from "./task";
import { longestOf } from "./words";

/** Milliseconds between looks while something runs, and while nothing does. */
const SOON = 700;
const LATER = 10_000;

const STATES: Record<api.JobShown["state"], string> = {
  running: "searching",
  done: "done",
  stopped: "stopped",
  "broken-off": "broken off",
  elsewhere: "in use elsewhere",
  failed: "failed",
  unreadable: "unreadable",
};

/** A time as one says it. */
function time(seconds: number): string {
  if (seconds < 100) return `${Math.ceil(seconds)} s`;
  return seconds < 6000 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

/** A row of the list; it stays the same element while its job changes, so that a focus stays. */
class Row {
  readonly node = element("li", { class: "job" }) as HTMLLIElement;
  readonly chosen = element("input", { type: "checkbox" }) as HTMLInputElement;
  private name = element("b", { class: "job-name" });
  private state = element("span", { class: "job-state" });
  private figures = element("span", { class: "job-figures" });
  private bar = element("progress", { max: 1, value: 0 }) as HTMLProgressElement;
  private said = element("p", { class: "quiet" });
  private buttons: Record<"open" | "stop" | "resume", HTMLButtonElement>;

  constructor(name: string, act: (what: "open" | "stop" | "resume", name: string) => void) {
    const button = (what: "open" | "stop" | "resume", words: string) => {
      const made = element("button", { "aria-label": `${words} ${name}` }, [words]) as HTMLButtonElement;
      made.addEventListener("click", () => made.getAttribute("aria-disabled") !== "true" && act(what, name));
      return made;
    };
    this.buttons = { open: button("open", "Open"), stop: button("stop", "Stop"), resume: button("resume", "Go on") };
    this.name.textContent = name;
    this.chosen.setAttribute("aria-label", `Compare ${name}`);
    this.bar.setAttribute("aria-label", `Part of the budget of ${name}`);
    this.node.append(
      element("div", { class: "row" }, [
        this.chosen,
        this.name,
        this.state,
        this.figures,
        ...Object.values(this.buttons),
      ]),
      this.bar,
      this.said,
    );
  }

  /** What the list says of it, in short; of one that failed why. */
  words(state: api.JobShown["state"]) {
    return (state === "failed" ? this.said : this.figures).textContent ?? "";
  }

  show(job: api.JobShown) {
    const { progress, result } = job;
    this.node.dataset.state = job.state;
    this.state.textContent = STATES[job.state];
    const unit = unitAfter(result?.unit);
    const best = result?.best;
    let figures = best
      ? `rms ${figure(best.rms, 3)}${unit}, ${best.type}, μ ${figure(best.transmission_deg, 3)}°${best.accepted ? "" : ", not accepted"}`
      : "";
    if (result && !best) figures = "nothing found";
    if (progress) {
      const left = progress.left_s === undefined ? "" : `, at most ${time(progress.left_s)} left`;
      const found =
        progress.best_rms === undefined
          ? "nothing yet"
          : `best rms ${figure(progress.best_rms, 3)}${progress.accepted ? "" : " (not acceptable yet)"}`;
      figures = `${found}; ${figure(progress.rate / 1000, 3)} thousand tries a second${left}`;
      this.bar.value = Math.min(progress.evaluations / Math.max(progress.budget, 1), 1);
    }
    this.figures.textContent = figures;
    this.bar.hidden = job.state !== "running";
    this.said.textContent = job.said;
    this.said.hidden = job.state === "running" && job.said === "Searching.";
    const whole = (result?.candidates ?? 0) > 0;
    this.chosen.hidden = !whole;
    if (!whole) this.chosen.checked = false;
    this.buttons.open.hidden = !result;
    this.buttons.stop.hidden = job.state !== "running";
    // Not disabled: it would lose the focus.
    this.buttons.stop.setAttribute("aria-disabled", String(job.said.startsWith("Stopping")));
    this.buttons.resume.hidden = !job.resumable;
  }
}

export class JobsPanel {
  private list = element("ul", { id: "jobs", "aria-label": "Saved searches" });
  private none = element("p", { class: "quiet" });
  private name = element("input", { id: "job-name", maxlength: 64, autocomplete: "off" }) as HTMLInputElement;
  private budget = element("input", {
    id: "job-budget",
    type: "number",
    min: 1000,
    step: 1000,
    placeholder: "as usual",
  }) as HTMLInputElement;
  private replace = element("input", { id: "job-replace", type: "checkbox" }) as HTMLInputElement;
  private comparison = element("div", { id: "comparison" });
  private heading = element("h2", {}, ["Saved searches"]) as HTMLElement;
  private rows = new Map<string, Row>();
  private timer = 0;

  constructor(
    place: HTMLElement,
    private host: Host,
    private details: (name: string, task: Task | null) => void,
  ) {
    const begin = element("button", { id: "job-start" }, ["Search long"]);
    const compare = element("button", { id: "job-compare" }, ["Compare"]);
    const page = element("button", { id: "job-compare-page" }, ["Save the comparison"]);
    const form = element("div", { class: "row job-form" }, [
      element("label", {}, ["Name ", this.name]),
      element("label", {}, ["tries at most ", this.budget]),
      element("label", { class: "check" }, [this.replace, "replace an earlier one"]),
      begin,
    ]);
    const beside = byId("compare");
    const panel = element("details", { class: "desk-card", id: "searches", name: "desk" }) as HTMLDetailsElement;
    panel.append(
      element("summary", {}, [this.heading]),
      element("p", { class: "quiet" }, [
        "A long search of what is drawn now; its result is saved in a folder, as linkwright synth saves it, and goes on when this page is closed.",
      ]),
      form,
      this.none,
      this.list,
      element("div", { class: "row" }, [
        compare,
        page,
        element("span", { class: "quiet" }, ["the ticked ones, the pinned ones and the one on the board"]),
      ]),
      this.comparison,
    );
    place.append(panel);
    beside.addEventListener("click", async () => {
      panel.open = true;
      await this.compare();
      this.comparison.scrollIntoView({ block: "end" });
    });
    begin.addEventListener("click", () => void this.start());
    compare.addEventListener("click", () => void this.compare());
    page.addEventListener("click", () => void this.compareAsPage());
    document.addEventListener("visibilitychange", () => {
      if (!document.hidden) void this.refresh();
    });
  }

  /** Reads the list, and again after a while. */
  async refresh() {
    clearTimeout(this.timer);
    let running = false;
    try {
      const { folder, jobs, more } = await api.jobs();
      running = jobs.some((job) => job.state === "running");
      this.show(jobs);
      this.none.textContent =
        jobs.length === 0
          ? `None yet in the folder ${folder}.`
          : more > 0
            ? `${more} more are in the folder ${folder}.`
            : `In the folder ${folder}.`;
    } catch (error) {
      this.none.textContent = `They cannot be listed: ${api.wordsOf(error)}.`;
    }
    if (!document.hidden)
      this.timer = setTimeout(() => void this.refresh(), running ? SOON : LATER) as unknown as number;
  }

  private show(jobs: api.JobShown[]) {
    changing(this.list, () => this.fill(jobs), this.heading);
    this.suggest();
  }

  private fill(jobs: api.JobShown[]) {
    for (const name of this.rows.keys()) if (!jobs.some((job) => job.name === name)) this.rows.delete(name);
    const nodes = jobs.map((job) => {
      let row = this.rows.get(job.name);
      if (!row) {
        row = new Row(job.name, (what, name) => void this.act(what, name));
        this.rows.set(job.name, row);
      }
      // The end of one that was seen to run is news.
      const ran = row.node.dataset.state === "running" && job.state !== "running";
      changing(row.node, () => row.show(job), this.heading);
      if (ran) this.host.say(`${job.name}: ${STATES[job.state]}. ${row.words(job.state)}`, job.state === "failed");
      return row.node;
    });
    setChildren(this.list, nodes);
  }

  /** The name that a search of what is drawn takes where none is typed. */
  suggest() {
    this.name.placeholder = this.free();
  }

  /** A name that no result has. */
  private free(): string {
    const base = this.host.task().name.slice(0, 58);
    for (let i = 1; ; i += 1) {
      const name = i === 1 ? base : `${base}-${i}`;
      if (!this.rows.has(name)) return name;
    }
  }

  private async start() {
    const name = this.name.value.trim() || this.free();
    const ask = { ...this.host.task(), name };
    try {
      const evaluations = Math.round(this.budget.valueAsNumber);
      const set = evaluations > 0 ? { set: { "solve.evaluations": String(evaluations) } } : {};
      const job = await api.start({ ask, ...set, ...(this.replace.checked ? { replace: true } : {}) });
      this.name.value = "";
      this.replace.checked = false;
      this.host.say(`The search ${job.name} has begun.`);
    } catch (error) {
      this.host.say(`The search cannot begin: ${api.wordsOf(error)}`, true);
    }
    await this.refresh();
  }

  private async act(what: "open" | "stop" | "resume", name: string) {
    try {
      if (what === "stop") await api.cancel(name);
      else if (what === "resume") await api.resume(name);
      else await this.open(name);
    } catch (error) {
      this.host.say(`${name}: ${api.wordsOf(error)}`, true);
    }
    await this.refresh();
  }

  private async open(name: string) {
    const opened = await api.open(name);
    const task = opened.ask ? taskOf({ ...opened.ask, version: 0 }) : null;
    if (task) this.host.take(task);
    else this.host.say(`${name} is shown below; it cannot be drawn anew here: ${opened.why_not ?? ""}`);
    if (opened.candidates.length > 0) this.details(name, task);
  }

  /** What is compared; of what is drawn the names are noted. */
  private compared(named: Map<string, string>): api.Source[] {
    const of = [...this.rows]
      .filter(([, row]) => row.chosen.checked)
      .map(([name]): api.Source => ({ job: { name, rank: 1 } }));
    const [pinned, chosen] = [this.host.pinned(), this.host.chosen()];
    // One that is pinned and on the board too stands there once.
    const key = (one: Solution) => JSON.stringify(api.drawn(one));
    const isPinned = chosen && pinned.some((one) => key(one) === key(chosen));
    const drawn = [...pinned, ...(chosen && !isPinned ? [chosen] : [])];
    // The studio calls them by their numbers in this list.
    drawn.forEach((one, i) => {
      named.set(`drawing ${of.length + i + 1}`, pinned.includes(one) ? `pinned ${i + 1}` : "on the board");
    });
    return [...of, ...drawn.map(api.drawn)];
  }

  private async compare() {
    try {
      const named = new Map<string, string>();
      const { rows, unit, notes } = await api.compared(this.compared(named));
      const own = (text: string) => text.replace(/(drawing \d+)(:\d+)?/g, (whole, name) => named.get(name) ?? whole);
      const cell = (value: number | null, of = "") =>
        element("td", { class: "n" }, [value === null ? "–" : `${figure(value, 4)}${of}`]);
      const head = [
        "linkage",
        `rms${unitAfter(unit)}`,
        "largest",
        "transmission",
        "ratio",
        "extent",
        "longest link",
        "type",
        "accepted",
      ];
      this.comparison.replaceChildren(
        element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Comparison" }, [
          element("table", {}, [
            element("thead", {}, [
              element(
                "tr",
                {},
                head.map((text) => element("th", { scope: "col" }, [text])),
              ),
            ]),
            element(
              "tbody",
              {},
              rows.map((row) =>
                element("tr", {}, [
                  element("th", { scope: "row" }, [`${row.rank}. ${own(row.label).replace(/^.*[/\\]/, "")}`]),
                  cell(row.figures.rms),
                  cell(row.figures.max),
                  cell(row.figures.transmission, "°"),
                  cell(row.figures.link_ratio),
                  cell(row.figures.extent),
                  cell(longestOf(row.linkage as Solution["shown"]["linkage"])),
                  element("td", {}, [row.type]),
                  element("td", { class: row.accepted ? "good" : "bad" }, [row.accepted ? "yes" : "no"]),
                ]),
              ),
            ),
          ]),
        ]),
        ...notes.map((note) => element("p", { class: "quiet" }, [own(note)])),
      );
    } catch (error) {
      this.host.say(`These cannot be compared: ${api.wordsOf(error)}`, true);
    }
  }

  private async compareAsPage() {
    try {
      api.saved(await api.comparedAs(this.compared(new Map()), "html"), "comparison.html");
    } catch (error) {
      this.host.say(`These cannot be compared: ${api.wordsOf(error)}`, true);
    }
  }
}
