// What turns a linkage, in headless Chromium: a weight at P, a spring that two clicks draw, the torque under the board. See
// .ci/check-studio.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { begun, doing, house, shots, tab } from "./harness.mjs";

const home = house("loads");

const says = (page, selector, pattern) =>
  page.waitForFunction(
    ([selector, pattern]) => new RegExp(pattern).test(document.querySelector(selector)?.textContent ?? ""),
    [selector, pattern.source],
  );

/** The largest torque that the panel tells, N m. */
async function peak(page) {
  const text = await page.locator("#torque-words").textContent();
  return Math.abs(Number(/peak of\s+(-?[\d.e-]+) N m/.exec(text)[1]));
}

test("a weight at P takes torque, a spring of two clicks changes it, and both are there after a reload", async () => {
  const { page, context, end } = await begun(home);
  await doing(page, "done");
  await tab(page, "build");
  assert.ok(await page.locator("#torque").isHidden());
  await page.locator("#loads > summary").click();
  await page.locator("#weight_kg").fill("2");
  await says(page, "#torque-words", /peak of/);
  await page.waitForSelector("#torque .curve");
  const weight = await peak(page);
  const changes = async (act) => {
    const before = await page.locator("#torque-words").textContent();
    await act();
    await page.waitForFunction((before) => document.querySelector("#torque-words").textContent !== before, before);
  };
  await changes(() => page.locator("#weight_kg").fill("4"));
  assert.ok(Math.abs((await peak(page)) / weight - 2) < 1e-3, "twice the weight takes twice the torque");

  // From P, wherever it is now, to a fixed point.
  await page.locator("#play").click();
  await page.locator("#add-spring").click();
  const point = await page.locator(".board .figure:not(.second, .absent) .tracer").boundingBox();
  const stage = await page.locator("#stage").boundingBox();
  await page.mouse.click(point.x + point.width / 2, point.y + point.height / 2);
  await page.mouse.click(stage.x + stage.width / 2, stage.y + stage.height / 2);
  await says(page, "#loads .spring", /^P to /);
  assert.equal(await page.locator(".board .springs path").count(), 1);
  assert.match(await page.locator("#add-spring").textContent(), /Add a spring/);
  await changes(() => page.getByLabel("Rate of spring 1").fill("0.05"));
  if (shots) await page.screenshot({ path: join(shots, "loads.png") });

  await page.reload();
  await doing(page, "done");
  await tab(page, "build");
  await says(page, "#loads .spring", /^P to /);
  assert.equal(await page.locator("#weight_kg").inputValue(), "4");
  assert.equal(await page.getByLabel("Rate of spring 1").inputValue(), "0.05");
  // Taken away, it pulls no more; Escape gives one up that has begun.
  await page.getByLabel("Take spring 1 away").click();
  assert.equal(await page.locator("#loads .spring").count(), 0);
  await page.locator("#add-spring").click();
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("#add-spring").getAttribute("aria-pressed"), "false");
  await context.close();
  await end();
});
