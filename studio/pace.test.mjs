// How fast the page answers and draws, measured in the page; asserted with TIMING=1 alone. See .ci/check-studio.

import assert from "node:assert/strict";
import { test } from "node:test";
import { begun, button, doing, example, house, timing } from "./harness.mjs";

const home = house("pace");

const median = (list) => [...list].sort((x, y) => x - y)[list.length >> 1];

/** Draws a closed path of 60 points, another one for each number. */
async function drawn(page, number) {
  const box = await page.locator("#board svg").first().boundingBox();
  const at = (t) => [
    box.x + box.width * (0.5 + (0.18 + 0.01 * number) * Math.cos(t)),
    box.y + box.height * (0.45 + 0.2 * Math.sin(t) + 0.04 * Math.cos(2 * t + number)),
  ];
  // On an empty board: a stroke that begins on a point of the one before would drag that.
  await button(page, "Clear").click();
  await page.mouse.move(...at(0));
  await page.mouse.down();
  for (let i = 1; i <= 80; i += 1) await page.mouse.move(...at((i * 2 * Math.PI) / 80));
  await page.mouse.up();
}

/** Counts the frames of the page and those in which the crank on the board has moved, a second, while something is done. */
async function frames(page, act) {
  await page.evaluate(() => {
    const crank = document.querySelector("#board .crank");
    window.seen_ = { frames: 0, pictures: 0, since: performance.now() };
    let before = "";
    const count = () => {
      const now = crank.getAttribute("d");
      window.seen_.frames += 1;
      window.seen_.pictures += Number(now !== before);
      before = now;
      window.counting_ = requestAnimationFrame(count);
    };
    window.counting_ = requestAnimationFrame(count);
  });
  await act();
  return page.evaluate(() => {
    cancelAnimationFrame(window.counting_);
    const seconds = (performance.now() - window.seen_.since) / 1000;
    return { frames: window.seen_.frames / seconds, pictures: window.seen_.pictures / seconds };
  });
}

/** Drags a point to and fro for three seconds; gives the frames, and the re-fits that were painted, a second. */
async function dragged(page, place, pixels) {
  const [x, y] = await page.evaluate((place) => {
    const { x, y, width, height } = document.querySelectorAll(".handle")[place].getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  }, place);
  await page.evaluate(() => performance.clearMeasures());
  await page.mouse.move(x, y);
  await page.mouse.down();
  const seen = await frames(page, async () => {
    const start = Date.now();
    for (let i = 1; Date.now() - start < 3000; i += 1) await page.mouse.move(x, y + pixels * Math.sin(i / 12));
  });
  await page.mouse.up();
  const gaps = await page.evaluate(() => performance.getEntriesByName("re-fit").map((one) => one.duration));
  assert.ok(gaps.length >= 2, `${gaps.length} re-fits in three seconds`);
  return { ...seen, gaps, rate: (1000 * gaps.length) / gaps.reduce((sum, gap) => sum + gap, 0) };
}

const inWords = ({ rate, gaps }) =>
  `${rate.toFixed(1)} a second (median gap ${median(gaps).toFixed(0)} ms, ${gaps.length} gaps)`;

test("how fast it answers", async () => {
  const { page, context, end } = await begun(home);
  await doing(page, "done");
  for (let stroke = 0; stroke < 9; stroke += 1) {
    await drawn(page, stroke);
    await page.waitForFunction((n) => performance.getEntriesByName("first candidate").length > n, stroke, {
      timeout: 30_000,
    });
    await page.waitForTimeout(150);
  }
  assert.equal(await page.locator("#point-count").textContent(), "60");
  const firsts = await page.evaluate(() => performance.getEntriesByName("first candidate").map((one) => one.duration));
  console.log(
    `first candidate on the screen, 60 points, measured in the page: ${median(firsts).toFixed(0)} ms after the pen went up (median of ${firsts.length}: ${firsts.map((ms) => ms.toFixed(0)).join(" ")}); at most 300`,
  );
  await doing(page, "done");
  const seen = await dragged(page, 2, 25);
  console.log(
    `re-fits on the screen while dragging one of 60 points, measured in the page: ${inWords(seen)}; at least 30`,
  );
  console.log(`frames while dragging one of 60 points: ${seen.frames.toFixed(1)} a second; at least 55`);
  if (timing) assert.ok(median(firsts) < 300 && seen.rate >= 30 && seen.frames >= 55);
  assert.ok(median(firsts) < 10_000);
  await context.close();
  await end();
});

test("how fast all linkages through nine points follow a point", async () => {
  const { page, context, end } = await begun(home);
  await example(page, 5);
  await doing(page, "done");
  const seen = await dragged(page, 2, 8);
  console.log(`nine-point updates on the screen while dragging a point: ${inWords(seen)}; at least 15`);
  if (timing) assert.ok(seen.rate >= 15);
  await context.close();
  await end();
});

test("how many frames a phone has", async () => {
  const { page, context, end } = await begun(home, [], {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  await doing(page, "done");
  const turning = await frames(page, () => page.waitForTimeout(3000));
  console.log(
    `frames at 390x844 while the linkage turns: ${turning.frames.toFixed(1)} a second, at least 59, in ${turning.pictures.toFixed(1)} of them it has moved`,
  );
  await drawn(page, 0);
  await doing(page, "done");
  const seen = await dragged(page, 2, 25);
  console.log(
    `frames at 390x844 while dragging one of 60 points: ${seen.frames.toFixed(1)} a second; at least 59; re-fits ${inWords(seen)}`,
  );
  if (timing) assert.ok(turning.frames >= 59 && seen.frames >= 59);
  await context.close();
  await end();
});
