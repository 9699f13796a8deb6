// What a person reads on the page: one word for one thing, the whole status on a phone, what is in the file to cut.
// See .ci/check-studio.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { begun, button, doing, drawer, example, house, shots, status, tab } from "./harness.mjs";

const home = house("reading");
const problems = new URL("../problems/", import.meta.url).pathname;
const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`) });

/** Where an element is on the page. */
const placed = (page, selector) =>
  page.evaluate((selector) => {
    const { left, top, right, bottom, height } = document.querySelector(selector).getBoundingClientRect();
    return { left, top, right, bottom, height };
  }, selector);

test("what limits a linkage and what it does not meet is called as the controls are, everywhere", async () => {
  const { page, said, context, end } = await begun(home, [join(problems, "examples/pivot-box.toml")]);
  await doing(page, "done");
  await drawer(page, "details");
  await page.waitForSelector(".details-words table.requirements");
  const text = await page.evaluate(() => {
    const words = document.querySelector(".details-words").cloneNode(true);
    for (const one of words.querySelectorAll("pre")) one.remove();
    return words.textContent;
  });
  assert.match(text, /both fixed pivots inside a box/);
  assert.match(text, /not: .*least transmission angle/, "a cognate");
  for (const key of [/_(in|min|max)\b/, /[xy]m(in|ax)\b/, /fixed pivots inside(?! a box)/, /longest to shortest/])
    assert.doesNotMatch(text, key);
  await shot(page, "words-of-details");
  // Made narrower than any linkage: cards and status say the same words.
  await drawer(page, "details");
  await tab(page, "wishes");
  for (const [side, value] of [
    ["left", 1000],
    ["right", 1001],
  ].reverse()) {
    await page.locator(`#${side}`).fill(String(value));
    await page.locator(`#${side}`).press("Tab");
  }
  await doing(page, "done");
  assert.match(await page.locator("#strip").textContent(), /not met: [^A-Z]*both fixed pivots inside a box/);
  assert.match(await status(page), /“both fixed pivots inside a box”/);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("the Build tab says what is in the file to cut; Clear says what goes with the path", async () => {
  const { page, said, context, end } = await begun(home);
  await example(page, 0);
  await doing(page, "done");
  await tab(page, "build");
  const note = page.locator("#cutting");
  await page.waitForSelector("#plates:not([hidden]) svg path");
  assert.match(await note.textContent(), /^Red is to cut.*layer MARK/);
  await page.locator("#kerf_mm").fill("0.15");
  await note.filter({ hasText: /^The kerf of 0.15 mm is in the DXF already/ }).waitFor();
  await button(page, "Clear").click();
  assert.match(
    await status(page),
    /^Cleared, with what was asked: driven by, least transmission angle, both fixed pivots inside a box\. Undo/,
  );
  await note.waitFor({ state: "hidden" });
  await button(page, "Undo").click();
  await tab(page, "wishes");
  assert.equal(await page.locator("#transmission").inputValue(), "30");
  // What a slider says moves none of the controls below it.
  const before = await placed(page, "#transmission");
  for (const times of [1, 9.75, 10]) {
    for (const id of ["longest", "extent"])
      await page.locator(`#${id}`).evaluate((slider, times) => {
        slider.value = times;
        slider.dispatchEvent(new Event("input"));
      }, times);
    assert.deepEqual(await placed(page, "#transmission"), before, String(times));
  }
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("the width of the path stands beside the corners of a box", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  await tab(page, "wishes");
  await page.locator("#pivots").uncheck();
  const board = await placed(page, "#board svg");
  const chip = await placed(page, ".size-chip");
  for (const [x, y] of [
    [chip.left + 30, chip.top + 15],
    [chip.right - 4, chip.bottom - 2],
    [board.left + 4, chip.bottom + 20],
  ]) {
    await page.locator("#tool-pivots_in").evaluate((tool) => tool.click());
    await page.mouse.move(board.left + 420, board.top + 300);
    await page.mouse.down();
    await page.mouse.move(x, y, { steps: 4 });
    await page.mouse.up();
    const now = await placed(page, ".size-chip");
    const corners = await page.locator("#board .corner").evaluateAll((all) =>
      all.map((one) => {
        const { left, top, right, bottom } = one.getBoundingClientRect();
        return { left, top, right, bottom };
      }),
    );
    assert.equal(corners.length, 4);
    for (const one of corners)
      assert.ok(
        one.right < now.left || one.left > now.right || one.bottom < now.top || one.top > now.bottom,
        JSON.stringify([one, now]),
      );
  }
  await page.locator("#pivots").uncheck();
  assert.deepEqual(await placed(page, ".size-chip"), chip, "back at its place");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

for (const [width, height] of [
  [390, 844],
  [844, 390],
])
  test(`on a phone of ${width} by ${height} a tap shows the whole status, and the panel can have more room`, async () => {
    const options = { viewport: { width, height }, hasTouch: true, isMobile: true };
    const { page, said, context, end } = await begun(home, [], options);
    await doing(page, "done");
    const seen = () =>
      page.locator("#status").evaluate((one) => {
        const lines = (part) => Math.round((10 * part) / Number.parseFloat(getComputedStyle(one).lineHeight)) / 10;
        const padding = Number.parseFloat(getComputedStyle(one).paddingTop) * 2;
        return { shown: lines(one.clientHeight - padding), all: lines(one.scrollHeight - padding) };
      });
    const before = await seen();
    assert.ok(before.shown > 1.8 && before.all >= 3, JSON.stringify(before));
    const board = await placed(page, "#stage");
    await page.locator("#status").tap();
    const whole = await seen();
    assert.ok(whole.shown > 2.8 && whole.all <= whole.shown, JSON.stringify(whole));
    assert.deepEqual(await placed(page, "#stage"), board, "the board stays");
    await shot(page, `status-${width}`);
    await page.locator("#status").tap();
    assert.deepEqual(await seen(), before);
    const more = page.getByRole("button", { name: "More room for this panel" });
    if (width < height) {
      const low = await placed(page, "#panel-linkages");
      await more.tap();
      const tall = await placed(page, "#panel-linkages");
      assert.ok(tall.height > 2 * low.height && tall.bottom <= height, JSON.stringify([low, tall]));
      await tab(page, "wishes");
      await shot(page, `tall-${width}`);
      assert.ok((await placed(page, "#panel-wishes")).height > 0.55 * height);
      await more.tap();
      assert.deepEqual(await placed(page, "#stage"), board, "the board stays");
    } else assert.ok(await more.isHidden(), "it has the whole height");
    assert.deepEqual(said, []);
    await context.close();
    await end();
  });
