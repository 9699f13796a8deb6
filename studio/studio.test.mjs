// The studio in headless Chromium: see .ci/check-studio.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { doing, gone, house, opened as openedIn, program, shots, status, studio, tab } from "./harness.mjs";

const home = house("studio");
const { work } = home;

const opened = (address, options) => openedIn(home.browser, address, options);

/** Draws a closed curve with the pen. */
async function drawn(page) {
  const box = await page.locator("#board svg").boundingBox();
  const at = (t) => [
    box.x + box.width * (0.5 + 0.24 * Math.cos(t)),
    box.y + box.height * (0.45 + 0.2 * Math.sin(t) + 0.05 * Math.cos(2 * t)),
  ];
  await page.mouse.move(...at(0));
  await page.mouse.down();
  for (let i = 1; i <= 80; i += 1) await page.mouse.move(...at((i * 2 * Math.PI) / 80));
  await page.mouse.up();
}

test("the first minute: an example runs, hints stand there, the token is gone from the address", async () => {
  const { address, end } = await studio("--port", "18471");
  const { page, said, context } = await opened(address);
  assert.equal(page.url(), "http://127.0.0.1:18471/");
  assert.equal(await page.locator("#hints li").count(), 3);
  await doing(page, "done");
  assert.match(await status(page), /^Best: rms .* meets everything/);
  assert.equal(await page.evaluate(() => document.cookie), "", "no script reads the cookie");
  const before = await page.locator(".board .bar").first().getAttribute("d");
  await page.waitForTimeout(250);
  assert.notEqual(await page.locator(".board .bar").first().getAttribute("d"), before, "it moves");
  await page.getByRole("button", { name: "Got it" }).click();
  assert.deepEqual(said, []);
  await context.close();
  assert.equal(await end(), 0);
});

test("draw, drag, pin, save, reload, restart", async () => {
  const first = await studio("--port", "18472");
  const { page, said, context } = await opened(first.address);
  await drawn(page);
  assert.equal(await page.locator("#point-count").textContent(), "60");
  assert.ok(await page.locator("#closed").isChecked());
  const up = Date.now();
  await page.waitForFunction(
    () =>
      document.body.dataset.answered === document.body.dataset.asked &&
      document.querySelectorAll("#strip li").length > 0,
  );
  console.log(`first candidate ${Date.now() - up} ms after the pen went up`);
  await doing(page, "done");
  // A point is dragged to and fro: answers follow.
  await page.evaluate(() => {
    window.answers = new Set();
    new MutationObserver(() => window.answers.add(document.body.dataset.answered)).observe(document.body, {
      attributes: true,
    });
  });
  const handle = await page.evaluate(() => {
    const { x, y, width, height } = document.querySelectorAll(".handle")[2].getBoundingClientRect();
    return { x, y, width, height };
  });
  const [x, y] = [handle.x + handle.width / 2, handle.y + handle.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  const start = Date.now();
  for (let i = 1; Date.now() - start < 2000; i += 1) {
    await page.mouse.move(x, y + 25 * Math.sin(i / 12));
    await page.waitForTimeout(8);
  }
  const seconds = (Date.now() - start) / 1000;
  const count = await page.evaluate(() => window.answers.size);
  console.log(`${(count / seconds).toFixed(1)} re-fits a second while dragging 60 points`);
  assert.ok(count / seconds > 4, `${count} in ${seconds} s`);
  await page.mouse.move(x + 6, y - 25);
  await page.mouse.up();
  await doing(page, "done");
  const points = await page.locator("#coordinates").inputValue();
  // Undo and redo.
  await page.getByRole("button", { name: "Undo" }).click();
  assert.notEqual(await page.locator("#coordinates").inputValue(), points);
  await page.keyboard.press("Control+y");
  assert.equal(await page.locator("#coordinates").inputValue(), points);
  await doing(page, "done");
  // Pin the second, choose the first.
  const linkages = await page.locator("#strip li").count();
  await page.getByRole("button", { name: "Pin linkage 2" }).click();
  assert.equal(await page.locator("#strip li").count(), linkages + 1);
  assert.equal(await page.locator(".board .pinned .figure").count(), 1);
  // Files: the problem gives the linkage that the page shows.
  const save = async (name) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name }).click()]);
    const file = join(work, download.suggestedFilename());
    await download.saveAs(file);
    return file;
  };
  await tab(page, "build");
  const [problem, linkage] = [await save("Problem file"), await save("Linkage file")];
  execFileSync(program, ["check", problem, linkage]);
  execFileSync(program, ["synth", problem, "--out", join(work, "out"), "--quiet"]);
  const record = JSON.parse(readFileSync(join(work, "out/record.json"), "utf8"));
  const best = record.candidates[0].error.rms;
  const shown = Number((await page.locator("#strip .figures").first().textContent()).match(/rms ([\d.]+)/)[1]);
  // Three digits are shown.
  assert.ok(shown <= best * 1.006, `the page shows ${shown}, synth finds ${best}`);
  if (shots) await page.screenshot({ path: join(shots, "drawn.png") });
  // A reload keeps everything, and so does a studio that is started again.
  await page.reload();
  await doing(page, "done");
  assert.equal(await page.locator("#coordinates").inputValue(), points);
  assert.equal(await page.getByRole("button", { name: "Unpin pinned 1" }).count(), 1);
  assert.deepEqual(said, []);
  assert.equal(await first.end(), 0);
  await page.waitForFunction(() => document.querySelector("#status").textContent.includes("does not answer"), null, {
    timeout: 15_000,
  });
  const second = await studio("--port", "18472");
  await gone(page, second.address);
  await doing(page, "done");
  assert.equal(await page.locator("#coordinates").inputValue(), points);
  await context.close();
  await second.end();
});

test("an edit in the frame in which the connection opens is not lost", async () => {
  const { address, end } = await studio("--port", "18478");
  const { page, context } = await opened(address);
  await doing(page, "done");
  const other = await context.newPage();
  // The page learns only when the test says so that the connection is open.
  await other.addInitScript(() => {
    const listen = WebSocket.prototype.addEventListener;
    WebSocket.prototype.addEventListener = function (kind, hear) {
      const later = (event) => {
        window.openNow = () => hear(event);
      };
      listen.call(this, kind, kind === "open" ? later : hear);
    };
  });
  await other.goto(new URL("/", address).href);
  await other.waitForFunction(() => window.openNow && document.body.dataset.asked);
  // What was asked at first has gone to the connection that is not open yet.
  await other.evaluate(() => new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go))));
  const [before, after] = await other.evaluate(() => {
    const { asked } = document.body.dataset;
    const field = document.querySelector("#transmission");
    field.value = "44";
    for (const kind of ["input", "change"]) field.dispatchEvent(new Event(kind, { bubbles: true }));
    window.openNow();
    return [asked, document.body.dataset.asked];
  });
  assert.notEqual(before, after);
  await doing(other, "done");
  await context.close();
  assert.equal(await end(), 0);
});

test("by keyboard alone: points typed, requirements set, a point moved, a linkage chosen", async () => {
  const { address, end } = await studio("--port", "18473");
  const { page, said, context } = await opened(address);
  await page.locator("#tab-wishes").focus();
  await page.keyboard.press("ArrowRight");
  await page.locator("#coordinates").focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.type("x,y\n0, 0\n10, 4\n20, 5\n30, 4\n40, 0\n");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#point-count").textContent === "5");
  await doing(page, "done");
  await page.locator("#board svg").focus();
  await page.keyboard.press(".");
  await page.keyboard.press(".");
  assert.match(await status(page), /^Point 1 at 10/);
  await page.keyboard.press("ArrowUp");
  assert.notEqual((await page.locator("#coordinates").inputValue()).split("\n")[1], "10, 4");
  await doing(page, "done");
  await page.locator("#strip .pick").nth(1).focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.locator("#strip .pick").nth(1).getAttribute("aria-pressed"), "true");
  // What is impossible is said, and what would help.
  await tab(page, "wishes");
  await page.locator("#transmission").fill("89");
  await page.keyboard.press("Tab");
  await doing(page, "done");
  assert.match(await status(page), /not met: least transmission angle|Nothing acceptable/);
  await page.locator("#tolerance").fill("-1");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => document.querySelector("#status").textContent.startsWith("This cannot be searched"));
  await tab(page, "points");
  await page.locator("#coordinates").fill("1, 2\nthree");
  await page.getByRole("button", { name: "Take these points" }).click();
  assert.match(await status(page), /line 2/);
  // Everything that can be used has a name.
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, textarea")]
      .filter((one) => !(one.labels?.length || one.textContent.trim() || one.getAttribute("aria-label")))
      .map((one) => one.id),
  );
  assert.deepEqual(nameless, []);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a problem file begins, its pivot box is drawn and can be moved", async () => {
  const { address, end } = await studio(
    "--port",
    "18474",
    new URL("../problems/examples/pivot-box.toml", import.meta.url).pathname,
  );
  const { page, said, context } = await opened(address);
  assert.equal(await page.locator("#left").inputValue(), "-20");
  // It is drawn anew while the search goes on.
  const corner = await page.evaluate(() => {
    const { x, y } = document.querySelectorAll(".corner")[2].getBoundingClientRect();
    return { x, y };
  });
  await page.mouse.move(corner.x + 6, corner.y + 6);
  await page.mouse.down();
  await page.mouse.move(corner.x + 40, corner.y - 20, { steps: 4 });
  await page.mouse.up();
  assert.ok(Number(await page.locator("#right").inputValue()) > 100);
  await doing(page, "done");
  const bottom = Number(await page.locator("#bottom").inputValue());
  assert.equal(bottom, -40);
  assert.deepEqual(said, []);
  if (shots) await page.screenshot({ path: join(shots, "pivot-box.png") });
  await context.close();
  await end();
});

test("two sizes, light and dark, without a sideways scroll; ten tabs all progress within 500 MB", async () => {
  const { address, child, end } = await studio("--port", "18475");
  const { page, context } = await opened(address, { reducedMotion: "reduce" });
  for (const [width, height] of [
    [1280, 900],
    [390, 844],
  ]) {
    for (const colorScheme of ["light", "dark"]) {
      await page.setViewportSize({ width, height });
      await page.emulateMedia({ colorScheme });
      await page.getByRole("button", { name: "Show all" }).click();
      await page.waitForTimeout(150);
      const over = await page.evaluate(
        () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
      );
      assert.ok(over <= 0, `${over} px wider than ${width}`);
      if (shots) await page.screenshot({ path: join(shots, `studio-${width}-${colorScheme}.png`), fullPage: true });
    }
  }
  await page.setViewportSize({ width: 1280, height: 900 });
  const tabs = [page];
  for (let i = 1; i < 10; i += 1) tabs.push((await opened("http://127.0.0.1:18475/", { context })).page);
  await Promise.all(
    tabs.map((tab) =>
      tab.evaluate(() => {
        const text = document.querySelector("#tolerance");
        text.value = "0.0001";
        text.dispatchEvent(new Event("change"));
      }),
    ),
  );
  await Promise.all(
    tabs.map((tab) =>
      tab.waitForFunction(
        () =>
          ["searching", "done"].includes(document.body.dataset.doing) &&
          document.querySelectorAll("#strip li").length > 0,
        null,
        { timeout: 60_000 },
      ),
    ),
  );
  const memory = Number(readFileSync(`/proc/${child.pid}/status`, "utf8").match(/VmHWM:\s+(\d+)/)[1]) / 1024;
  console.log(`ten tabs: ${memory.toFixed(0)} MB at most`);
  assert.ok(memory < 500);
  // One tab's hand is still answered.
  await tabs[3].bringToFront();
  await drawn(tabs[3]);
  await tabs[3].waitForFunction(
    () =>
      document.body.dataset.answered === document.body.dataset.asked &&
      document.querySelectorAll("#strip li").length > 0,
    null,
    { timeout: 20_000 },
  );
  await context.close();
  // Closed tabs work no more.
  const time = () =>
    readFileSync(`/proc/${child.pid}/stat`, "utf8")
      .split(") ")[1]
      .split(" ")
      .slice(11, 13)
      .reduce((sum, t) => sum + Number(t), 0);
  await new Promise((later) => {
    setTimeout(later, 1500);
  });
  const [at] = [time()];
  await new Promise((later) => {
    setTimeout(later, 1000);
  });
  assert.ok(time() - at < 30, `${time() - at} hundredths of a second of work with no tab open`);
  assert.equal(await end(), 0);
});
