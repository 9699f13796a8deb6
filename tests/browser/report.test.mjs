// The report in headless Chromium, opened from disk: it plays, sorts, is dragged, switches candidates, says no error.
//
// Pages come from `cargo test --test tool pages_for` in the folder PAGES; see .ci/check-report.

import assert from "node:assert/strict";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const pages = resolve(process.env.PAGES ?? "pages");
const shots = process.env.SCREENSHOTS;
let browser;

before(async () => {
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
});
after(() => browser?.close());

/** Opens a page from disk and watches it: messages of the console, errors, dialogs, requests. */
async function opened(name, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  const said = [];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  page.on("dialog", (dialog) => {
    said.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => {
    if (!request.url().startsWith("file:") || !request.url().includes(`/${name}.html`))
      said.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(join(pages, `${name}.html`)).href);
  return { page, said, done: () => context.close() };
}

const slider = (page) => page.locator("input.scrub");
const placeOf = async (page) => Number(await slider(page).inputValue());

test("every page opens without a message, a request, a dialog or a sideways scroll", async () => {
  const names = readdirSync(pages)
    .filter((file) => file.endsWith(".html"))
    .map((file) => file.slice(0, -5));
  assert.ok(names.length >= 8, `pages in ${pages}: ${names}`);
  for (const name of names) {
    for (const width of [1280, 390]) {
      const { page, said, done } = await opened(name, { viewport: { width, height: 844 } });
      await page.waitForTimeout(100);
      assert.deepEqual(said, [], name);
      const over = await page.evaluate(
        () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
      );
      assert.ok(over <= 0, `${name} is ${over} px wider than ${width}`);
      await done();
    }
  }
});

test("it plays and pauses, by the button and by the space bar, and everything moves together", async () => {
  const { page, said, done } = await opened("five");
  const bars = page.locator("path.bar").first();
  const [q, d] = [await placeOf(page), await bars.getAttribute("d")];
  const cursor = page.locator("path.cursor").first();
  const cursorAt = await cursor.getAttribute("d");
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForTimeout(400);
  await page.getByRole("button", { name: "Pause" }).click();
  const moved = await placeOf(page);
  assert.notEqual(moved, q);
  assert.notEqual(await bars.getAttribute("d"), d);
  assert.notEqual(await cursor.getAttribute("d"), cursorAt);
  await page.waitForTimeout(150);
  assert.equal(await placeOf(page), moved, "it stands when paused");
  await page.locator("h1").click();
  await page.keyboard.press("Space");
  await page.waitForTimeout(300);
  await page.keyboard.press("Space");
  assert.notEqual(await placeOf(page), moved);
  assert.deepEqual(said, []);
  await done();
});

test("speed changes how far it goes", async () => {
  const { page, done } = await opened("five");
  const gone = async (speed) => {
    await page.getByLabel("Speed").selectOption(speed);
    const from = await placeOf(page);
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForTimeout(500);
    await page.getByRole("button", { name: "Pause" }).click();
    return ((await placeOf(page)) - from + 720) % 360;
  };
  const [slow, fast] = [await gone("0.1"), await gone("2")];
  assert.ok(fast > 4 * slow, `${fast} beside ${slow}`);
  await done();
});

test("the slider scrubs, the chart is picked, the crank is dragged by hand and by keys", async () => {
  const { page, said, done } = await opened("five");
  await slider(page).fill("90");
  const grip = page.locator(".grip");
  assert.equal(Math.round(Number(await grip.getAttribute("aria-valuenow"))), 90);
  // The slider was brought into view; the drawing stands higher up.
  await page.evaluate(() => scrollTo(0, document.querySelector("#stage").getBoundingClientRect().top + scrollY - 20));
  const at = async () => {
    const box = await grip.boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  // From straight up the pin goes a quarter turn to the left around A.
  const pinA = await page.locator("circle.pin").first().boundingBox();
  const [ax, ay] = [pinA.x + pinA.width / 2, pinA.y + pinA.height / 2];
  const [cx, cy] = await at();
  assert.ok(Math.abs(cx - ax) < 1.5 && cy < ay - 20, "C stands over A");
  await page.mouse.move(cx, cy);
  await page.mouse.down();
  await page.mouse.move(ax - 60, ay - 60, { steps: 4 });
  await page.mouse.move(ax - 80, ay, { steps: 4 });
  await page.mouse.up();
  assert.ok(Math.abs((await placeOf(page)) - 180) < 1.5, String(await placeOf(page)));
  await grip.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("PageUp");
  assert.ok(Math.abs((await placeOf(page)) - 191) < 2);
  const chart = await page.locator("svg.chart[role=img]").nth(1).boundingBox();
  await page.mouse.click(chart.x + 0.75 * chart.width, chart.y + 40);
  const picked = await placeOf(page);
  assert.ok(picked > 230 && picked < 290, String(picked));
  await page.getByRole("button", { name: "Next point" }).click();
  assert.match(await page.locator("output.pose").textContent(), /nearest point \d+/);
  assert.deepEqual(said, []);
  await done();
});

test("choosing a candidate switches drawing, figures, dimensions and charts", async () => {
  const { page, said, done } = await opened("five");
  const shown = async () => ({
    title: await page.locator("article:visible h2").textContent(),
    curve: await page.locator(".stage .curve").first().getAttribute("d"),
    chart: await page.locator("svg.chart[role=img]").nth(1).getAttribute("aria-label"),
    dimensions: await page.locator("article:visible pre.dimensions").first().textContent(),
  });
  const first = await shown();
  await page.locator("#choices label", { hasText: "4" }).click();
  const fourth = await shown();
  assert.equal(fourth.title, "Candidate 4");
  for (const key of Object.keys(first)) assert.notEqual(first[key], fourth[key], key);
  await page.locator("tr[data-key=c1] button").click();
  assert.deepEqual(await shown(), first);
  await page.keyboard.press("2");
  assert.equal((await shown()).title, "Candidate 2");
  assert.ok(await page.locator("#choices input[value=c2]").isChecked());
  // A cognate and an exact linkage are played beside the candidate's words.
  await page.locator("tr[data-key=c2a1] button").click();
  assert.match(await page.locator("#played").textContent(), /cognate 1 of candidate 2/);
  await page.locator("tr[data-key=x1] button").click();
  assert.match(await page.locator("#played").textContent(), /exact linkage 1/);
  assert.deepEqual(said, []);
  await done();
});

test("the table sorts by every figure, both ways", async () => {
  const { page, said, done } = await opened("five");
  const table = page.locator("table.candidates");
  const heads = table.locator("thead th button");
  const count = await heads.count();
  assert.ok(count >= 12);
  for (let column = 0; column < count; column += 1) {
    const values = () =>
      table
        .locator("tbody tr")
        .evaluateAll((rows, i) => rows.map((row) => row.cells[i].dataset.v ?? row.cells[i].textContent), column);
    const sorted = (list) =>
      [...list].sort((x, y) => (Number.isNaN(Number(x)) ? x.localeCompare(y) : Number(x) - Number(y)));
    await heads.nth(column).click();
    const rising = await values();
    assert.deepEqual(rising, sorted(rising), `column ${column}`);
    assert.equal(await table.locator("thead th").nth(column).getAttribute("aria-sort"), "ascending");
    await heads.nth(column).click();
    assert.deepEqual(await values(), sorted(rising).reverse(), `column ${column}`);
  }
  assert.deepEqual(said, []);
  await done();
});

test("dimensions are copied with all their digits", async () => {
  const { page, done } = await opened("five", { permissions: ["clipboard-read", "clipboard-write"] });
  await page.locator("article:visible").getByRole("button", { name: "Copy as a linkage file" }).first().click();
  await page.locator("article:visible .said").first().getByText("Copied").waitFor();
  const text = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(
    text,
    /^format = 1\nname = "eighteen-point-1"\nunit = "m"\n\n\[linkage\]\nA = \[0\.5483085928380659, 0\.7165120992749661\]/,
  );
  await done();
});

test("a motion that passes its toggles plays through both branches, a rocking one to and fro", async () => {
  for (const [name, title] of [
    ["through", "Place on the motion"],
    ["rock", "Crank angle"],
  ]) {
    const { page, said, done } = await opened(name);
    assert.equal(await page.locator(".scrub-label span").first().textContent(), title);
    const [low, high] = await slider(page).evaluate((input) => [Number(input.min), Number(input.max)]);
    const places = [];
    for (let i = 0; i <= 12; i += 1) {
      await slider(page).fill(String(Math.trunc(low + ((high - low) * i) / 12)));
      places.push(await page.locator("path.bar").first().getAttribute("d"));
    }
    assert.ok(new Set(places).size > 11, name);
    assert.ok(places.every((d) => d.length > 20 && !d.includes("NaN")));
    await page.getByLabel("Speed").selectOption("4");
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForTimeout(700);
    assert.deepEqual(said, []);
    await done();
  }
});

test("texts of a hostile record are shown as texts", async () => {
  const { page, said, done } = await opened("hostile");
  for (const key of ["2", "3"]) await page.keyboard.press(key);
  await page.locator("tr[data-key=c3a1] button").click();
  await page.waitForTimeout(200);
  assert.deepEqual(said, []);
  assert.equal(await page.locator("img, iframe, [onload], [onerror]").count(), 0);
  assert.equal(await page.locator("script").count(), 2);
  assert.match(await page.locator("h1").textContent(), /<script>alert\(1\)<\/script>/);
  await done();
});

test("the security policy stops a script that got in all the same", async () => {
  const folder = mkdtempSync(join(tmpdir(), "linkwright-policy-"));
  const place = join(folder, "bad.html");
  const page = readFileSync(join(pages, "five.html"), "utf8");
  writeFileSync(
    place,
    page.replace("<h1>", "<script>alert(1)</script><img src=x onerror=alert(2)><h1 onclick=alert(3)>"),
  );
  const context = await browser.newContext();
  const tab = await context.newPage();
  const dialogs = [];
  const refused = [];
  tab.on("dialog", (dialog) => {
    dialogs.push(dialog.message());
    dialog.dismiss();
  });
  tab.on("console", (message) => refused.push(message.text()));
  await tab.goto(pathToFileURL(place).href);
  await tab.locator("h1").click();
  await tab.waitForTimeout(100);
  assert.deepEqual(dialogs, []);
  assert.ok(refused.filter((text) => text.includes("Content Security Policy")).length >= 2, refused.join("\n"));
  await context.close();
  rmSync(folder, { recursive: true });
});

test("without a script the drawings, the table and all candidates are there", async () => {
  const { page, said, done } = await opened("five", { javaScriptEnabled: false });
  assert.equal(await page.locator("figure.still svg:visible").count(), 5);
  assert.equal(await page.locator("article:visible").count(), 6);
  assert.equal(await page.locator("table.candidates tbody tr").count(), 6);
  assert.equal(await page.locator("#live:visible").count(), 0);
  assert.deepEqual(said, []);
  await done();
});

test("where motion is to be reduced it steps from point to point", async () => {
  const { page, done } = await opened("five", { reducedMotion: "reduce" });
  await page.getByLabel("Speed").selectOption("4");
  await page.getByRole("button", { name: "Play" }).click();
  const seen = new Set();
  for (let i = 0; i < 12; i += 1) {
    await page.waitForTimeout(60);
    seen.add(await placeOf(page));
  }
  await page.getByRole("button", { name: "Pause" }).click();
  assert.ok(seen.size >= 2 && seen.size <= 6, [...seen].join(" "));
  await done();
});

test("controls have names, figures have text alternatives, everything is reached by the tab key", async () => {
  const { page, done } = await opened("five");
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, [role=slider], [role=img], [role=region], svg[role]")]
      .filter((node) => node.checkVisibility())
      .filter(
        (node) =>
          !(
            node.getAttribute("aria-label") ||
            node.textContent.trim() ||
            node.labels?.length ||
            node.querySelector("title")
          ),
      )
      .map((node) => node.outerHTML.slice(0, 120)),
  );
  assert.deepEqual(nameless, []);
  assert.match(
    await page.locator("svg.chart[role=img]").nth(1).getAttribute("aria-label"),
    /Transmission angle: from [\d.]+ at a crank angle of/,
  );
  const reached = new Set();
  for (let i = 0; i < 60; i += 1) {
    await page.keyboard.press("Tab");
    reached.add(
      await page.evaluate(() => document.activeElement.className?.baseVal ?? document.activeElement.className),
    );
  }
  for (const name of ["grip", "sign play", "scrub", "sort", "choose", "copy"])
    assert.ok(reached.has(name), `${name} in ${[...reached]}`);
  await done();
});

test("ink keeps its contrast in light and dark", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const { page, done } = await opened("five", { colorScheme });
    const ratios = await page.evaluate(() => {
      const linear = (c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
      const luminance = (colour) => {
        const [r, g, b] = colour
          .match(/[\d.]+/g)
          .slice(0, 3)
          .map((c) => linear(Number(c) / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const probe = document.createElement("span");
      document.body.append(probe);
      const of = (name) => {
        probe.setAttribute("class", "");
        probe.style.color = `var(${name})`;
        return luminance(getComputedStyle(probe).color);
      };
      const ratio = (x, y) => (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05);
      return ["--ink", "--muted", "--accent", "--good", "--bad", "--target-text"].map((name) => [
        name,
        ratio(of(name), of("--paper")),
      ]);
    });
    for (const [name, ratio] of ratios) assert.ok(ratio >= 4.5, `${name} in ${colorScheme}: ${ratio}`);
    await done();
  }
});

test("it prints as a sheet without controls, and screenshots are taken where they are asked for", async () => {
  const { page, done } = await opened("five");
  await page.emulateMedia({ media: "print" });
  for (const gone of [".transport", ".choices", ".copying"])
    assert.equal(await page.locator(`${gone}:visible`).count(), 0, gone);
  assert.ok(await page.locator("svg.stage").first().isVisible());
  const sheet = await page.pdf({ format: "A4" });
  const count = sheet.toString("latin1").match(/\/Type\s*\/Page\b/g).length;
  assert.ok(count >= 1 && count <= 4, `${count} pages`);
  await done();
  if (!shots) return;
  for (const name of ["five", "through", "points", "small"]) {
    for (const width of [1280, 390]) {
      for (const colorScheme of ["light", "dark"]) {
        const shot = await opened(name, { viewport: { width, height: 844 }, colorScheme });
        await shot.page.screenshot({ path: join(shots, `${name}-${width}-${colorScheme}.png`), fullPage: true });
        await shot.done();
      }
    }
  }
});
