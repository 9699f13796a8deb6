// The board keeps its view, its size and what stood on it: see .ci/check-studio.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { begun, button, doing, example, house, shots, status, tab } from "./harness.mjs";

const home = house("board");

const scale = (page) => page.locator(".scale").getAttribute("d");
const width = async (page) => Number(await page.locator("#path-width").inputValue());
const linkages = (page) => page.locator("#strip li .figures").allTextContents();

/** The extent of the drawn path in pixels. */
const extent = (page) =>
  page.evaluate(() => {
    const { width, height } = document.querySelector(".target-line").getBoundingClientRect();
    return [width, height];
  });

/** Asks for a motor and a fair transmission angle. */
async function asked(page) {
  await page.locator("#type").selectOption("motor");
  await page.locator("#transmission").fill("30");
  await page.keyboard.press("Tab");
}

/** Draws a closed path about the middle of the board; its points are parts of 100 pixels. */
async function drawn(page, at) {
  const box = await page.locator("#board svg").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const place = (t) => at(t).map((value, k) => (k === 0 ? x + 100 * value : y - 100 * value));
  await page.mouse.move(...place(0));
  await page.mouse.down();
  for (let i = 1; i <= 70; i += 1) await page.mouse.move(...place((i * 2 * Math.PI) / 70));
  await page.mouse.up();
}

/** A drop, which several linkages draw: the closest of them is called so. */
const drop = (t) => [Math.cos(t) + 0.3 * Math.cos(2 * t), 0.6 * Math.sin(t) + 0.2 * Math.sin(2 * t)];
const egg = (t) => [0.9 * Math.cos(t) + 0.1 * Math.cos(2 * t), 0.5 * Math.sin(t)];
const near = (one, other, part) => Math.abs(one - other) <= part * other;

test("the same stroke has the same size, whatever was answered; steps back bring back what stood there", async () => {
  const { page, said, context, end } = await begun(home);
  await button(page, "Clear").click();
  const first = await scale(page);
  const sizes = [];
  for (let i = 0; i < 5; i += 1) {
    await drawn(page, egg);
    await doing(page, "done");
    sizes.push([...(await extent(page)), await width(page)]);
    assert.equal(await scale(page), first);
  }
  for (const size of sizes)
    assert.ok(
      size.every((value, k) => near(value, sizes[0][k], 0.02)),
      String(size),
    );
  assert.ok(near(sizes[0][2], sizes[0][0] / 3, 0.03), "a millimetre has three pixels");

  // Thirteen shapes, each after Clear.
  for (let k = 0; k < 13; k += 1) {
    await button(page, "Clear").click();
    await drawn(page, (t) => [(0.3 + 0.05 * k) * Math.cos(t), 0.4 * Math.sin(t) + 0.02 * k * Math.cos(3 * t)]);
  }
  assert.equal(await scale(page), first);
  await button(page, "Clear").click();

  // Steps back: the linkages and the chosen one of each.
  await asked(page);
  const stood = [];
  for (let k = 0; k < 6; k += 1) {
    await drawn(page, (t) => [(0.7 + 0.08 * k) * Math.cos(t) + 0.25 * k, 0.4 * Math.sin(t) + 0.1 * Math.cos(2 * t)]);
    await doing(page, "done");
    await page.locator("#strip .pick").last().click();
    stood.push([await linkages(page), await extent(page)]);
  }
  for (const [cards, size] of stood.slice(0, -1).reverse()) {
    await button(page, "Undo").click();
    assert.deepEqual(await linkages(page), cards, "at once");
    await doing(page, "done");
    assert.deepEqual(await linkages(page), cards, "and when the search has ended");
    assert.deepEqual(await extent(page), size);
    assert.equal(await page.locator("#strip .pick").last().getAttribute("aria-pressed"), "true");
  }
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("the size is a number on the board; the longest link is a wish; a refusal can be read", async () => {
  const { page, said, context, end } = await begun(home);
  await button(page, "Clear").click();
  assert.ok(!(await page.locator("#closed").isChecked()), "no path is closed before it is drawn");
  assert.deepEqual(
    [await page.locator("#type").inputValue(), await page.locator("#pivots").isChecked()],
    ["any", false],
    "and nothing is asked",
  );
  await asked(page);
  await drawn(page, drop);
  await doing(page, "done");
  const [picture, bar] = [await extent(page), await scale(page)];
  assert.match(await page.locator("#strip .quality").first().textContent(), /close: [\d.]+ % of the path/);
  assert.match(await page.locator("#strip .quality").first().textContent(), /longest link [\d.]+ × the path/);
  assert.match(await page.locator("#strip .tags").first().textContent(), /closest/);
  await page.locator("#path-width").fill("300");
  await page.locator("#path-width").press("Enter");
  await doing(page, "done");
  assert.deepEqual(await extent(page), picture, "the picture stays");
  assert.notEqual(await scale(page), bar);
  assert.equal(await width(page), 300);
  await button(page, "Undo").click();
  assert.deepEqual(await extent(page), picture);
  assert.equal(await scale(page), bar);

  // A shorter longest link is held, and said.
  await page.locator("#longest").fill("1.5");
  await doing(page, "done");
  assert.match(await page.locator("#longest-said").textContent(), /1\.5 × the path/);
  const longest = await page.locator("#strip .quality").allTextContents();
  for (const text of longest) assert.ok(Number(text.match(/longest link ([\d.]+)/)[1]) <= 1.5, text);
  await page.locator("#longest").fill("10");
  await doing(page, "done");
  assert.match(await page.locator("#longest-said").textContent(), /any/);

  // A text that is refused while the search answers: the refusal stays.
  await tab(page, "points");
  await page.locator("#coordinates").fill("1, 2\nthree, 4");
  await tab(page, "wishes");
  await page.locator("#longest").fill("4");
  await tab(page, "points");
  await page.locator("#take-coordinates").click();
  await page.waitForFunction(() => document.querySelector("#status").textContent.startsWith("These are no"));
  await page.waitForTimeout(3500);
  assert.match(await status(page), /^These are no coordinates/);
  await page.waitForFunction(() => document.querySelector("#status").textContent.startsWith("Best"));
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a card, the status and the whole path are in sight at every size, and the page has no scroll bar", async () => {
  const { page, said, context, end } = await begun(home);
  for (const [wide, high] of [
    [1280, 900],
    [1920, 1080],
    [1440, 700],
    [844, 390],
    [390, 844],
  ]) {
    for (const colorScheme of ["light", "dark"]) {
      await page.setViewportSize({ width: wide, height: high });
      await page.emulateMedia({ colorScheme });
      await page.evaluate(() => [sessionStorage, localStorage].forEach((one) => void one.clear()));
      await page.reload();
      await page.waitForSelector("#strip li");
      await doing(page, "done");
      const outside = await page.evaluate(() => {
        const board = document.querySelector("#board").getBoundingClientRect();
        const within = (one, { left, top, right, bottom }) =>
          one.left >= left - 1 && one.top >= top - 1 && one.right <= right + 1 && one.bottom <= bottom + 1;
        const window = { left: 0, top: 0, right: innerWidth, bottom: innerHeight };
        const path = document.querySelector(".target-line").getBoundingClientRect();
        const seen = { status: "#status", card: "#strip li .pick svg", title: "#strip li strong" };
        const out = Object.entries(seen).filter(
          ([, one]) => !within(document.querySelector(one).getBoundingClientRect(), window),
        );
        if (!within(path, board) || !within(board, window)) out.push(["path"]);
        if (document.documentElement.scrollHeight > innerHeight) out.push(["down"]);
        if (document.documentElement.scrollWidth > innerWidth) out.push(["aside"]);
        return out.map(([name]) => name);
      });
      if (shots) await page.screenshot({ path: join(shots, `board-${wide}-${colorScheme}.png`) });
      assert.deepEqual(outside, [], `${wide} x ${high}`);
    }
  }
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("nine points with all their linkages change no layout", async () => {
  const { page, said, context, end } = await begun(home);
  await doing(page, "done");
  const layout = () =>
    page.evaluate(() =>
      ["#board", "#board > :first-child", ".rail", "#status", ".tabs", "#desk"].map((one) => {
        const { x, y, width, height } = document.querySelector(one).getBoundingClientRect();
        return [one, x, y, width, height].join(" ");
      }),
    );
  const counts = [];
  for (const [wide, high] of [
    [1280, 900],
    [1440, 700],
    [844, 390],
    [390, 844],
  ]) {
    await page.setViewportSize({ width: wide, height: high });
    await example(page, 0);
    await doing(page, "done");
    const before = await layout();
    await example(page, 5);
    await doing(page, "done");
    counts.push(await page.locator("#strip li").count());
    assert.deepEqual(await layout(), before, `${wide} x ${high}`);
    const all = await page.evaluate(() => [document.documentElement.scrollHeight - innerHeight, scrollY]);
    assert.ok(all[0] <= 0 && all[1] === 0, "no page scroll");
    if (shots) await page.screenshot({ path: join(shots, `nine-${wide}.png`) });
  }
  // Cards out of sight draw nothing.
  const [drawn, cards] = await page.evaluate(() => [
    [...document.querySelectorAll("#strip .bar")].filter((one) => one.getAttribute("d")).length,
    document.querySelectorAll("#strip li").length,
  ]);
  console.log(`${counts[0]} linkages through nine points; ${drawn} of ${cards} cards are drawn`);
  assert.ok(counts[0] > 12 && drawn < cards);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});
