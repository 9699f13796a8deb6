// The desk of the studio in headless Chromium: details, files, saved searches, links. See .ci/check-studio.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { studio as begun, doing, drawer, gone, house, opened as openedIn, program, shots, tab } from "./harness.mjs";

const home = house("desk");
const { work } = home;

const studio = (port, folder) => begun("--port", port, "--out", folder);
const opened = (address, context) => openedIn(home.browser, address, { context });
const done = (page) => doing(page, "done");
const state = (page, name, what) =>
  page.waitForFunction(
    ([name, what]) =>
      [...document.querySelectorAll("#jobs li")].some(
        (row) => row.querySelector(".job-name").textContent === name && row.dataset.state === what,
      ),
    [name, what],
    { timeout: 60_000 },
  );

async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  const file = join(work, `${Math.random()}-${download.suggestedFilename()}`);
  await download.saveAs(file);
  return { file, name: download.suggestedFilename(), text: readFileSync(file, "utf8") };
}

test("everything about a linkage: charts, verdicts, costs, files", async () => {
  const { address, end } = await studio("18591", join(work, "one"));
  const { page, said, context } = await opened(address);
  await done(page);
  await page.locator("#details summary").click();
  await page.waitForSelector("#details .details-charts figure");
  const titles = await page.locator("#details .details-charts figcaption").allTextContents();
  for (const title of ["Error at the points", "Transmission angle", "Angles of the links", "Velocity", "Acceleration"])
    assert.ok(
      titles.some((one) => one.includes(title)),
      `${title} in ${titles}`,
    );
  // Every curve of the chart of angles is drawn, without a jump.
  const lines = await page
    .locator("#details figure", { hasText: "Angles of the links" })
    .locator("path.line")
    .evaluateAll((paths) => paths.map((path) => path.getAttribute("d")));
  assert.equal(lines.length, 3);
  for (const line of lines) {
    const heights = line
      .slice(1)
      .split("L")
      .map((point) => Number(point.split(" ")[1]));
    assert.ok(heights.length > 300);
    assert.ok(
      heights.every((y, i) => i === 0 || Math.abs(y - heights[i - 1]) < 12),
      "no jump",
    );
  }
  const words = await page.locator(".details-words").textContent();
  assert.match(words, /Requirements/);
  assert.match(words, /worst transmission angle/);
  assert.match(words, /Dimensions/);
  // The crank is moved by its slider, charts and reading follow.
  await page.locator("#details .scrub").fill("40");
  assert.match(await page.locator("#details .pose").textContent(), /crank 40/);
  // Files.
  const linkage = await (async () => {
    await page.locator("#format").selectOption("toml");
    return saved(page, () => page.locator("#export").click());
  })();
  execFileSync(program, ["check", linkage.file]);
  for (const [format, holds] of [
    ["dxf", /AC1015/],
    ["svg", /mm"/],
    ["csv", /^crank_deg/m],
    ["points", /./],
    ["html", /^<!doctype html>/],
    ["sheet", /<svg/],
    ["scad", /module/],
    ["stl", /solid/],
  ]) {
    await page.locator("#format").selectOption(format);
    const { text, name } = await saved(page, () => page.locator("#export").click());
    assert.match(text, holds, `${format}: ${name}`);
  }
  // Another one is chosen in the strip: the details are its own.
  const before = await page.locator(".details-words pre").first().textContent();
  await page.locator("#strip .pick").nth(1).click();
  await page.waitForFunction((before) => document.querySelector(".details-words pre").textContent !== before, before);
  // While a point is dragged they stay, then they follow.
  if (shots) await page.screenshot({ path: join(shots, "details.png"), fullPage: true });
  const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(over <= 0, `${over} px too wide`);
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(200);
  const narrow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(narrow <= 0, `${narrow} px too wide for 390`);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("saved searches: begun, watched, stopped, gone on, opened, compared; a reload and a restart lose none", async () => {
  const folder = join(work, "two");
  const first = await studio("18592", folder);
  const { page, said, context } = await opened(first.address);
  await done(page);
  await drawer(page, "searches");
  await page.locator("#job-name").fill("short one");
  await page.locator("#job-budget").fill("200000");
  await page.locator("#job-start").click();
  await state(page, "short one", "done");
  assert.match(await page.locator("#jobs li").textContent(), /rms 0\.\d+ mm/);
  // The record is that of synth.
  await tab(page, "build");
  const problem = await saved(page, () => page.getByRole("button", { name: "Problem file", exact: true }).click());
  assert.ok(problem.text.includes("walking-leg"));
  execFileSync(program, [
    "synth",
    problem.file,
    "--set",
    "name=short one",
    "--set",
    "solve.evaluations=200000",
    "--out",
    join(work, "own"),
    "--quiet",
  ]);
  assert.equal(
    readFileSync(join(folder, "short one/record.json"), "utf8"),
    readFileSync(join(work, "own/record.json"), "utf8"),
  );
  // A tolerance that nothing meets: it goes on and on.
  await tab(page, "wishes");
  await page.locator("#tolerance").fill("0.0001");
  await page.keyboard.press("Tab");
  await page.locator("#job-name").fill("long one");
  await page.locator("#job-budget").fill("900000000");
  await page.locator("#job-start").click();
  await state(page, "long one", "running");
  const row = page.locator("#jobs li", { hasText: "long one" });
  await page.waitForFunction(() =>
    [...document.querySelectorAll("#jobs li")].some((one) =>
      /tries a second/.test(one.querySelector(".job-figures").textContent),
    ),
  );
  if (shots) await page.screenshot({ path: join(shots, "jobs.png"), fullPage: true });
  // A name that is taken is refused, in words.
  await page.locator("#job-name").fill("long one");
  await page.locator("#job-start").click();
  await page.waitForFunction(() => /running|already/.test(document.querySelector("#desk-said").textContent));
  await page.getByRole("button", { name: "Close this message" }).click();
  assert.equal(await page.locator("#desk-said").textContent(), "");
  // A reload: it runs on.
  await page.reload();
  await state(page, "long one", "running");
  await drawer(page, "searches");
  await row.getByRole("button", { name: "Stop" }).click();
  await state(page, "long one", "stopped");
  await page.waitForFunction(() => document.querySelector("#desk-said").textContent.startsWith("long one: stopped."));
  await row.getByRole("button", { name: "Go on" }).click();
  await state(page, "long one", "running");
  // The studio ends, and another begins.
  assert.equal(await first.end(), 0);
  const second = await studio("18592", folder);
  await gone(page, second.address);
  await state(page, "long one", "stopped");
  await state(page, "short one", "done");
  assert.deepEqual(
    said.filter(
      (line) =>
        !line.includes("WebSocket") &&
        !line.includes("409") &&
        !line.includes("ERR_CONNECTION_REFUSED") &&
        !line.includes("ERR_CONNECTION_RESET"),
    ),
    [],
  );
  // Opened: its problem is on the board, its candidates below.
  await drawer(page, "searches");
  await page.locator("#jobs li", { hasText: "short one" }).getByRole("button", { name: "Open" }).click();
  await page.waitForFunction(() => document.querySelector("#details-title").textContent === "short one, candidate");
  assert.equal(await page.locator("#tolerance").inputValue(), "");
  const record = JSON.parse(readFileSync(join(folder, "short one/record.json"), "utf8"));
  assert.equal(await page.locator("#details-candidate option").count(), record.candidates.length);
  await page.waitForFunction(() => document.querySelector("#details").dataset.shown?.includes('"rank":1'));
  await page.locator("#details-pin").click();
  assert.equal(await page.getByRole("button", { name: "Unpin pinned 1" }).count(), 1);
  // Compared with each other.
  await drawer(page, "searches");
  for (const name of ["short one", "long one"]) await page.getByLabel(`Compare ${name}`).check();
  await page.locator("#job-compare").click();
  await page.waitForSelector("#comparison tbody tr:nth-child(2)");
  assert.match(await page.locator("#comparison").textContent(), /short one:1/);
  const html = await saved(page, () => page.locator("#job-compare-page").click());
  assert.match(html.text, /long one:1/);
  await context.close();
  assert.equal(await second.end(), 0);
});

test("a link holds the problem, and what is wrong with one is said", async () => {
  const { address, end } = await studio("18593", join(work, "three"));
  const { page, said, context } = await opened(address);
  await page.locator("#transmission").fill("41");
  await page.keyboard.press("Tab");
  await tab(page, "build");
  await page.locator("#copy-link").click();
  await page.waitForFunction(() => document.querySelector("#link").value !== "");
  const link = await page.locator("#link").inputValue();
  assert.ok(link.startsWith("http://127.0.0.1:18593/#problem=") && link.length < 2000, link);
  const points = await page.locator("#coordinates").inputValue();
  await page.locator("#clear").click();
  await tab(page, "wishes");
  await page.locator("#transmission").fill("");
  await page.keyboard.press("Tab");
  // Nothing of it reaches the server: only the page asks, and for no address that holds it.
  const asked = [];
  context.on("request", (request) => asked.push(request.url()));
  const other = (await opened(link, context)).page;
  await other.waitForFunction((points) => document.querySelector("#coordinates").value === points, points);
  assert.equal(await other.locator("#transmission").inputValue(), "41");
  assert.equal(other.url(), "http://127.0.0.1:18593/");
  assert.ok(asked.length > 3 && asked.every((url) => !url.includes("problem=") || url.includes("#problem=")));
  await done(other);
  // Pasted.
  await tab(page, "build");
  await page.locator("#link").fill(link);
  await page.locator("#take-link").click();
  await page.waitForFunction((points) => document.querySelector("#coordinates").value === points, points);
  // What is no link changes nothing.
  const packed = (text) => deflateRawSync(Buffer.from(text)).toString("base64url");
  for (const [bad, says] of [
    ["http://example.com/", /has #problem= in it/],
    ["#problem=", /no link of the studio/],
    ["#problem=%3Cscript%3E", /no link of the studio/],
    ["#problem=AAAA", /broken|holds no problem/],
    [`${link.slice(0, -20)}`, /broken/],
    [`#problem=${"A".repeat(20_000)}`, /too long/],
    [`#problem=${packed(" ".repeat(9_000_000)).slice(0, 15_000)}`, /more than a problem/],
    [`#problem=${packed('format = 1\n[task.path]\nfile = "/etc/passwd"\n')}`, /holds no problem/],
    [`#problem=${packed("format = 1\n[task.path]\npoints = [[nan, 1], [2, 3], [4, 5]]\n")}`, /holds no problem/],
    [`#problem=${packed("<img src=x onerror=alert(1)>")}`, /holds no problem/],
  ]) {
    await page.locator("#link").fill(bad.startsWith("#") ? `http://127.0.0.1:18593/${bad}` : bad);
    await page.locator("#take-link").click();
    await page
      .waitForFunction((says) => new RegExp(says).test(document.querySelector("#desk-said").textContent), says.source, {
        timeout: 5000,
      })
      .catch(async () => assert.fail(`${bad.slice(0, 60)}: ${await page.locator("#desk-said").textContent()}`));
    assert.equal(await page.locator("#coordinates").inputValue(), points);
  }
  // A problem file is opened.
  await page
    .locator("#open-problem")
    .setInputFiles(new URL("../problems/examples/pivot-box.toml", import.meta.url).pathname);
  await page.waitForFunction(() => document.querySelector("#left").value === "-20");
  await page.locator("#open-problem").setInputFiles(new URL("../README.md", import.meta.url).pathname);
  await page.waitForFunction(() => /holds no problem/.test(document.querySelector("#desk-said").textContent));
  assert.deepEqual(
    said.filter((line) => !line.includes("422")),
    [],
  );
  await context.close();
  await end();
});
