// Curves shown and hidden, rows and curves lit together, tables sorted. The page is complete without it.

const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const curvesOf = (row) => all(`.curve[data-row="${row}"]`);

for (const box of all("input[data-row]")) {
  const show = () => {
    for (const curve of curvesOf(box.dataset.row)) curve.classList.toggle("off", !box.checked);
  };
  box.addEventListener("change", show);
  // A page that is loaded again keeps its boxes as they were.
  show();
}

for (const [id, checked] of [
  ["all", true],
  ["none", false],
]) {
  document.getElementById(id)?.addEventListener("click", () => {
    for (const box of all("input[data-row]")) {
      box.checked = checked;
      box.dispatchEvent(new Event("change"));
    }
  });
}

function light(row) {
  for (const drawing of all(".drawing")) {
    drawing.classList.toggle("some", row !== null && all(`.curve[data-row="${row}"]:not(.off)`, drawing).length > 0);
  }
  for (const lit of all(".curve, tbody tr")) lit.classList.toggle("on", row !== null && lit.dataset.row === row);
}

for (const spot of all("label[data-row], tbody tr[data-row], .curve[data-row]")) {
  spot.addEventListener("pointerenter", () => light(spot.dataset.row));
  spot.addEventListener("pointerleave", () => light(null));
}
for (const box of all("input[data-row]")) {
  box.addEventListener("focus", () => box.matches(":focus-visible") && light(box.dataset.row));
  box.addEventListener("blur", () => light(null));
}

// Numbers by value, words by letters, what is missing last whichever way.
function compareCells(one, other, sign) {
  const [x, y] = [one, other].map((cell) => cell.dataset.value);
  if (x === undefined || y === undefined) {
    return sign * one.textContent.localeCompare(other.textContent, "en", { numeric: true });
  }
  if (x === "" || y === "") {
    return (x === "") - (y === "");
  }
  return sign * (Number(x) - Number(y));
}

for (const table of all("table")) {
  const heads = all("thead th", table);
  heads.forEach((head, column) => {
    if (table.tBodies[0].rows[0]?.cells[column].classList.contains("word")) {
      head.classList.add("word");
    }
    head.querySelector("button").addEventListener("click", () => {
      const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const rows = [...table.tBodies[0].rows];
      rows.sort((one, other) => compareCells(one.cells[column], other.cells[column], sign));
      table.tBodies[0].append(...rows);
    });
  });
}
