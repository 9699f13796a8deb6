// The panel of the photograph: chosen, moved, scaled by two clicks and a length, by numbers for who uses keys.

import { figure } from "../../src/report/html/player/svg.mjs";
import type { Board } from "./board";
import { changing } from "./focus";
import { byId, input } from "./ids";
import type { Tool } from "./surface";
import type { Underlay } from "./underlay";

export class PhotographPanel {
  constructor(
    private underlay: Underlay,
    private board: () => Board,
    private use: (tool: Tool) => void,
    private say: (text: string) => void,
    private note: () => void,
  ) {
    input("photo").addEventListener("change", () => {
      const file = input("photo").files?.[0];
      input("photo").value = "";
      if (file) void this.take(file);
    });
    byId("photo-remove").addEventListener("click", () => {
      underlay.remove();
      this.use("draw");
      input("photo").focus();
    });
    // A change by many small steps is one: it begins with the first and ends when the control is let go.
    let begun = false;
    input("photo-opacity").addEventListener("input", () => {
      if (!begun) this.note();
      begun = true;
      underlay.place({ opacity: input("photo-opacity").valueAsNumber });
    });
    input("photo-opacity").addEventListener("change", () => {
      begun = false;
    });
    byId("set-length").addEventListener("click", () => this.setLength());
    input("known-length").addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.setLength();
    });
    for (const [id, put] of [
      ["photo-x", (x: number) => underlay.place({ x })],
      ["photo-y", (y: number) => underlay.place({ y })],
      ["photo-width", (width: number) => underlay.setWidth(width)],
    ] as const) {
      input(id).addEventListener("change", () => {
        if (!Number.isFinite(input(id).valueAsNumber)) return;
        this.note();
        put(input(id).valueAsNumber);
      });
    }
  }

  async take(file: Blob) {
    const wrong = await this.underlay.take(file, this.board().window);
    if (wrong) return this.say(wrong);
    byId<HTMLDetailsElement>("photo-panel").open = true;
    this.use("photo-move");
    return this.say("Drag the photograph to its place; then set its scale by two clicks and a length.");
  }

  /** An end of the known length was clicked. */
  marked() {
    const long = this.underlay.between;
    if (long === null) return this.say("Now click the other end of the length that you know.");
    input("known-length").value = figure(long, 4).replace("−", "-");
    this.show();
    input("known-length").focus();
    input("known-length").select();
    return this.say("Type how long that is.");
  }

  private setLength() {
    const length = input("known-length").valueAsNumber;
    if (!this.underlay.canBe(length)) return this.say("The length must be a number above 0.");
    this.note();
    changing(byId("photo-length"), () => this.underlay.setLength(length), this.board().svg);
    this.use("draw");
    this.board().fit();
    return this.say("The photograph has its scale. Draw over it.");
  }

  show() {
    const { placed } = this.underlay;
    byId("photo-placing").hidden = !placed;
    byId<HTMLButtonElement>("photo-remove").disabled = !placed;
    byId("photo-length").hidden = this.underlay.between === null;
    if (!placed) return;
    const set = (id: string, value: number) => {
      if (document.activeElement !== input(id)) input(id).value = String(Number(value.toPrecision(5)));
    };
    set("photo-opacity", placed.opacity);
    set("photo-x", placed.x);
    set("photo-y", placed.y);
    set("photo-width", this.underlay.width);
  }
}
