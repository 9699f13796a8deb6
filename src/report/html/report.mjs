// The report's page: its player, its choice of candidates, its tables.

import { anglesOf, Bodies } from "./player/body.mjs";
import { ErrorChart } from "./player/chart.mjs";
import { LoopsStage } from "./player/loops.mjs";
import { Player } from "./player/player.mjs";
import { element, figure } from "./player/svg.mjs";

const data = JSON.parse(document.getElementById("data").textContent);
const byKey = new Map(data.mechanisms.map((mechanism) => [mechanism.key, mechanism]));
/** @type {HTMLElement[]} */
const articles = [...document.querySelectorAll("article[data-key]")].map((one) => /** @type {HTMLElement} */ (one));
const table = document.querySelector("table.candidates");
const all = (selector, root = document) => [...root.querySelectorAll(selector)];

/** The candidate that a mechanism belongs to: `c2` of `c2a1`; an exact linkage belongs to none. */
const ownerOf = (key) => key.replace(/a\d+$/, "");

function begin() {
  const live = document.getElementById("live");
  document.documentElement.classList.add("live");
  live.hidden = false;
  const charts = document.getElementById("charts");
  const bodies = data.target.angle_deg ? new Bodies(data.target) : null;
  /** @type {ErrorChart | undefined} */
  let turned;
  const player = new Player(document.getElementById("stage"), charts, {
    unit: data.unit,
    target: data.target,
    transmissionMin: data.transmission_deg_min,
    Stage: LoopsStage,
    onPose: (stage, joints) => {
      bodies?.draw(stage, joints);
      turned?.at(stage.q);
    },
  });
  if (bodies) {
    turned = new ErrorChart(charts, {
      title: "Error of the body's angle",
      noun: data.target.noun,
      height: 128,
      unit: "deg",
      onPick: (point) => {
        player.pause();
        if (point.place !== null) player.moveTo(point.place);
      },
    });
    player.errors.figure.after(turned.figure);
  }
  // A function has no points to be near to.
  player.errors.figure.hidden = data.target.points.length === 0;
  const radios = new Map();
  const choices = document.getElementById("choices");
  for (const article of articles) {
    const key = article.dataset.key;
    const radio = element("input", { type: "radio", name: "choice", value: key });
    radio.addEventListener("change", () => choose(key));
    radios.set(key, radio);
    choices.append(element("label", {}, [radio, element("span", {}, [article.dataset.short])]));
  }
  const played = document.getElementById("played");

  /** Shows a mechanism everywhere. @param {string} key */
  function choose(key) {
    const mechanism = byKey.get(key);
    if (!mechanism) return;
    player.show(mechanism);
    const angles = bodies ? anglesOf(player.cycle, data.target) : null;
    if (angles) turned?.show(/** @type {any} */ (angles));
    turned?.at(player.q);
    const owner = ownerOf(key);
    const shown = byKey.has(owner) && radios.has(owner) ? owner : current;
    current = shown;
    for (const article of articles) article.classList.toggle("chosen", article.dataset.key === shown);
    if (radios.has(owner)) radios.get(owner).checked = true;
    for (const row of all("tr[data-key]"))
      row.classList.toggle("chosen", row.dataset.key === key || row.dataset.key === owner);
    for (const button of all("button[data-choose]"))
      button.setAttribute("aria-pressed", String(button.dataset.choose === key));
    played.textContent = key === owner && radios.has(key) ? "" : `Shown now: ${mechanism.name}`;
    showPoints(player.cycle, angles);
  }
  let current = data.first;

  chooseFromTables(choose);
  if (table) makeSortable(table);
  for (const exact of all("table.sortable")) makeSortable(exact);
  for (const article of articles) addCopying(article);
  for (const code of all("#reproduce pre")) code.after(copyButton(() => code.textContent, "Copy"));
  listenToKeys(player, choose);
  for (const name of ["beforeprint", "afterprint"])
    addEventListener(name, () => {
      player.layOut();
      turned?.draw();
    });
  const asked = decodeURIComponent(location.hash.slice(1));
  choose(byKey.has(asked) ? asked : byKey.has(data.first) ? data.first : data.mechanisms[0].key);
}

/** Rows of tables choose what they stand for, by the button in their first cell or by a click anywhere. */
function chooseFromTables(choose) {
  for (const row of all("tr[data-key]")) {
    const { key } = row.dataset;
    if (!byKey.has(key)) continue;
    const cell = row.querySelector("th, td");
    const button = element("button", {
      type: "button",
      class: "choose",
      "data-choose": key,
      "aria-pressed": "false",
      "aria-label": `Show ${byKey.get(key).name}`,
    });
    button.append(...cell.childNodes);
    cell.append(button);
    row.classList.add("choosable");
    row.addEventListener("click", () => {
      choose(key);
      if (!row.closest("#candidates")) document.getElementById("live").scrollIntoView({ block: "nearest" });
    });
  }
}

/** Heads of columns become buttons that sort. */
function makeSortable(sorted) {
  const body = sorted.tBodies[0];
  const heads = all("thead th", sorted);
  heads.forEach((head, column) => {
    const button = element("button", { type: "button", class: "sort" });
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const rising = head.getAttribute("aria-sort") !== "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", rising ? "ascending" : "descending");
      const value = (row) => row.cells[column].dataset.v ?? row.cells[column].textContent;
      const rows = [...body.rows].sort((one, two) => compared(value(one), value(two)));
      body.append(...(rising ? rows : rows.reverse()));
    });
  });
}

/** Numbers by size, before text; text by its letters. */
function compared(one, two) {
  const [x, y] = [Number(one), Number(two)];
  const [isX, isY] = [one !== "" && !Number.isNaN(x), two !== "" && !Number.isNaN(y)];
  if (isX && isY) return x - y;
  return isX === isY ? String(one).localeCompare(String(two)) : isX ? -1 : 1;
}

function addCopying(article) {
  for (const block of all("pre.dimensions", article)) {
    block.before(copyButton(() => block.textContent, "Copy as a linkage file"));
  }
}

/** A button that copies a text and says so. */
function copyButton(text, name) {
  const button = element("button", { type: "button", class: "copy" }, [name]);
  const said = element("span", { class: "said", role: "status" });
  button.addEventListener("click", async () => {
    said.textContent = (await copied(text())) ? "Copied" : "Select the text and copy it by hand";
    setTimeout(() => {
      said.textContent = "";
    }, 2500);
  });
  return element("div", { class: "copying" }, [button, said]);
}

async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = element("textarea", { class: "offstage", "aria-hidden": "true", tabindex: -1 });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
}

/** Space plays; digits choose candidates; nothing that a control needs for itself. */
function listenToKeys(player, choose) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const control = /** @type {Element} */ (event.target).closest?.(
      "button, input, select, textarea, a, summary, [role=slider]",
    );
    const isText = control?.matches("select, input[type=number], textarea");
    if (event.key === " " && (!control || control.matches("[role=slider], input[type=range], input[type=radio]"))) {
      event.preventDefault();
      player.toggle();
    } else if (!isText && /^[1-9]$/.test(event.key) && byKey.has(`c${event.key}`)) {
      choose(`c${event.key}`);
    } else if (!isText && (event.key === "," || event.key === ".")) {
      player.stepPoint(event.key === "." ? 1 : -1);
    }
  });
}

/** The table of points: desired, generated, error; in a motion those of the body's angle too. */
function showPoints(cycle, angles) {
  const place = document.querySelector("#points tbody");
  if (!place) return;
  const cell = (text) => element("td", { class: "n" }, [text]);
  const worst = cycle.worstPoint();
  place.replaceChildren(
    ...cycle.points.map((point, i) => {
      const [x, y] = point.reached ?? [NaN, NaN];
      const row = element("tr", {}, [
        element("th", { scope: "row", class: "n" }, [String(point.number)]),
        ...[point.crankDeg, ...point.target, x, y, point.error].map((value) => cell(figure(value, 6))),
      ]);
      if (angles) {
        const { wanted, reached, error } = angles.points[i];
        row.append(...[wanted ?? NaN, reached, error].map((value) => cell(figure(value, 6))));
      }
      row.classList.toggle("worst", point === worst);
      return row;
    }),
  );
}

if (data.mechanisms.length > 0) begin();
