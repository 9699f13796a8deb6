// The Build tab: plates of the chosen linkage to cut, live with their sizes; the order of layers and what comes near
// what; everything in one archive.

import { element, shape } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import type { Host } from "./desk";
import type { Page } from "./kit";
import { LoadsPanel } from "./loads";
import { pinnedFor } from "./task";

/** Sizes: the setting of the studio, its label, and what stands in an empty field. */
const SIZES: [string, string, string][] = [
  ["thickness_mm", "Thickness", "¾ of hole"],
  ["hole_mm", "Holes", "4"],
  ["motor_hole_mm", "Motor's shaft at A", "as holes"],
  ["boss_hole_mm", "Frame's hole at A", "as shaft"],
  ["margin_mm", "Material around a hole", "as hole"],
  ["kerf_mm", "Kerf of the tool", "0"],
];
/** Milliseconds after the last change of a size before the plates are drawn anew. */
const REST = 250;

/** The page, once the second script has joined it. */
export const joined: { page: Page | null } = { page: null };

export class BuildPanel {
  /** The one panel of the page. */
  static shown: BuildPanel | null = null;
  /** What turns the linkage. */
  readonly loads: LoadsPanel;
  private fields = new Map<string, HTMLInputElement>();
  private sheet = [0, 1].map(
    (i) =>
      element("input", {
        type: "number",
        min: "1",
        step: "any",
        placeholder: "any",
        "aria-label": i === 0 ? "Width of the sheet" : "Height of the sheet",
      }) as HTMLInputElement,
  );
  private title = element("h2", { id: "plates-of" });
  private plates = element("div", { id: "plates", role: "img", "aria-label": "The plates to cut", hidden: "" });
  private fault = element("p", { class: "fault", role: "alert" });
  private layers = element("pre", { id: "layers", tabindex: "0", "aria-label": "Layers and clearances" });
  private dxf = element("button", { id: "save-dxf" }, ["DXF for a laser"]) as HTMLButtonElement;
  private save = element("button", { id: "save-archive" }, ["Save everything (zip)"]) as HTMLButtonElement;
  private legs = element("p", { class: "note", hidden: "" }, [
    "These are the plates of one leg: cut crank, coupler and follower once for each leg, the ground once.",
  ]);
  /** What is in the file to cut. */
  private cutting = element("p", { class: "note", id: "cutting" });
  private nothing = element("p", { class: "note" }, ["Draw a path first: its linkage is built here."]);
  /** That it was found for something else than what is drawn. */
  private elsewhere = element("p", { class: "note", id: "elsewhere" });
  private timer = 0;
  private isOpen = false;
  private shownOf = "";

  constructor(
    private place: HTMLElement,
    private host: Host,
    /** Its number in the list, for the names of files. */
    private rank: () => string,
    private isWalker: () => boolean,
    /** A size is another one. */
    changed: () => void,
  ) {
    const rows = SIZES.map(([key, label, usual]) => {
      const field = element("input", {
        type: "number",
        min: "0",
        step: "any",
        placeholder: usual,
        id: key,
      }) as HTMLInputElement;
      this.fields.set(key, field);
      return element("label", {}, [
        label,
        " ",
        element("span", { class: "field" }, [field, element("span", {}, ["mm"])]),
      ]);
    });
    for (const field of this.all().values())
      field.addEventListener("input", () => {
        changed();
        this.later();
      });
    this.loads = new LoadsPanel(host, joined.page as Page, () => {
      changed();
      this.later();
    });
    const sheet = element("div", { class: "sheet" }, ["Sheet ", this.sheet[0], " × ", this.sheet[1], " mm"]);
    place.append(
      element("h2", {}, ["Build it"]),
      this.nothing,
      element("div", { class: "sizes" }, rows),
      sheet,
      this.fault,
      this.title,
      this.plates,
      this.legs,
      element("div", { class: "row" }, [this.dxf, this.save, this.elsewhere]),
      this.cutting,
      element("details", { open: "" }, [element("summary", {}, ["Layers and clearances"]), this.layers]),
      this.loads.place,
    );
    BuildPanel.shown = this;
    this.dxf.addEventListener("click", () => void this.file("dxf-plates", "-plates.dxf"));
    this.save.addEventListener("click", () => void this.file("archive", ".zip"));
  }

  /** All fields, by what they are remembered under. */
  private all = () =>
    new Map([...this.fields, ...this.sheet.map((field, i): [string, HTMLInputElement] => [`sheet${i}`, field])]);

  /** What stands in the fields. */
  get sizes(): Record<string, string> {
    return { ...Object.fromEntries([...this.all()].map(([key, { value }]) => [key, value])), ...this.loads.kept };
  }

  set sizes(sizes: Record<string, string>) {
    for (const [key, field] of this.all()) field.value = sizes[key] ?? "";
    this.loads.kept = sizes;
  }

  private set(): Record<string, string> {
    const set: Record<string, string> = {};
    for (const [key, field] of this.fields) if (field.value !== "") set[key] = field.value;
    const [width, height] = this.sheet.map((field) => field.value);
    for (const field of this.sheet) {
      const isMissing = field.value === "" && width + height !== "";
      field.setAttribute("aria-invalid", String(isMissing));
    }
    if (width !== "" && height !== "") set.sheet_mm = `${width}x${height}`;
    return set;
  }

  /** The tab is seen, or no longer. */
  open(on: boolean) {
    this.isOpen = on;
    this.later();
  }

  /** Another linkage is chosen, or another size: what is in sight is made anew when the hand rests. */
  later() {
    clearTimeout(this.timer);
    if (!this.isOpen) return void this.loads.show();
    this.timer = setTimeout(() => {
      void this.show();
      void this.loads.show();
    }, REST) as unknown as number;
  }

  private async show() {
    const chosen = this.host.chosen();
    this.legs.hidden = !chosen || !this.isWalker();
    this.title.textContent = `Plates of ${this.host.name()}`;
    for (const part of [
      this.title,
      this.plates,
      this.dxf,
      this.save,
      this.cutting,
      this.layers.parentElement as HTMLElement,
    ])
      part.hidden = !chosen;
    this.nothing.hidden = chosen !== null;
    const elsewhere = chosen ? pinnedFor(chosen.task, this.host.task()) : "";
    this.elsewhere.textContent = elsewhere && `This linkage is ${elsewhere}: its plates are not of this drawing.`;
    if (!chosen) return;
    const [of, set] = [api.drawn(chosen), this.set()];
    const kerf =
      Number(set.kerf_mm) > 0 ? `The kerf of ${set.kerf_mm} mm is in the DXF already: cut along its lines. ` : "";
    this.cutting.textContent = `${kerf}Red is to cut. The blue layer MARK is to engrave: names of links and holes.`;
    const key = JSON.stringify([of, set]);
    if (key === this.shownOf) return;
    this.shownOf = key;
    try {
      const plates = await api.exported(of, "svg-plates", { set: flat(set) });
      const layers = await api.exported(of, "layers", { set });
      const [picture, text] = await Promise.all([plates.text(), layers.text()]);
      if (this.shownOf !== key) return;
      this.fault.textContent = "";
      this.place.classList.remove("stale");
      const drawing = new DOMParser().parseFromString(picture, "image/svg+xml").documentElement;
      // Its page is the sheet.
      if (set.sheet_mm) drawing.prepend(shape("rect", { width: "100%", height: "100%" }));
      this.plates.replaceChildren(drawing);
      this.layers.textContent = text;
      for (const button of [this.dxf, this.save]) button.disabled = false;
    } catch (error) {
      if (this.shownOf !== key) return;
      this.fault.textContent = `So it cannot be built: ${inLabels(api.wordsOf(error))}`;
      this.place.classList.add("stale");
      for (const button of [this.dxf, this.save]) button.disabled = true;
    }
  }

  /** Saves a format with the sizes that it takes. */
  private async file(format: string, ending: string) {
    const chosen = this.host.chosen();
    if (!chosen) return;
    const name = `${chosen.task.name}-${this.rank()}`.slice(-50);
    const set = this.set();
    const more = format === "archive" ? { set, name } : { set: flat(set) };
    try {
      api.saved(await api.exported(api.drawn(chosen), format, more), `${name}${ending}`);
      this.host.say(`Saved as ${name}${ending}.`);
    } catch (error) {
      this.host.say(`This cannot be saved: ${api.wordsOf(error)}`, true);
    }
  }
}

/** The studio's words with the labels of the fields in place of its keys. */
function inLabels(text: string): string {
  const labels = [...SIZES, ["sheet_mm", "Sheet"], ["gap_mm", "the gap between plates"]];
  return text.replace(/`?(\w+_mm)`?/g, (all, key) => labels.find(([name]) => name === key)?.[1] ?? all);
}

/** The sizes of a drawing of plates, which have no thickness there. */
const flat = ({ thickness_mm: _, ...set }: Record<string, string>) => set;
