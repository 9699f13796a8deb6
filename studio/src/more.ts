// The second script: motions, functions, wishes of linkages with a slider, the player of the details, and the panel that
// builds.

import { AnglesPlayer } from "./angles";
import * as api from "./api";
import { BuildPanel, joined } from "./build";
import type { Example } from "./examples";
import { Graph } from "./graph";
import type { Kit, Page } from "./kit";
import type { Answer, LinkageKind, Point, Task } from "./messages";
import { centred, Motion } from "./motion";
import { sights } from "./sights";
import { ofKinds, Slides } from "./slides";
import { taskOf } from "./task";

/** The controls that a path alone has, and those that a function has not. */
const OF_PATHS = ["walker", "exact"];
const OF_PLACES = ["kind", "closed", "tolerance", "each-tolerance", "timing", "unit"];

class Second implements Kit {
  panel = BuildPanel;
  player = AnglesPlayer;
  private page!: Page;
  private poses!: Motion;
  private graph!: Graph;
  private slides!: Slides;
  /** Whether the next linkage of a function is to be brought into view. */
  private isNew = false;
  private wasFunction = false;

  join(page: Page) {
    this.page = page;
    joined.page = page;
    document.head.append(
      Object.assign(document.createElement("link"), {
        rel: "stylesheet",
        href: "/more.css",
        onload: () => page.board.redraw(),
      }),
    );
    this.poses = new Motion(page);
    this.slides = new Slides(page);
    this.graph = new Graph(page, async (text) =>
      taskOf((await api.read({ kind: "problem", name: "formula", text })).ask),
    );
    this.fill(page.task());
  }

  motion() {
    this.poses.begin();
  }

  drawn() {
    this.poses.shown();
    this.graph.draw();
  }

  posed(part: number) {
    this.poses.posed(part);
    this.graph.posed(part);
    BuildPanel.shown?.loads.posed(part);
  }

  take(event: PointerEvent) {
    // Of a function nothing is held on the board.
    const { board, task } = this.page;
    return task().function && board.tool === "poses" ? null : this.poses.take(event);
  }

  press(event: KeyboardEvent) {
    return this.poses.press(event);
  }

  fill(task: Task) {
    const isFunction = task.function !== undefined;
    const hide = (id: string, on: boolean) => {
      const label = document.getElementById(id)?.closest("label");
      if (label) label.hidden = on;
    };
    for (const id of OF_PATHS) hide(id, isFunction || task.body !== undefined);
    for (const id of OF_PLACES) hide(id, isFunction);
    // The linkage of a function that begins is brought into view.
    this.isNew ||= isFunction && !this.wasFunction;
    this.wasFunction = isFunction;
    this.poses.fill(task);
    this.graph.fill(task);
    this.slides.fill(task);
  }

  ofKinds(kinds: LinkageKind[]) {
    this.page.replace(ofKinds(this.page.task(), kinds));
  }

  answered(answer: Answer) {
    this.poses.answered(answer.map ?? null);
    const { board } = this.page;
    if (!this.isNew || !this.page.task().function || answer.candidates.length === 0) return;
    this.isNew = answer.doing !== "done";
    requestAnimationFrame(() => board.fit());
  }

  outlined(task: Task, outline: Point[]): Task {
    return { ...task, body: task.body && { ...task.body, outline: [centred(outline)] } };
  }

  example(name: string): Example {
    const task = sights[name];
    this.isNew = task.function !== undefined;
    return { name, task };
  }
}

(globalThis as unknown as { kit: Kit }).kit = new Second();
