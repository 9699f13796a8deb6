// The controls around the board that act by themselves: buttons, files, keys.

import { takesText, watchFiles } from "./files";
import { changing } from "./focus";
import { byId } from "./ids";

/** What the controls ask of the page. */
export interface Acts {
  back(way: "undo" | "redo"): void;
  clear(): void;
  fit(): void;
  zoom(by: number): void;
  walk(on: boolean): void;
  close(on: boolean): void;
  hideHints(): void;
  saveProblem(): void;
  saveLinkage(): void;
  takeText(text: string, name: string): void;
  takePicture(file: Blob): void;
}

/** Listens to the controls. */
export function listenToControls(acts: Acts) {
  const click = (id: string, act: () => void) => byId(id).addEventListener("click", act);
  const check = (id: string, act: (on: boolean) => void) =>
    byId<HTMLInputElement>(id).addEventListener("change", (event) => act((event.target as HTMLInputElement).checked));
  click("undo", () => acts.back("undo"));
  click("redo", () => acts.back("redo"));
  click("clear", acts.clear);
  click("fit", acts.fit);
  click("nearer", () => acts.zoom(1.25));
  click("farther", () => acts.zoom(0.8));
  click("problem-file", acts.saveProblem);
  click("linkage-file", acts.saveLinkage);
  click("take-coordinates", () => acts.takeText(byId<HTMLTextAreaElement>("coordinates").value, ""));
  click("hide-hints", () => changing(byId("gallery"), acts.hideHints));
  check("walker", acts.walk);
  check("closed", acts.close);
  watchFiles(byId("board"), byId<HTMLInputElement>("file"), acts.takeText, acts.takePicture);
  document.addEventListener("keydown", (event) => {
    if (takesText(event.target) || !(event.ctrlKey || event.metaKey)) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    acts.back(key === "y" || event.shiftKey ? "redo" : "undo");
  });
}
