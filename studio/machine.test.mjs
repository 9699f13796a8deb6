// The linkage as a machine in the hand: held on to while a point moves, grabbed by its joints, built, shared; and what
// the page costs while nobody does anything. See .ci/check-studio.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  begun,
  button,
  doing,
  drawer,
  example,
  house,
  problemText,
  program,
  shots,
  status,
  tab,
  timing,
} from "./harness.mjs";

const home = house("machine");

/** Where something on the board is, asked at once: it is drawn anew while answers come. */
const middle = (page, selector) =>
  page.evaluate((selector) => {
    const { x, y, width, height } = document.querySelector(selector).getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  }, selector);
const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`) });

async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  return { name: download.suggestedFilename(), path: await download.path() };
}

test("a point is dragged for six seconds: the linkage that is shown follows, and no pivot jumps", async () => {
  const { page, said, context, end } = await begun(home);
  // Where the linkage that is held has its pivots in each answer, in millimetres, and which one that is.
  const answers = [];
  let [held, latest] = [null, []];
  const note = () => {
    const one = latest.find(({ number }) => held !== null && number === held);
    if (one) answers.push({ number: one.number, pivots: [one.linkage.A, one.linkage.B] });
  };
  await page.routeWebSocket(/live/, (socket) => {
    const server = socket.connectToServer();
    socket.onMessage((text) => {
      const { moving, held: number } = JSON.parse(text);
      const isFirst = moving && held === null;
      if (moving) held = number ?? null;
      // From where it was before the hand moved.
      if (isFirst) note();
      server.send(text);
    });
    server.onMessage((text) => {
      latest = JSON.parse(text).candidates;
      note();
      socket.send(text);
    });
  });
  await page.reload();
  await doing(page, "done");
  await example(page, 2);
  await doing(page, "done");
  await button(page, "Pause").click();
  const [x, y] = await middle(page, ".handle");
  // Where the pivots stand in every picture.
  const standing = () =>
    page.evaluate(() => {
      window.pivots = () =>
        [...document.querySelectorAll("#board .figure.coming .pin, #board .figure:not(.leaving) .pin")]
          .slice(-4, -2)
          .map((pin) => [Number(pin.getAttribute("cx")), Number(pin.getAttribute("cy"))]);
      return window.pivots();
    });
  const before = await standing();
  await page.evaluate(() => {
    window.seen = [];
    const watch = () => {
      window.seen.push(window.pivots());
      window.watching = requestAnimationFrame(watch);
    };
    watch();
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  const start = Date.now();
  for (let i = 1; Date.now() - start < 6000; i += 1) {
    // To and fro, with rests in which the search begins.
    await page.mouse.move(x, y - 22 * Math.sin(i / 40));
    await page.waitForTimeout(i % 100 < 12 ? 60 : 8);
  }
  const seen = await page.evaluate(() => {
    cancelAnimationFrame(window.watching);
    return window.seen;
  });
  const far = (one, other) => Math.max(...one.map(([x, y], k) => Math.hypot(x - other[k][0], y - other[k][1])));
  const steps = (all) => all.slice(1).map((one, i) => far(one, all[i]));
  const perMillimetre = await page.evaluate(() => {
    const [, from, to] = document
      .querySelector(".scale")
      .getAttribute("d")
      .match(/M(\d+) .*H([\d.]+)v/);
    return (Number(to) - Number(from)) / Number(document.querySelector(".scale-text").textContent.match(/[\d.]+/)[0]);
  });
  const most = Math.max(...steps(seen));
  const following = steps(answers.map(({ pivots }) => pivots)).map((step) => step * perMillimetre);
  console.log(
    `largest step of a pivot between two of ${seen.length} pictures: ${most.toFixed(1)} pixels; between two of ${answers.length} answers for the linkage that is held: ${Math.max(...following).toFixed(1)}`,
  );
  assert.ok(seen.length > 60 && answers.length > 20);
  assert.equal(new Set(answers.map(({ number }) => number)).size, 1, "one linkage is held all the time");
  // Of two answers within one picture the latter is shown: a picture's step is that of a few answers at most.
  const few = following.map((_, i) => following.slice(i, i + 4).reduce((sum, step) => sum + step, 0));
  assert.ok(most <= Math.max(...few) + 0.5, `a pivot jumped by ${most} pixels, farther than the answers move`);
  // The handle moves by up to 6 pixels a step; another linkage of the egg has its pivots elsewhere by a hundred.
  assert.ok(most < 60, `a pivot jumped by ${most} pixels`);
  // The handle back where it was: so is the linkage, as it was never left for another.
  await page.mouse.move(x, y, { steps: 5 });
  await page.waitForFunction(() => document.body.dataset.answered === document.body.dataset.asked);
  await page.waitForTimeout(300);
  const back = far(await standing(), before);
  assert.ok(back < 12, `the pivots are ${back} pixels from where they were`);
  await page.mouse.up();
  await doing(page, "done");
  assert.ok(await page.locator("#closer").isHidden(), "it is taken at the end");
  assert.deepEqual(await page.locator(".pick[aria-pressed=true] strong").allTextContents(), ["Linkage 1"]);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a closer linkage is offered while one is held, and taken on a click", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  // What the studio finds while the hand rests: one that is half as far off as the one that is held, which need not be
  // the closest of those found since.
  let better = false;
  let held;
  let place;
  await page.routeWebSocket(/live/, (socket) => {
    const server = socket.connectToServer();
    server.onMessage((text) => {
      const answer = JSON.parse(text);
      const shown = answer.candidates.find(({ number }) => number === held);
      if (better && shown) {
        const { linkage } = shown;
        const other = { ...linkage, A: [linkage.A[0] - 90, linkage.A[1]], c: linkage.c * 1.7, t1: -linkage.t1 };
        answer.candidates.unshift({ ...shown, number: 99_999, rms: shown.rms / 2, accepted: true, linkage: other });
        place = answer.candidates.indexOf(shown);
      }
      socket.send(JSON.stringify(answer));
    });
    socket.onMessage((text) => {
      held = JSON.parse(text).held ?? held;
      server.send(text);
    });
  });
  await page.reload();
  await doing(page, "done");
  const [x, y] = await middle(page, ".handle[data-point='12']");
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 10; i += 1) await page.mouse.move(x, y - i);
  better = true;
  await page.mouse.move(x, y - 12);
  await page.waitForSelector("#closer:not([hidden])");
  assert.match(await page.locator("#closer").textContent(), /a closer one: −50 %/);
  assert.deepEqual(await page.locator(".pick[aria-pressed=true] strong").allTextContents(), [`Linkage ${place + 1}`]);
  await page.evaluate(() => document.querySelector("#closer").click());
  assert.deepEqual(await page.locator(".pick[aria-pressed=true] strong").allTextContents(), ["Linkage 1"]);
  assert.equal(await page.locator("#board .leaving").count(), 1, "the one before fades");
  await page.mouse.up();
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a linkage is grabbed: joints dragged, the crank turned, lengths locked and rounded, the rest fitted again", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  await button(page, "Grab").click();
  await page.waitForSelector("#by-hand:not([hidden])");
  assert.equal(await page.locator("#play").textContent(), "Play", "it stands still");
  const value = async (name) => Number(await page.getByRole("spinbutton", { name, exact: true }).inputValue());
  const quality = () => page.locator("#by-hand .quality").textContent();
  const before = [await quality(), await value("d, C to P"), await value("a, crank AC")];
  const _curve = await page.locator("#board .figure .curve").first().getAttribute("d");
  // P is dragged: the curve and the errors follow, the crank does not change.
  let [x, y] = await middle(page, ".grip.P");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 30, y - 20, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction((before) => document.querySelector("#by-hand .quality").textContent !== before, before[0]);
  assert.notEqual(await value("d, C to P"), before[1]);
  assert.equal(await value("a, crank AC"), before[2]);
  const [px, py] = await middle(page, ".grip.P");
  assert.ok(Math.hypot(px - x - 30, py - y + 20) < 3, "P is where the hand left it");
  assert.equal(await page.locator("#board .whisker").evaluate((one) => one.getAttribute("d").length > 10), true);
  await shot(page, "grabbed");
  // A locked length stays, and its joint goes along the circle.
  await page.getByRole("checkbox", { name: "Lock d, C to P" }).check();
  const cp = await value("d, C to P");
  [x, y] = await middle(page, ".grip.P");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 25, y - 25, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(200);
  assert.ok(Math.abs((await value("d, C to P")) - cp) < 0.01 * cp);
  // The crank turns about its pivot.
  const joint = await middle(page, ".grip.C");
  [x, y] = await middle(page, ".grip.turn");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 10, y - 40, { steps: 5 });
  await page.mouse.up();
  const turned = await middle(page, ".grip.C");
  assert.ok(Math.hypot(turned[0] - joint[0], turned[1] - joint[1]) > 5);
  // Round lengths; a step back brings the digits back.
  await button(page, "Round to 0.5 mm").click();
  await page.waitForFunction(
    () => document.querySelector("#by-hand input[aria-label='a, crank AC']").valueAsNumber % 0.5 === 0,
  );
  await button(page, "Undo").click();
  await page.waitForFunction(
    () => document.querySelector("#by-hand input[aria-label='a, crank AC']").valueAsNumber % 0.5 !== 0,
  );
  await button(page, "Round to 0.5 mm").click();
  await page.waitForFunction(
    () => document.querySelector("#by-hand input[aria-label='a, crank AC']").valueAsNumber % 0.5 === 0,
  );
  const crank = await value("a, crank AC");
  await page.getByRole("checkbox", { name: "Lock a, crank AC" }).check();
  await page.getByRole("checkbox", { name: "Lock d, C to P" }).uncheck();
  await button(page, "Fit the rest again").click();
  await doing(page, "done");
  assert.ok(await page.locator("#by-hand").isHidden());
  assert.match(await page.locator(".pick[aria-pressed=true] .tags").textContent(), /yours/, "fitted, and still shown");
  const text = await problemText(page);
  assert.match(text, new RegExp(`a = \\[${crank}(\\.0)?, ${crank}(\\.0)?\\]`));
  await tab(page, "build");
  const file = await saved(page, () => button(page, "Linkage file").click());
  const a = Number(readFileSync(file.path, "utf8").match(/\na = ([\d.]+)/)[1]);
  assert.ok(Math.abs(a - crank) < 1e-6 * crank, `${a} for ${crank}`);
  // Words that refuse stand there; nothing is said by the console but what the studio refused.
  assert.ok(
    said.every((line) => line.includes("422")),
    said.join("\n"),
  );
  await context.close();
  await end();
});

test("from an empty page to a laser-cut DXF of a walking leg", async () => {
  const { page, said, context, end } = await begun(home);
  await button(page, "Clear").click();
  await example(page, 0);
  await doing(page, "done");
  assert.ok(await page.locator("#walker").isChecked());
  assert.ok((await page.locator("#board .earth").getAttribute("d")).length > 100, "the ground");
  assert.equal(await page.locator("#board .figure.second:not(.absent)").count(), 1, "the other leg");
  await tab(page, "build");
  await page.waitForSelector("#plates:not([hidden]) svg path");
  assert.match(await page.locator("#layers").textContent(), /layers, from below/);
  // Sizes are drawn at once; what cannot be is said.
  const outline = () => page.locator("#plates svg path").first().getAttribute("d");
  const before = await outline();
  await page.locator("#hole_mm").fill("3");
  await page.waitForFunction(
    (before) => document.querySelector("#plates svg path").getAttribute("d") !== before,
    before,
  );
  await page.locator("#hole_mm").fill("300");
  await page.waitForFunction(() =>
    /run into each other/.test(document.querySelector("#panel-build .fault").textContent),
  );
  assert.ok(await page.locator("#save-archive").isDisabled());
  await page.locator("#hole_mm").fill("3.2");
  await page.getByLabel("Width of the sheet").fill("300");
  await page.getByLabel("Height of the sheet").fill("200");
  await page.locator("#kerf_mm").fill("0.15");
  await page.waitForFunction(() => document.querySelector("#panel-build .fault").textContent === "");
  await shot(page, "build");
  const dxf = await saved(page, () => button(page, "DXF for a laser").click());
  assert.equal(dxf.name, "walking-leg-1-plates.dxf");
  const archive = await saved(page, () => button(page, "Save everything (zip)").click());
  assert.equal(archive.name, "walking-leg-1.zip");
  const listed = execFileSync("python3", ["-m", "zipfile", "-l", archive.path], { encoding: "utf8" });
  for (const name of ["contents.txt", "plates.dxf", "plates.svg", "plates.stl", "cut-list.txt", "layers.txt"])
    assert.ok(listed.includes(`walking-leg-1-${name}`), `${name} in\n${listed}`);
  execFileSync("python3", ["-m", "zipfile", "-e", archive.path, home.work]);
  assert.match(readFileSync(join(home.work, "walking-leg-1-plates.dxf"), "utf8"), /AC1015/);
  execFileSync(program, [
    "check",
    join(home.work, "walking-leg-1-problem.toml"),
    join(home.work, "walking-leg-1-linkage.toml"),
  ]);
  // The report goes on where it was: opened by the studio, or dropped on its page.
  const report = join(home.work, "walking-leg-1-report.html");
  const other = await begun(home, [report]);
  await doing(other.page, "done");
  assert.equal(await other.page.locator("#point-count").textContent(), "19");
  assert.match(await problemText(other.page), /name = "walking-leg"[\s\S]*pivots_in/);
  assert.match(
    await other.page.locator(".pick[aria-pressed=true] .tags").textContent(),
    /yours/,
    "the report's linkage",
  );
  await button(other.page, "Clear").click();
  await other.page.locator("#file").setInputFiles(report);
  await other.page.waitForFunction(() => document.querySelector("#point-count").textContent === "19");
  assert.match(await problemText(other.page), /pivots_in/);
  await other.context.close();
  await other.end();
  assert.ok(
    said.every((line) => line.includes("422")),
    said.join("\n"),
  );
  await context.close();
  await end();
});

test("the gallery moves and loads with one click, and covers no middle of the board", async () => {
  const { page, said, context, end } = await begun(home);
  await page.waitForSelector("#gallery:not([hidden])");
  const bar = () => page.locator("#gallery .bar").first().getAttribute("d");
  const before = await bar();
  await page.waitForTimeout(250);
  assert.notEqual(await bar(), before, "it moves");
  const names = await page.locator("#gallery .example").count();
  assert.ok(names >= 12 && names <= 16);
  const covers = await page.evaluate(() => {
    const board = document.querySelector("#board").getBoundingClientRect();
    const gallery = document.querySelector("#gallery").getBoundingClientRect();
    const map = document.querySelector("#board .overview").getBoundingClientRect();
    const [x, y] = [board.x + board.width / 2, board.y + board.height / 2];
    return [gallery, map].some((one) => one.left <= x && one.right >= x && one.top <= y && one.bottom >= y);
  });
  assert.equal(covers, false);
  // The pictures are what is found: each thumbnail's curve passes where its example's best linkage does.
  for (let i = 0; i < names; i += 1) {
    await example(page, i);
    assert.ok(await page.locator("#gallery").isHidden());
    await doing(page, "done");
    assert.match(await status(page), /^Best: .* meets everything/);
  }
  await example(page, 1);
  await doing(page, "done");
  assert.match(await page.locator("#strip .quality").first().textContent(), /transmission (3|4|5)\d° \((fair|good)\)/);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a limit on all of the linkage is a slider, a box shows it; a bad name is marked and searching goes on", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  await tab(page, "wishes");
  await page.locator("#pivots").uncheck();
  await page.locator("#extent").fill("3");
  await doing(page, "done");
  assert.match(await page.locator("#extent-said").textContent(), /at most 3 × the path \(\d+ mm\)/);
  assert.equal(await page.locator("#board .ghost:not(.absent)").count(), 1);
  assert.match(await problemText(page), /extent_max = \d/);
  await page.locator("#name").fill("a/b");
  await page.keyboard.press("Tab");
  assert.equal(await page.locator("#name").getAttribute("aria-invalid"), "true");
  assert.match(await page.locator("#name-fault").textContent(), /no \/.*still called walking-leg/);
  await page.locator("#name").fill("con");
  await page.keyboard.press("Tab");
  assert.match(await page.locator("#name-fault").textContent(), /device on Windows/);
  assert.doesNotMatch(await status(page), /cannot be searched/);
  await page.reload();
  await doing(page, "done");
  assert.equal(await page.locator("#name").inputValue(), "walking-leg");
  await tab(page, "build");
  await page.locator("#name").fill("my leg");
  await page.keyboard.press("Tab");
  assert.equal(await page.locator("#name").getAttribute("aria-invalid"), "false");
  const { asked, doing: what } = await page.evaluate(() => ({ ...document.body.dataset }));
  assert.deepEqual([asked, what], ["1", "done"], "a name is searched by nobody");
  assert.match(await problemText(page), /name = "my leg"/);
  // Two thousand points: as many as can be searched are taken of them.
  await tab(page, "points");
  const many = Array.from({ length: 2000 }, (_, i) => {
    const t = (2 * Math.PI * i) / 2000;
    return `${(50 * Math.cos(t)).toFixed(4)}, ${(30 * Math.sin(t) + 4 * Math.cos(2 * t)).toFixed(4)}`;
  });
  await page.locator("#coordinates").fill(many.join("\n"));
  await button(page, "Take these points").click();
  assert.match(await status(page), /These are 2000 points, more than the studio searches: 200 evenly/);
  assert.equal(await page.locator("#point-count").textContent(), "200");
  await doing(page, "done");
  // A number that no screen holds draws no broken path.
  await page.locator("#coordinates").fill("0, 0\n1e300, 4\n20, 5");
  await button(page, "Take these points").click();
  await page.waitForTimeout(300);
  const lines = await page.locator("#board path").evaluateAll((all) => all.map((one) => one.getAttribute("d") ?? ""));
  assert.ok(
    lines.every((d) => !/NaN|Infinity|e\+?\d\d/.test(d)),
    "every path is one",
  );
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("nine points and a box that no linkage meets: the nearest is offered", async () => {
  const { page, said, context, end } = await begun(home);
  await example(page, 5);
  await doing(page, "done");
  const layout = () =>
    page.evaluate(() =>
      ["#board", ".rail", "#status"].map((one) => {
        const { x, y, width, height } = document.querySelector(one).getBoundingClientRect();
        return [x, y, width, one === "#status" ? 0 : height].map(Math.round);
      }),
    );
  const before = await layout();
  await tab(page, "wishes");
  await page.locator("#pivots").check();
  for (const [side, value] of [
    ["left", 200],
    ["right", 210],
    ["bottom", 200],
    ["top", 210],
  ]) {
    await page.locator(`#${side}`).fill(String(value));
    await page.keyboard.press("Tab");
  }
  await doing(page, "done");
  const offer = page.locator("#helps button", { hasText: "instead of exactly through the points" });
  await offer.click();
  await doing(page, "done");
  assert.ok(!(await page.locator("#exact").isChecked()));
  assert.match(await page.locator("#tolerance").inputValue(), /^0\.\d+$/);
  const far = (await layout())
    .slice(0, 2)
    .flat()
    .map((value, k) => Math.abs(value - before.slice(0, 2).flat()[k]));
  assert.ok(Math.max(...far) <= 2, "the layout stays");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("one that is pinned and on the board is compared once; each pin has its colour", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  await button(page, "Pin linkage 1").click();
  await button(page, "Pin linkage 2").click();
  await drawer(page, "searches");
  await button(page, "Compare").click();
  await page.waitForSelector("#comparison tbody tr");
  assert.equal(await page.locator("#comparison tbody tr").count(), 2);
  const colours = await page
    .locator("#strip li[class*=pin-] .pick")
    .evaluateAll((all) => all.map((one) => getComputedStyle(one).borderLeftColor));
  assert.equal(new Set(colours).size, 2);
  // The first one let go, the second keeps its colour.
  await button(page, "Unpin pinned 1").click();
  const left = await page
    .locator("#strip li[class*=pin-] .pick")
    .evaluate((one) => getComputedStyle(one).borderLeftColor);
  assert.equal(left, colours[1]);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("what the page costs while nobody does anything", async () => {
  const { page, context, end } = await begun(home);
  await doing(page, "done");
  const client = await context.newCDPSession(page);
  // The thread's own time: what others take of the machine does not count.
  await client.send("Performance.enable", { timeDomain: "threadTicks" });
  const busy = async () => {
    const { metrics } = await client.send("Performance.getMetrics");
    return metrics.find(({ name }) => name === "TaskDuration").value;
  };
  const load = async () => {
    const [start, from] = [Date.now(), await busy()];
    await page.waitForTimeout(3000);
    return ((await busy()) - from) / ((Date.now() - start) / 1000);
  };
  const bar = () => page.locator("#board .bar").first().getAttribute("d");
  const moves = async () => {
    const before = await bar();
    await page.waitForTimeout(300);
    return (await bar()) !== before;
  };
  await page.waitForTimeout(500);
  const moving = await load();
  assert.ok(await moves());
  // Behind another tab: a browser without a window never says so by itself.
  const hide = (on) =>
    page.evaluate((on) => {
      Object.defineProperty(document, "hidden", { value: on, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }, on);
  await hide(true);
  const hidden = await load();
  assert.equal(await moves(), false, "nothing moves that nobody sees");
  await hide(false);
  assert.ok(await moves(), "seen again it moves on");
  await button(page, "Pause").click();
  const paused = await load();
  const percent = (part) => `${(100 * part).toFixed(1)} %`;
  console.log(
    `main thread while it moves ${percent(moving)} of a core (at most 15), paused ${percent(paused)}, hidden ${percent(hidden)} (at most 5)`,
  );
  if (timing) assert.ok(moving < 0.15 && paused < 0.05 && hidden < 0.05);
  // Nothing moves under reduced motion.
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.reload();
  await doing(page, "done");
  assert.equal(await moves(), false);
  await context.close();
  await end();
});
