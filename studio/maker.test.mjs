// What a maker asks for, in headless Chromium: holes for a motor, the sheet, a box to fit in, how a machine walks, pins
// compared; and that nothing of the work is lost or hidden. See .ci/check-studio.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { begun, button, doing, example, house, problemText, shots, tab } from "./harness.mjs";

const home = house("maker");

const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`) });

/** Waits until the text of a part of the page is like this. */
const says = (page, selector, pattern) =>
  page.waitForFunction(
    ([selector, pattern]) => new RegExp(pattern).test(document.querySelector(selector)?.textContent ?? ""),
    [selector, pattern.source],
  );

/** The radii of the circles on the layers of a drawing, largest first. */
function radii(dxf) {
  const lines = dxf.split(/\r?\n/);
  const found = {};
  let [kind, layer] = ["", ""];
  for (let i = 0; i + 1 < lines.length; i += 2) {
    const [code, value] = [lines[i].trim(), lines[i + 1]];
    if (code === "0") kind = value;
    if (code === "8") layer = value;
    if (code === "40" && kind === "CIRCLE") found[layer] = [...(found[layer] ?? []), Number(value)];
  }
  return Object.fromEntries(Object.entries(found).map(([name, all]) => [name, all.sort((p, q) => q - p)]));
}

test("a motor's shaft and boss have holes of their own, refused where they have no room; the preview shows the sheet", async () => {
  const { page, context, end } = await begun(home);
  await doing(page, "done");
  await tab(page, "build");
  await page.locator("#hole_mm").fill("3");
  await page.locator("#motor_hole_mm").fill("5");
  await page.locator("#boss_hole_mm").fill("12");
  await says(page, "#layers", /Holes 3 mm, at A 5 mm in the crank and 12 mm in the ground/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save-dxf").click()]);
  assert.deepEqual(radii(readFileSync(await download.path(), "utf8")), {
    GROUND: [6, 1.5],
    CRANK: [2.5, 1.5],
    COUPLER: [1.5, 1.5, 1.5],
    FOLLOWER: [1.5, 1.5],
  });
  const ground = () =>
    page.locator("#plates #ground circle").evaluateAll((all) => all.map((one) => one.getAttribute("r")));
  assert.deepEqual(await ground(), ["6", "1.5"]);
  // Too large for the crank: said with the label and what would do; then nothing is saved.
  await page.locator("#motor_hole_mm").fill("500");
  await says(page, "#build .fault", /a hole of 500 mm at A and one of 3 mm at C of the crank/);
  assert.match(await page.locator("#build .fault").textContent(), /choose Motor's shaft at A below \d/);
  assert.ok(await page.locator("#save-dxf").isDisabled());
  await page.locator("#motor_hole_mm").fill("5");
  // The page of the drawing is the sheet, which the preview outlines.
  assert.equal(await page.locator("#plates rect").count(), 0);
  await page.getByLabel("Width of the sheet").fill("420");
  await page.getByLabel("Height of the sheet").fill("310");
  await page.waitForSelector("#plates rect");
  assert.equal(await page.locator("#plates svg").getAttribute("viewBox"), "0 0 420 310");
  const inside = await page.evaluate(() => {
    const sheet = document.querySelector("#plates rect").getBoundingClientRect();
    const all = [...document.querySelectorAll("#plates path")].map((one) => one.getBoundingClientRect());
    return all.every(
      (one) =>
        one.left > sheet.left - 2 &&
        one.right < sheet.right + 2 &&
        one.top > sheet.top - 2 &&
        one.bottom < sheet.bottom + 2,
    );
  });
  assert.ok(inside, "the plates lie on the sheet");
  await shot(page, "maker-build");
  await context.close();
  await end();
});

test("a box to fit in is two numbers, on the board with its size; it holds joints and P", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  const rank = () => page.locator("#fit-width").inputValue();
  await page.locator("#fit-width").fill("230");
  await page.keyboard.press("Tab");
  // One side alone waits for the other, and says which.
  assert.equal(await page.locator("#fit-height").getAttribute("aria-invalid"), "true");
  await page.locator("#fit-height").fill("200");
  await page.keyboard.press("Enter");
  await says(page, "#desk-said", /Joints and P stay in the box .*plates reach past it/);
  await doing(page, "done");
  assert.deepEqual([await rank(), await page.locator("#fit-height").inputValue()], ["230", "200"]);
  assert.match(await page.locator("#board svg").first().textContent(), /all joints and P in here, 230 × 200 mm/);
  const [, ...sides] = (await problemText(page)).match(/footprint_in = \[(.*), (.*), (.*), (.*)\]/);
  const [left, low, right, high] = sides.map(Number);
  assert.ok(Math.abs(right - left - 230) < 1e-9 && Math.abs(high - low - 200) < 1e-9, `${sides}`);
  // Around the path, whole.
  assert.ok(left < -37.6 && right > 37.6 && low <= 0 && high >= 12.9, `${sides}`);
  // One that is emptied takes the box away.
  await page.locator("#fit-width").fill("");
  await page.keyboard.press("Tab");
  assert.equal(await page.locator("#fit-height").inputValue(), "");
  assert.doesNotMatch(await problemText(page), /footprint_in/);
  await tab(page, "wishes");
  await page.locator("#more-requirements summary").click();
  assert.match(await page.locator("#more-requirements").textContent(), /counts joints and P, not the plates/);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a machine says how it walks where it has a ground to walk on", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  const card = () => page.locator("#strip .pick").first().textContent();
  const gait = /steps ([\d.]+) mm, foot lifted ([\d.]+) mm, hips bob ([\d.]+) mm/;
  const [, long, lift, bob] = (await card()).match(gait).map(Number);
  // As the curve on the board has it: two legs, half a turn apart, the lower foot on the ground.
  const drawn = await page.evaluate(() => {
    const d = document.querySelector("#board .figure:not(.absent, .second) .curve").getAttribute("d");
    return d.match(/-?[\d.]+/g).map(Number);
  });
  const feet = Array.from({ length: drawn.length / 2 - 1 }, (_, i) => [drawn[2 * i], -drawn[2 * i + 1]]);
  const wide = Math.max(...feet.map((p) => p[0])) - Math.min(...feet.map((p) => p[0]));
  const width = Number(await page.locator("#path-width").inputValue());
  const spots = await page
    .locator("#board .handle")
    .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().x));
  const scale = width / (Math.max(...spots) - Math.min(...spots));
  const half = feet.length / 2;
  const other = (i) => feet[(i + half) % feet.length];
  const heights = feet.map((foot, i) => Math.min(foot[1], other(i)[1]));
  const lifts = feet.map((foot, i) => foot[1] - other(i)[1]);
  const near = (said, value) =>
    assert.ok(Math.abs(said - scale * value) < 0.03 * scale * value + 0.05, `${said} ${scale * value}`);
  near(bob, Math.max(...heights) - Math.min(...heights));
  near(lift, Math.max(...lifts));
  const step = feet.reduce(
    (sum, foot, i) => (foot[1] < other(i)[1] ? sum + feet[(i + 1) % feet.length][0] - foot[0] : sum),
    0,
  );
  near(long, Math.abs(step));
  assert.ok(long <= scale * wide * 1.01);
  await page.getByLabel("two legs").uncheck();
  assert.doesNotMatch(await card(), /steps/);
  await page.getByLabel("two legs").check();
  assert.match(await card(), gait);
  await example(page, 2);
  await doing(page, "done");
  assert.doesNotMatch(await card(), /steps/);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("what is pinned is compared in a table; over another path it has no error lines", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  const whiskers = () => page.locator("#board .whisker").getAttribute("d");
  assert.notEqual(await whiskers(), "");
  assert.ok(await page.locator("#compare").isHidden());
  await button(page, "Pin linkage 1").click();
  await button(page, "Pin linkage 2").click();
  await button(page, "Compare the pinned").click();
  await page.waitForSelector("#comparison tbody tr");
  assert.deepEqual(await page.locator("#comparison thead th").allTextContents(), [
    "linkage",
    "rms mm",
    "largest",
    "transmission",
    "ratio",
    "extent",
    "longest link",
    "type",
    "accepted",
  ]);
  const rows = await page
    .locator("#comparison tbody tr")
    .evaluateAll((all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
  assert.deepEqual(rows.map(([name]) => name.replace(/^\d\. /, "")).sort(), ["pinned 1", "pinned 2"]);
  for (const row of rows) for (const i of [1, 2, 3, 4, 5, 6]) assert.ok(Number.parseFloat(row[i]) > 0, `${row}`);
  // The longest link as its card has it: so many times the path.
  const card = await page.locator(".pick", { hasText: "Pinned 1" }).textContent();
  const [, times, whole] = card.match(/longest link ([\d.]+) × the path, whole ([\d.]+)/).map(Number);
  const first = rows.find(([name]) => name.endsWith("pinned 1"));
  const size = Math.hypot(75.2, 12.9);
  assert.ok(Math.abs(Number(first[6]) / size - times) < 0.06, `${first} ${times}`);
  assert.ok(Math.abs(Number(first[5]) / size - whole) < 0.06, `${first} ${whole}`);
  await shot(page, "maker-compare");
  await page.locator("#searches > summary").click();
  await example(page, 6);
  await doing(page, "done");
  await page.locator(".pick", { hasText: "Pinned 1" }).click();
  assert.equal(await whiskers(), "", "its errors are not those to this path");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a linkage in the hand survives a reload; Clear lays the tool down that draws a box", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  await button(page, "Grab").click();
  const crank = page.locator(".lengths input[type=number]").first();
  const longer = String(Number((1.04 * Number(await crank.inputValue())).toPrecision(4)));
  await crank.fill(longer);
  await crank.press("Tab");
  await says(page, "#by-hand strong", /Changed by hand/);
  await page.waitForTimeout(600);
  const figures = await page.locator("#by-hand").textContent();
  await page.reload();
  await page.waitForSelector("#by-hand:not([hidden])");
  assert.equal(await crank.inputValue(), longer);
  assert.equal(await page.locator("#by-hand").textContent(), figures);
  assert.equal(await page.locator("#tool-grab").getAttribute("aria-pressed"), "true");
  assert.equal(await page.locator("#play").textContent(), "Play", "what is in the hand stands still");
  await button(page, "Let go").click();
  assert.equal(await page.locator("#play").textContent(), "Pause");
  await page.waitForTimeout(600);
  await page.reload();
  await doing(page, "done");
  assert.ok(await page.locator("#by-hand").isHidden(), "what was let go stays so");
  await tab(page, "wishes");
  await button(page, "Draw the box for the pivots").click();
  const pressed = (id) => page.locator(`#tool-${id}`).getAttribute("aria-pressed");
  assert.equal(await pressed("pivots_in"), "true");
  await button(page, "Clear").click();
  assert.deepEqual([await pressed("pivots_in"), await pressed("draw")], ["false", "true"]);
  // Points that are clicked anew go on being clicked.
  await button(page, "Points").click();
  await button(page, "Clear").click();
  assert.equal(await pressed("points"), "true");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("on a phone the width of the path lies over no linkage, where there is room beside it", async () => {
  const { page, said, context, end } = await begun(home, [], {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  const clear = async () => {
    // The joints and the middles of the links over the motion.
    return page.evaluate(async () => {
      const chip = document.querySelector(".size-chip").getBoundingClientRect();
      const turn = document.querySelector("#turn");
      const all = [];
      for (let i = 0; i < 24; i += 1) {
        turn.value = String(i / 24);
        turn.dispatchEvent(new Event("input"));
        await new Promise(requestAnimationFrame);
        const spots = [...document.querySelectorAll("#board .figure:has(.letter) > .pin")].map((one) => {
          const box = one.getBoundingClientRect();
          return [box.x + box.width / 2, box.y + box.height / 2];
        });
        const [a, b, c, d] = spots;
        const middle = (p, q) => [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
        all.push(...spots, middle(a, c), middle(b, d), middle(c, d));
      }
      const under = (left, top) =>
        all.filter(([x, y]) => x > left && x < left + chip.width && y > top && y < top + chip.height).length;
      const stage = document.querySelector("#stage").getBoundingClientRect();
      let least = Infinity;
      for (let left = stage.left; left + chip.width < stage.right; left += 10)
        for (let top = stage.top; top + chip.height < stage.bottom - 34; top += 10)
          least = Math.min(least, under(left, top));
      return { covered: under(chip.left, chip.top), least };
    });
  };
  for (const number of [0, 1, 2, 3, 4]) {
    await example(page, number);
    await doing(page, "done");
    await button(page, "Show all").click();
    const { covered, least } = await clear();
    // A joint that goes round may pass beneath it for a moment.
    assert.ok(
      covered <= least + 4,
      `example ${number}: ${covered} of 168 spots beneath it, ${least} in the best place`,
    );
  }
  await shot(page, "maker-phone");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});
