// The first minute: three hints, each ticked when it was tried.

export type Hint = "draw" | "drag" | "pin";

export class Guide {
  /** Ticks a hint off. */
  done(hint: Hint) {
    const item = document.querySelector<HTMLElement>(`#hints [data-hint=${hint}]`);
    if (!item || item.classList.contains("done")) return;
    item.classList.add("done");
    item.append(Object.assign(document.createElement("span"), { className: "tick", textContent: " ✓ done" }));
  }
}
