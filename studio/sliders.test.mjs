// Linkages with a slider in headless Chromium: asked for, drawn, dragged, saved. See .ci/check-studio.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { button, doing, drawer, house, problemText, shots, begun as started, tab } from "./harness.mjs";

const home = house("sliders");
const examples = new URL("../problems/examples/", import.meta.url).pathname;

const begun = (...options) => started(home, options);
const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
/** Which shapes of the linkage on the board are seen. */
const seen = (page) =>
  page.evaluate(() =>
    ["guide", "block", "letter"].map(
      (name) =>
        document.querySelectorAll(`#stage .figure:not(.absent) .${name}:not(.absent)[d], .${name}:not(.absent)[x]`)
          .length,
    ),
  );
const kinds = (page) => page.locator("#strip .figures").allTextContents();

async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

/** Drags the point that lies first on the board, in steps; says what the cards were on the way. */
async function dragPoint(page, index, [dx, dy], steps = 12) {
  const place = await page.evaluate((index) => {
    const { x, y, width, height } = document.querySelectorAll("#stage [data-point]")[index].getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  }, index);
  await page.mouse.move(...place);
  await page.mouse.down();
  const on = [];
  for (let i = 1; i <= steps; i += 1) {
    await page.mouse.move(place[0] + (dx * i) / steps, place[1] + (dy * i) / steps);
    await page.waitForTimeout(60);
    on.push(await kinds(page));
  }
  await page.mouse.up();
  return on;
}

test("a slider-crank is asked for, follows a point, and is saved to be built", async () => {
  const { page, said, end } = await begun(join(examples, "walking-stride-slider.toml"));
  await doing(page, "done");
  await tab(page, "wishes");
  // The file asks for two kinds.
  assert.equal(await page.locator("#kind").inputValue(), "as-given");
  await page.locator("#kind").selectOption("slider-crank");
  await page.waitForSelector("label:not([hidden]) > #slide-full");
  await doing(page, "done");
  const first = await kinds(page);
  assert.ok(first.length > 0 && first.every((text) => /slider-crank/.test(text)), String(first));
  // Its rail and its block are drawn, and no second pivot.
  const [guides, blocks] = await seen(page);
  assert.ok(guides >= 1 && blocks >= 1, `${guides} ${blocks}`);
  assert.equal(await page.locator("#stage .figure:not(.absent) .stand:not(.absent)").count(), 1);
  assert.equal(await page.locator("#kind").inputValue(), "slider-crank");
  await shot(page, "slider-crank");
  // A point that is dragged takes the linkage along.
  const before = await page.locator("#stage .figure:not(.absent) .curve").last().getAttribute("d");
  const on = await dragPoint(page, 3, [6, 9]);
  assert.ok(on.every((cards) => cards.length > 0 && cards.every((text) => /slider-crank/.test(text))));
  await doing(page, "done");
  assert.notEqual(await page.locator("#stage .figure:not(.absent) .curve").last().getAttribute("d"), before);
  // What is asked stands in the problem file, and its file and its plates are those of a slider-crank.
  assert.match(await problemText(page), /mechanism = \["slider-crank"\]/);
  const file = await saved(page, () => button(page, "Linkage file").click());
  assert.match(String(file.bytes), /\[slider_crank\]/);
  await drawer(page, "details");
  await page.waitForSelector("#details .details-charts figure");
  assert.ok((await page.locator("#details .stage .guide:not(.absent)").count()) > 0);
  for (const [format, says] of [
    ["dxf-plates", /AC1015/],
    ["scad", /module/],
    ["toml", /slider_crank/],
  ]) {
    await page.locator("#format").selectOption(format);
    const { bytes } = await saved(page, () => page.locator("#export").click());
    assert.match(String(bytes), says, format);
  }
  await shot(page, "slider-crank-details");
  await tab(page, "build");
  await page.waitForSelector("#build svg");
  assert.deepEqual(said, []);
  await end();
});

test("other kinds are one choice away, with the wishes that they have", async () => {
  const points = Array.from({ length: 12 }, (_, i) => {
    const angle = (Math.PI * i) / 6;
    return `[${60 * Math.cos(angle)}, ${25 * Math.sin(angle) + 6 * Math.cos(2 * angle)}]`;
  });
  const file = join(home.work, "bean.toml");
  const path = `[task.path]\nclosed = true\npoints = [${points.join(", ")}]\n`;
  writeFileSync(file, `format = 1\nunit = "mm"\n${path}[solve]\nevaluations = 20000\nadvice = false\n`);
  const { page, said, end } = await begun(file);
  await doing(page, "done");
  await tab(page, "wishes");
  await page.locator("#type").selectOption("motor");
  await doing(page, "done");
  await page.locator("#kind").selectOption("inverted-slider-crank");
  await page.waitForSelector("label:not([hidden]) > #slide-full");
  await doing(page, "done");
  assert.ok(
    (await kinds(page)).every((text) => /inverted-slider-crank/.test(text)),
    String(await kinds(page)),
  );
  await shot(page, "inverted-slider-crank");
  await tab(page, "wishes");
  // A motor stays a motor; a stroke belongs to a slider-crank alone.
  assert.ok(await page.locator("#slide-full").isChecked());
  assert.ok(await page.locator("#slide-stroke").isHidden());
  assert.ok(await page.locator("#type").isHidden());
  await page.locator("#kind").selectOption("slider-crank");
  await page.locator("#slide-stroke").fill("120");
  await page.keyboard.press("Tab");
  await doing(page, "done");
  const text = await problemText(page);
  assert.match(text, /input = "full-turn"/);
  assert.match(text, /stroke = \[120, 120\]/);
  // All kinds are ranked together; four-bars alone need nothing said.
  await tab(page, "wishes");
  await page.locator("#kind").selectOption("all");
  await doing(page, "done");
  assert.match(await problemText(page), /mechanism = \["four-bar", "slider-crank", "inverted-slider-crank"\]/);
  await tab(page, "wishes");
  await page.locator("#kind").selectOption("four-bar");
  await doing(page, "done");
  assert.equal(await page.locator("#type").inputValue(), "motor");
  const again = await problemText(page);
  assert.doesNotMatch(again, /mechanism|stroke|full-turn/);
  assert.match(again, /type = \["crank-rocker", "double-crank"\]/);
  assert.deepEqual(said, []);
  await end();
});

test("a six-bar is asked for, follows a point, moves with all of its joints, and is saved as a chain", async () => {
  const { page, said, end } = await begun(new URL("../problems/shapes/letter-D.toml", import.meta.url).pathname);
  await doing(page, "done");
  await tab(page, "wishes");
  assert.equal(await page.locator("#kind").inputValue(), "six-bar");
  const first = await kinds(page);
  assert.ok(first.length > 0 && first.every((text) => /six-bar/.test(text)), String(first));
  const figure = "#stage .figure:not(.absent)";
  assert.ok((await page.locator(`${figure} .stand:not(.absent)`).count()) >= 2);
  // C, D and P, and the ends and the joint of the second dyad.
  assert.ok((await page.locator(`${figure} > g > .pin`).count()) >= 7);
  await shot(page, "six-bar");
  // The longest distance of two joints of one link, of six links: a box around all cannot be many times as large.
  for (const text of await page.locator("#strip .quality").allTextContents()) {
    const [, longest, whole] = text.match(/longest link ([\d.]+)\s×\sthe path, whole ([\d.]+)/) ?? [];
    if (whole) assert.ok(4 * Number(longest) >= Number(whole) && Number(longest) <= 3, text);
  }
  const on = await dragPoint(page, 3, [5, 6], 6);
  assert.ok(
    on.every((cards) => cards.length > 0 && cards.every((text) => /six-bar/.test(text))),
    String(on),
  );
  await doing(page, "done");
  assert.match(await problemText(page), /mechanism = \["six-bar"\]/);
  const file = await saved(page, () => button(page, "Linkage file").click());
  assert.match(String(file.bytes), /\[chain\]/);
  await drawer(page, "details");
  await page.waitForSelector("#details .details-charts figure");
  assert.ok((await page.locator("#details .stage .plate").count()) >= 4);
  await shot(page, "six-bar-details");
  for (const [format, says] of [
    ["dxf-plates", /LINK6/],
    ["scad", /module link6/],
    ["cut-list", /6 plates, 7 pins/],
  ]) {
    await page.locator("#format").selectOption(format);
    const { bytes } = await saved(page, () => page.locator("#export").click());
    assert.match(String(bytes), says, format);
  }
  // Its six plates, and how they lie above each other.
  await tab(page, "build");
  await page.waitForSelector("#plates:not([hidden]) svg path");
  assert.equal(await page.locator("#plates svg > g[id^=link]").count(), 2);
  assert.match(await page.locator("#layers").textContent(), /link5/);
  await shot(page, "six-bar-plates");
  await end();
  // Nothing was asked for that is refused.
  assert.deepEqual(said, []);
});

test("every slider-crank through eight points, counted, and they follow a point", async () => {
  const { page, said, end } = await begun(new URL("../problems/sliders/slider-exact.toml", import.meta.url).pathname);
  await doing(page, "done");
  await tab(page, "wishes");
  assert.ok(await page.locator("#exact").isChecked());
  const counted = () => page.locator("#nine button").first().textContent();
  assert.equal(await counted(), "19 all real");
  assert.match(await page.locator("#nine .census").textContent(), /279 solutions up to cognates/);
  await shot(page, "slider-exact");
  const on = await dragPoint(page, 3, [14, 10]);
  assert.ok(on.every((cards) => cards.length > 0 && cards.every((text) => /slider-crank/.test(text))));
  await page.waitForFunction(() => /^\d+ all real$/.test(document.querySelector("#nine button").textContent));
  await doing(page, "done");
  assert.match(await page.locator("#nine .census").textContent(), /279 solutions up to cognates/);
  assert.match(await problemText(page), /mechanism = \["slider-crank"\][\s\S]*method = "continuation"/);
  // Four-bars are determined by nine points: eight leave a family.
  await tab(page, "wishes");
  await page.locator("#kind").selectOption("four-bar");
  await page.waitForSelector("#nine", { state: "hidden" });
  assert.ok(await page.locator("#exact").isDisabled());
  assert.deepEqual(said, []);
  await end();
});
