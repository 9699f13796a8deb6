// The focus stays where work is done when controls come and go.

const CONTROLS = "button:not(:disabled), input:not(:disabled), select:not(:disabled), [tabindex='0']";

const controls = (place: HTMLElement) =>
  [...place.querySelectorAll<HTMLElement>(CONTROLS)].filter((one) => one.getClientRects().length > 0);

/** Changes a part of the page. If that takes the focused control away, the one in its place is focused, or `instead`. */
export function changing(
  place: HTMLElement,
  change: () => void,
  instead = document.querySelector<HTMLElement | SVGElement>("#board svg") ?? place,
) {
  const focused = document.activeElement as HTMLElement | null;
  const at = focused && place.contains(focused) ? controls(place).indexOf(focused) : -1;
  change();
  if (at < 0 || !focused || controls(place).includes(focused)) return;
  const left = controls(place);
  const next = left[Math.min(at, left.length - 1)] ?? instead;
  if (next === instead && next.tabIndex < 0) next.setAttribute("tabindex", "-1");
  next.focus();
}

/** Brings children to these nodes; what stays is not touched. */
export function setChildren(list: HTMLElement, nodes: Element[]) {
  for (const child of [...list.children]) if (!nodes.includes(child)) child.remove();
  nodes.forEach((node, i) => {
    if (list.children[i] !== node) list.insertBefore(node, list.children[i] ?? null);
  });
}
