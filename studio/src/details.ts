// Everything about one linkage: the report's player, its charts and its words, and files.

import { element } from "../../src/report/html/player/svg.mjs";
import type { AnglesPlayer } from "./angles";
import * as api from "./api";
import type { Host } from "./desk";
import { changing } from "./focus";
import type { Kit } from "./kit";
import { labelled, nounOf } from "./labels";
import type { Task } from "./messages";

const FORMATS: [string, string, string][] = [
  ["dxf-plates", "dxf", "DXF: plates to cut"],
  ["dxf", "dxf", "DXF: skeleton for CAD, not to cut"],
  ["svg", "svg", "SVG in millimetres"],
  ["svg-plates", "svg", "SVG: plates to cut"],
  ["stl", "stl", "STL: plates to print"],
  ["scad", "scad", "OpenSCAD"],
  ["csv", "csv", "CSV: the whole cycle"],
  ["points", "csv", "CSV: along the points"],
  ["toml", "toml", "Linkage file (TOML)"],
  ["json", "json", "Linkage (JSON)"],
  ["cut-list", "txt", "Cut list"],
  ["sheet", "svg", "Drawing (SVG)"],
  ["html", "html", "Report (HTML)"],
];

export class DetailsPanel {
  private panel = element("details", { class: "desk-card", id: "details", name: "desk" }) as HTMLDetailsElement;
  private title = element("h3", { id: "details-title" });
  private candidates = element("select", { id: "details-candidate", "aria-label": "Candidate" }) as HTMLSelectElement;
  private keep = element("button", { id: "details-pin" }, ["Pin it"]) as HTMLButtonElement;
  private take = element("button", { id: "details-take", hidden: "" }, ["Draw its target"]) as HTMLButtonElement;
  private format = element(
    "select",
    { id: "format", "aria-label": "Format" },
    FORMATS.map(([name, , words]) => element("option", { value: name }, [words])),
  ) as HTMLSelectElement;
  private save = element("button", { id: "export" }, ["Save"]) as HTMLButtonElement;
  private stage = element("div", { class: "details-stage" });
  private charts = element("div", { class: "details-charts" });
  private words = element("div", { class: "details-words" });
  private nothing = element("p", { class: "quiet" });
  private job: { name: string; rank: number } | null = null;
  /** The problem of that result, where a tab can hold it. */
  private jobTask: Task | null = null;
  /** What is shown, where it came from, and what its files are called. */
  private details: api.Details | null = null;
  private of: { source: api.Source; task: Task | null; name: string; title: string } | null = null;
  private player: AnglesPlayer | null = null;
  private shownOf = "";
  private loading = "";
  private timer = 0;

  constructor(
    place: HTMLElement,
    private host: Host,
  ) {
    const head = element("div", { class: "row" }, [this.title, this.candidates, this.keep, this.take]);
    const files = element("div", { class: "row" }, [element("label", {}, ["As a file: ", this.format]), this.save]);
    this.panel.append(
      element("summary", {}, [element("h2", {}, ["All about this linkage"])]),
      this.nothing,
      head,
      files,
      element("div", { class: "details-columns" }, [this.stage, this.charts]),
      this.words,
    );
    place.append(this.panel);
    this.panel.addEventListener("toggle", () => {
      if (this.panel.open) this.changed(true);
      else this.player?.pause();
    });
    this.candidates.addEventListener("change", () => {
      if (this.job) this.ofJob(this.job.name, Number(this.candidates.value), this.jobTask);
    });
    this.keep.addEventListener("click", () => {
      const [shown, task] = [this.details?.shown, this.of?.task];
      if (shown && task) this.host.keep({ shown, task });
    });
    this.take.addEventListener("click", () => this.of?.task && this.host.take(this.of.task));
    this.save.addEventListener("click", () => void this.export());
  }

  /** Shows a candidate of a saved result. */
  ofJob(name: string, rank: number, task: Task | null) {
    this.job = { name, rank };
    this.jobTask = task;
    // One drawer is open at a time: what was clicked is in the other one.
    const isWithin = document.activeElement?.closest("details.desk-card") ?? this.panel;
    this.panel.open = true;
    if (isWithin !== this.panel) this.panel.querySelector("summary")?.focus();
    this.changed(true);
  }

  /** Shows what is chosen in the strip. */
  ofStrip() {
    this.job = null;
    this.changed(true);
  }

  private wanted(): typeof this.of {
    if (this.job) {
      const { name, rank } = this.job;
      return { source: { job: this.job }, task: this.jobTask, name: `${name}-${rank}`, title: `${name}, candidate` };
    }
    const chosen = this.host.chosen();
    const title = `${this.host.name()} of ${chosen?.task.name}`;
    return chosen && { source: api.drawn(chosen), task: chosen.task, name: chosen.task.name, title };
  }

  /** While the hand moves nothing is asked; a moment after it rests, once. */
  changed(settled: boolean) {
    clearTimeout(this.timer);
    if (!this.panel.open || (this.job && this.shownOf === keyOf({ job: this.job }))) return;
    this.tell();
    if (settled) this.timer = setTimeout(() => void this.load(), 150) as unknown as number;
  }

  private async load() {
    const { job } = this;
    const of = this.wanted();
    this.nothing.hidden = of !== null;
    this.nothing.textContent = "None is chosen.";
    if (!of) return;
    const key = keyOf(of.source);
    if (key === this.shownOf) return;
    this.loading = key;
    try {
      // The player comes with the second script.
      const [details, kit] = await Promise.all([api.details(of.source), this.host.kit()]);
      // Another one may have been asked for since.
      if (this.loading !== key || this.job !== job) return;
      this.shownOf = key;
      this.of = of;
      this.show(details, kit);
    } catch (error) {
      if (this.loading !== key || this.job !== job) return;
      this.nothing.hidden = false;
      this.nothing.textContent = `Nothing is known of it: ${api.wordsOf(error)}`;
    }
  }

  /** Says which one is shown: what has changed since is not it. */
  private tell() {
    if (!this.details) return;
    const now = this.wanted();
    const same = now !== null && keyOf(now.source) === this.shownOf;
    const points = this.of?.task?.points;
    changing(
      this.panel,
      () => {
        this.take.hidden = !points || JSON.stringify(points) === JSON.stringify(this.host.task().points);
      },
      this.save,
    );
    // The same one may have another place by now.
    this.title.textContent = same ? now.title : `${this.of?.title}, as it stood`;
  }

  private show(details: api.Details, { player: Player }: Kit) {
    this.details = details;
    const { shown } = details;
    this.tell();
    this.keep.disabled = this.of?.task == null;
    this.candidates.hidden = this.job === null;
    this.candidates.replaceChildren(
      ...Array.from({ length: details.candidates }, (_, i) =>
        element("option", { value: i + 1 }, [`${i + 1} of ${details.candidates}`]),
      ),
    );
    this.candidates.value = String(this.job?.rank ?? 1);
    this.player?.pause();
    this.stage.replaceChildren();
    this.charts.replaceChildren();
    const { points, closed, tolerance } = details;
    this.player = new Player(this.stage, this.charts, {
      unit: details.unit ?? null,
      target: { points, closed, tolerance, noun: nounOf(this.of?.task ?? {}) },
      transmissionMin: details.transmission_deg_min ?? null,
    } as never);
    this.player.show({ key: "", name: "", ...shown });
    this.words.replaceChildren(
      ...marked(details.words, "article > :not(h2)"),
      // Of all that was found, and the best of it: that may be another one.
      element("h3", {}, ["The search and its best linkage"]),
      ...marked(details.summary, "header > p, header > ul"),
    );
    this.panel.dataset.shown = this.shownOf;
  }

  private async export() {
    const { of } = this;
    const format = FORMATS.find(([name]) => name === this.format.value);
    if (!of || !format) return this.host.say("There is no linkage to save.");
    const { name } = of;
    try {
      api.saved(await api.exported(of.source, format[0]), `${name}.${format[1]}`);
      return this.host.say(`Saved as ${name}.${format[1]}.`);
    } catch (error) {
      return this.host.say(`This cannot be saved: ${api.wordsOf(error)}`, true);
    }
  }
}

const keyOf = (of: api.Source) => JSON.stringify("job" in of ? of.job : of);

/** What the report has written: every foreign text in it stands as text, and the page's policy runs no script of it. */
function marked(markup: string, chosen: string): Element[] {
  const page = new DOMParser().parseFromString(markup, "text/html");
  for (const named of page.querySelectorAll("[id]")) named.removeAttribute("id");
  const texts = page.createTreeWalker(page.body, NodeFilter.SHOW_TEXT);
  for (let text = texts.nextNode(); text; text = texts.nextNode())
    if (!text.parentElement?.closest("pre")) text.nodeValue = labelled(text.nodeValue ?? "");
  return [...page.querySelectorAll(chosen)].map((one) => document.adoptNode(one));
}
