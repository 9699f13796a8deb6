// The hand on the board in headless Chromium: what a click, a drag, two fingers and a new stroke change. See .ci/check-studio.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  button,
  doing,
  example,
  gone,
  house,
  problemText,
  shots,
  begun as started,
  status,
  studio,
  tab,
} from "./harness.mjs";

const problems = new URL("../problems/", import.meta.url).pathname;
const home = house("hand");
const { work } = home;

/** A studio with a page, begun with a problem file if there is one. */
const begun = (file, options) => started(home, file ? [file] : [], options);

const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
const texts = (page) => page.locator("#coordinates").inputValue();

/** The middle of something on the board. */
const middle = (page, selector) =>
  page.evaluate((selector) => {
    const { x, y, width, height } = document.querySelector(selector).getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  }, selector);

/** Draws with the pen around a place, in parts of the board. */
async function drawn(page, at = [0.5, 0.45], size = 0.2) {
  const box = await page.locator("#board svg").boundingBox();
  const place = (t) => [
    box.x + box.width * (at[0] + size * Math.cos(t)),
    box.y + box.height * (at[1] + size * Math.sin(t) + 0.04 * Math.cos(2 * t)),
  ];
  await page.mouse.move(...place(0));
  await page.mouse.down();
  for (let i = 1; i <= 60; i += 1) await page.mouse.move(...place((i * 2 * Math.PI) / 60));
  await page.mouse.up();
}

test("a click on a point chooses it and changes nothing; what is dragged is all that moves, in one step", async () => {
  const { page, said, context, end } = await begun(join(problems, "exact/crank-rocker.toml"));
  const before = await problemText(page);
  await page.locator("#board svg").scrollIntoViewIfNeeded();
  await page.mouse.click(...(await middle(page, ".handle[data-point='4']")));
  assert.equal(await page.locator(".target-point.chosen").count(), 1);
  assert.equal(await problemText(page), before);
  assert.ok(await button(page, "Undo").isDisabled(), "there is nothing to undo");
  // One of nine points with sixteen digits is dragged: the others keep theirs.
  const points = (text) =>
    [...text.match(/points = (\[[\s\S]*?\n?\])\n/)[1].matchAll(/\[(-?[\d.e-]+), (-?[\d.e-]+)\]/g)].map((one) => one[0]);
  await page.locator("#board svg").scrollIntoViewIfNeeded();
  const [x, y] = await middle(page, ".handle[data-point='4']");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 12, y + 5, { steps: 4 });
  await page.mouse.up();
  const [old, now] = [points(before), points(await problemText(page))];
  assert.equal(now.length, 9);
  assert.deepEqual(
    now.map((point, i) => (point === old[i] ? "" : i)).filter((i) => i !== ""),
    [4],
  );
  await button(page, "Undo").click();
  assert.equal(await problemText(page), before);
  // A click clears no step that can be done again.
  await page.locator("#board svg").scrollIntoViewIfNeeded();
  await page.mouse.click(...(await middle(page, ".handle[data-point='2']")));
  assert.ok(await button(page, "Redo").isEnabled());
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("digitised points stay what they are when one is clicked", async () => {
  const file = join(work, "raw.toml");
  writeFileSync(
    file,
    `format = 1\nname = "raw"\n[task.path]\npoints = [${Array.from({ length: 24 }, (_, i) => `[${30 * Math.cos(i / 4)}, ${20 * Math.sin(i / 4)}]`)}]\nsmooth = 0.4\nsamples = 16\n`,
  );
  const { page, context, end } = await begun(file);
  assert.match(await page.locator("#kept").textContent(), /24 digitised points/);
  await page.mouse.click(...(await middle(page, ".handle[data-point='3']")));
  assert.match(await page.locator("#kept").textContent(), /24 digitised points/);
  await context.close();
  await end();
});

test("what is gone stays gone: after Clear no answer to the old target comes back", async () => {
  const { page, said, context, end } = await begun();
  await page.locator("#tolerance").fill("0.0001");
  await page.keyboard.press("Tab");
  await doing(page, "searching");
  await button(page, "Clear").click();
  await page.waitForTimeout(1500);
  assert.equal(await page.locator("#strip li").count(), 0);
  assert.match(await status(page), /^Cleared, with what was asked: .* Undo brings it back/);
  // The connection breaks and comes back: still nothing.
  await page.context().setOffline(true);
  await page.context().setOffline(false);
  await page.waitForTimeout(300);
  assert.equal(await page.locator("#strip li").count(), 0);
  // Three clicked points are a new target, whatever the old one's linkages were.
  await button(page, "Points").click();
  const box = await page.locator("#board svg").boundingBox();
  for (const [x, y] of [
    [0.3, 0.5],
    [0.5, 0.3],
    [0.7, 0.5],
  ])
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
  await page.waitForSelector("#strip li");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("two fingers move and zoom, a palm and a lost pointer leave nothing behind", async () => {
  const { page, said, context, end } = await begun(null, { hasTouch: true });
  await doing(page, "done");
  const before = await problemText(page);
  const scale = () => page.locator(".scale").getAttribute("d");
  await page.evaluate(() => scrollTo(0, 0));
  const box = await page.locator("#board svg").boundingBox();
  const at = (x, y, id) => ({ x: box.x + x * box.width, y: box.y + y * box.height, id });
  const browserSession = await context.newCDPSession(page);
  const fingers = async (type, ...touchPoints) => {
    await browserSession.send("Input.dispatchTouchEvent", { type, touchPoints });
    await page.waitForTimeout(20);
  };
  const wide = await scale();
  await fingers("touchStart", at(0.4, 0.9, 1));
  for (let i = 1; i <= 10; i += 1) await fingers("touchMove", at(0.4 - i / 100, 0.9, 1));
  await fingers("touchStart", at(0.3, 0.9, 1), at(0.7, 0.9, 2));
  for (let i = 1; i <= 10; i += 1) await fingers("touchMove", at(0.3 - i / 100, 0.9, 1), at(0.7 + i / 100, 0.9, 2));
  assert.notEqual(await scale(), wide, "it zooms");
  // One goes up, the other draws nothing; the first comes again and they zoom again.
  const once = await scale();
  await fingers("touchEnd", at(0.2, 0.9, 1));
  for (let i = 1; i <= 10; i += 1) await fingers("touchMove", at(0.8 - i / 100, 0.9, 2));
  assert.equal(await scale(), once);
  await fingers("touchStart", at(0.2, 0.9, 1), at(0.7, 0.9, 2));
  for (let i = 1; i <= 10; i += 1) await fingers("touchMove", at(0.2 + i / 100, 0.9, 1), at(0.7, 0.9, 2));
  assert.notEqual(await scale(), once);
  await fingers("touchEnd");
  assert.equal(await problemText(page), before, "no path was drawn");
  assert.ok(await button(page, "Undo").isDisabled());
  // A point that one finger has begun to move is back in its place when the other comes.
  const points = await texts(page);
  await page.evaluate(() => scrollTo(0, 0));
  const [x, y] = await middle(page, ".handle[data-point='9']");
  await fingers("touchStart", { x, y, id: 1 });
  for (let i = 1; i <= 5; i += 1) await fingers("touchMove", { x: x + 5 * i, y, id: 1 });
  await page.waitForFunction((points) => document.querySelector("#coordinates").value !== points, points);
  await fingers("touchStart", { x: x + 25, y, id: 1 }, at(0.9, 0.9, 2));
  await page.waitForFunction((points) => document.querySelector("#coordinates").value === points, points);
  await fingers("touchEnd");
  assert.ok(await button(page, "Undo").isDisabled());
  // A palm beside a pen draws nothing, and a stroke whose pointer is taken away is none.
  const touch = (type, id, x, y, pointerType = "touch") =>
    page.evaluate(
      ([type, pointerId, x, y, pointerType]) => {
        const svg = document.querySelector("#board svg");
        svg.setPointerCapture = () => {};
        const box = svg.getBoundingClientRect();
        const [clientX, clientY] = [box.x + x * box.width, box.y + y * box.height];
        svg.dispatchEvent(
          new PointerEvent(type, { bubbles: true, cancelable: true, pointerId, pointerType, clientX, clientY }),
        );
      },
      [type, id, x, y, pointerType],
    );
  await touch("pointerdown", 3, 0.3, 0.3, "pen");
  for (let i = 1; i <= 20; i += 1) {
    await touch("pointermove", 3, 0.3 + i / 50, 0.3, "pen");
    if (i === 5) await touch("pointerdown", 4, 0.9, 0.9);
    if (i > 5) await touch("pointermove", 4, 0.9, 0.9 - i / 50);
  }
  const line = await page.locator(".board .stroke").getAttribute("d");
  assert.equal(
    new Set(
      line
        .slice(1)
        .split("L")
        .map((point) => point.split(" ")[1]),
    ).size,
    1,
    "one straight line",
  );
  await touch("pointercancel", 3, 0.7, 0.3, "pen");
  assert.equal(await problemText(page), before);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a new stroke begins a new path: what belonged to the old points goes, what is still asked is said", async () => {
  const { page, said, context, end } = await begun(join(problems, "literature/k18.toml"));
  await page.waitForSelector("#kept:not([hidden])");
  await drawn(page);
  await doing(page, "done");
  const text = await problemText(page);
  for (const gone of ["crank_deg", "weight", "[design]", "source"])
    assert.ok(!text.includes(gone), `${gone} in\n${text}`);
  assert.ok(await page.locator("#kept").isHidden());
  assert.match(
    await page.locator("#stays").textContent(),
    /Still asked as before: driven by, longest over shortest link\./,
  );
  await button(page, "Ask nothing but the path").click();
  await tab(page, "wishes");
  await page.locator("#transmission").fill("25");
  await page.keyboard.press("Tab");
  await page.locator("#pivots").check();
  await drawn(page, [0.4, 0.4], 0.15);
  assert.match(await page.locator("#stays").textContent(), /least transmission angle, both fixed pivots inside a box/);
  await shot(page, "stays");
  await button(page, "Ask nothing but the path").click();
  assert.ok(await page.locator("#stays").isHidden());
  assert.ok(await page.evaluate(() => document.activeElement.matches("#board svg")), "the focus is on the board");
  assert.doesNotMatch(await problemText(page), /transmission|pivots/);
  await button(page, "Undo").click();
  assert.match(await problemText(page), /transmission_deg_min = 25/);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("a click on the path puts a point between, one beside it behind the last; each is one step back", async () => {
  const { page, said, context, end } = await begun();
  await tab(page, "points");
  await page.locator("#coordinates").fill("-40, 0\n40, 0\n40, 40\n");
  await button(page, "Take these points").click();
  await page.locator("#closed").uncheck();
  await button(page, "Show all").click();
  await button(page, "Points").click();
  assert.match(await page.locator("#desk-said").textContent(), /Clear begins anew/);
  const [a, b] = [await middle(page, ".handle[data-point='0']"), await middle(page, ".handle[data-point='1']")];
  await page.mouse.click((a[0] + b[0]) / 2, a[1] + 3);
  const lines = async () => (await texts(page)).split("\n").map((line) => line.split(", ").map(Number));
  assert.equal((await lines()).length, 4);
  assert.ok(Math.abs((await lines())[1][0]) < 2, `${await texts(page)}`);
  // Pressed, drawn aside and let go: one step.
  const [x, y] = [a[0] + 30, a[1] - 60];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y - 20, { steps: 4 });
  await page.mouse.up();
  assert.equal((await lines()).length, 5);
  await button(page, "Undo").click();
  assert.equal((await lines()).length, 4);
  await button(page, "Undo").click();
  assert.equal((await lines()).length, 3);
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("Ctrl+Z undoes from every control that is no text; texts that were typed are not lost; examples load by a click", async () => {
  const { page, said, context, end } = await begun();
  await tab(page, "points");
  await page.locator("#coordinates").fill("1, 2\n3, 4\n");
  await page.locator("#closed").uncheck();
  await page.keyboard.press("Control+z");
  assert.ok(await page.locator("#closed").isChecked(), "undone from a tick");
  await page.locator("#timing").selectOption("fixed");
  await page.locator("#timing").focus();
  await page.keyboard.press("Control+z");
  assert.equal(await page.locator("#timing").inputValue(), "none");
  assert.equal(await texts(page), "1, 2\n3, 4\n", "what was typed is still there");
  await doing(page, "done");
  // Numbers with decimal commas are not read as something else.
  await page.locator("#coordinates").fill("1,5\t2,5\n3,5\t4,5\n5,5\t1,5\n");
  await button(page, "Take these points").click();
  assert.match(await status(page), /line 1.*decimal point/);
  assert.equal(await page.locator("#point-count").textContent(), "19");
  await page.locator("#coordinates").fill("1\t2\n3\t4\n5\t1\n");
  await button(page, "Take these points").click();
  assert.equal(await texts(page), "1, 2\n3, 4\n5, 1");
  // An example is not loaded by looking at it.
  await button(page, "Examples").click();
  assert.equal(await page.locator("#point-count").textContent(), "3");
  await example(page, 5);
  assert.equal(await page.locator("#point-count").textContent(), "9");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("the focus stays where work is done", async () => {
  const { page, said, context, end } = await begun();
  await doing(page, "done");
  const focus = () =>
    page.evaluate(
      () => document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent.slice(0, 40),
    );
  await page.getByRole("button", { name: "Got it" }).focus();
  await page.keyboard.press("Enter");
  assert.match(await focus(), /^The target/);
  await tab(page, "points");
  await button(page, "Remove point 4").focus();
  await page.keyboard.press("Enter");
  assert.equal(await focus(), "Remove point 4");
  await button(page, "Remove point 17").focus();
  await page.keyboard.press("Enter");
  assert.equal(await focus(), "Remove point 16");
  await doing(page, "done");
  // Pinning adds a card, unpinning takes one away.
  await button(page, "Pin linkage 1").focus();
  await page.keyboard.press("Enter");
  assert.equal(await focus(), "Pinned linkage 1");
  await button(page, "Pin linkage 2").focus();
  await page.keyboard.press("Enter");
  await button(page, "Unpin pinned 2").focus();
  await page.keyboard.press("Enter");
  assert.equal(await focus(), "Unpin pinned 1");
  assert.deepEqual(said, []);
  await context.close();
  await end();
});

test("each tab keeps its own drawing; another problem from the command line is a step that can be undone", async () => {
  const first = await begun();
  const { page, context } = first;
  await doing(page, "done");
  const mine = await texts(page);
  await button(page, "Pin linkage 1").click();
  const other = await context.newPage();
  await other.goto(new URL("/", first.address).href);
  await other.waitForSelector("#strip li");
  assert.equal(await texts(other), mine, "a new tab begins with the latest");
  await example(other, 1);
  await other.waitForFunction(() => document.querySelector("#point-count").textContent === "9");
  await page.reload();
  await page.waitForSelector("#strip li");
  assert.equal(await texts(page), mine);
  await first.end();
  const second = await studio(
    "--port",
    new URL(first.address).port,
    "--out",
    join(work, "results"),
    join(problems, "examples/pivot-box.toml"),
  );
  await gone(page, second.address);
  await page.waitForFunction(() => document.querySelector("#left").value === "-20");
  assert.equal(await button(page, "Unpin pinned 1").count(), 1);
  await button(page, "Undo").click();
  assert.equal(await texts(page), mine);
  assert.match(readFileSync(join(problems, "examples/pivot-box.toml"), "utf8"), /pivots_in/);
  await context.close();
  await second.end();
});
