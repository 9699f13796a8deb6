// What is chosen, pinned, compared and saved, in headless Chromium; and what a tab is told that the studio does not serve.
// See .ci/check-studio.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { button, doing, drawer, example, house, shots, begun as started, status, tab } from "./harness.mjs";

const problems = new URL("../problems/", import.meta.url).pathname;
const home = house("pins");

const begun = (...options) => started(home, options);

const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
const pressed = (page) => page.locator(".pick[aria-pressed=true] strong").allTextContents();
const said = (page, says) =>
  page.waitForFunction((says) => new RegExp(says).test(document.querySelector("#desk-said").textContent), says.source);

async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  return { name: download.suggestedFilename(), text: readFileSync(await download.path(), "utf8") };
}

/** At its next load the page begins with nothing remembered: what it keeps until it goes is cleared then. */
const forgetful = (page) =>
  page.addInitScript(() => {
    if (window.name) return;
    window.name = "cleared";
    sessionStorage.clear();
    localStorage.clear();
  });

/** The numbers of the linkage that the page saves, to what a search changes of one that it has found again. */
const linkage = async (page) => {
  await tab(page, "build");
  const { text } = await saved(page, () => button(page, "Linkage file").click());
  const numbers = text.match(/(?<= |\[)-?\d+\.\d+(e-?\d+)?/g);
  return numbers.map((number) => Number(number).toFixed(2).replace("-0.00", "0.00"));
};

test("what is chosen stays chosen while candidates come, go and change places", async () => {
  const { page, said: console_, context, end } = await begun();
  // What the studio answers, as many as are let through, the first one last when turned.
  let [most, turned] = [1, false];
  await page.routeWebSocket(/live/, (socket) => {
    const server = socket.connectToServer();
    server.onMessage((text) => {
      const answer = JSON.parse(text);
      const [first, ...others] = answer.candidates;
      const candidates = turned && first ? [...others, first] : answer.candidates;
      socket.send(JSON.stringify({ ...answer, candidates: candidates.slice(0, most) }));
    });
  });
  await forgetful(page);
  await page.reload();
  await doing(page, "done");
  const again = async (ratio) => {
    await tab(page, "wishes");
    await page.locator("#ratio").fill(String(ratio));
    await page.keyboard.press("Tab");
    await doing(page, "done");
  };
  assert.equal(await page.locator("#strip li").count(), 1);
  await button(page, "Pin linkage 1").click();
  await page.locator(".pick", { hasText: "Pinned 1" }).click();
  const pin = await linkage(page);
  // So does the control that has the focus, though cards come before it.
  const focused = () => page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  most = 9;
  await tab(page, "wishes");
  await page.locator("#ratio").fill("19");
  await button(page, "Unpin pinned 1").focus();
  await doing(page, "done");
  assert.equal(await focused(), "Unpin pinned 1");
  const count = await page.locator("#strip li").count();
  assert.ok(count > 2, `${count} cards`);
  assert.deepEqual(await pressed(page), ["Pinned 1"]);
  assert.deepEqual(await linkage(page), pin);
  // A candidate keeps being the chosen one in another place.
  await page.locator(".pick", { hasText: "Linkage 2" }).click();
  const second = await linkage(page);
  turned = true;
  await again(18);
  const [now] = await pressed(page);
  assert.ok(now.startsWith("Linkage ") && now !== "Linkage 2", now);
  assert.deepEqual(await linkage(page), second);
  // One that is gone is not silently another.
  [most, turned] = [1, false];
  await again(17);
  assert.deepEqual(await pressed(page), ["Linkage 1"]);
  assert.match(await page.locator("#desk-said").textContent(), /not among these any more/);
  assert.deepEqual(console_, []);
  await context.close();
  await end();
});

test("pins keep their target: shown, compared, saved beside another; none is dropped unasked", async () => {
  const { page, said: console_, context, end } = await begun();
  await doing(page, "done");
  await tab(page, "points");
  await page.locator("#unit").selectOption("cm");
  await doing(page, "done");
  for (const rank of [1, 2]) await button(page, `Pin linkage ${rank}`).click();
  await example(page, 6);
  await doing(page, "done");
  await button(page, "Pin linkage 1").click();
  await button(page, "Pin linkage 2").click();
  await said(page, /3 are pinned already: unpin one/);
  assert.equal(await page.locator(".pin-button", { hasText: "Unpin" }).count(), 3);
  const card = page.locator(".pick", { hasText: "Pinned 2" });
  assert.match(await card.textContent(), /rms [\d.]+ cm/, "its own unit");
  // Everything about it, as it was found.
  await card.click();
  await page.locator("#details summary").click();
  await page.waitForFunction(() => document.querySelector("#details-title").textContent === "Pinned 2 of walking-leg");
  await page.waitForSelector(".details-charts figure");
  // What is said of the best one stands under a heading of its own, behind the words of this one.
  const heads = await page.locator(".details-words h3").allTextContents();
  assert.deepEqual([heads[0], heads.at(-1)], ["What it can do", "The search and its best linkage"]);
  assert.match(await page.locator("#format option").first().textContent(), /plates to cut/);
  await page.locator("#format").selectOption("toml");
  const file = await saved(page, () => page.locator("#export").click());
  assert.equal(file.name, "walking-leg.toml");
  await tab(page, "build");
  const own = await saved(page, () => button(page, "Linkage file").click());
  assert.equal(own.name, "walking-leg-pinned-2.toml");
  // Compared with each other and with the one on the board, by the names that they have here.
  await page.locator(".pick", { hasText: "Linkage 2" }).click();
  await drawer(page, "searches");
  await button(page, "Compare").click();
  await page.waitForSelector("#comparison tbody tr:nth-child(4)");
  const names = (await page.locator("#comparison tbody th").allTextContents()).map((text) =>
    text.replace(/^\d+\. /, ""),
  );
  assert.deepEqual(names.sort(), ["on the board", "pinned 1", "pinned 2", "pinned 3"]);
  assert.doesNotMatch(await page.locator("#comparison").textContent(), /not true/);
  await shot(page, "compared");
  // A pin's target is drawn again, and that is one step.
  await drawer(page, "details");
  await card.click();
  await page.waitForFunction(() => document.querySelector("#details-title").textContent === "Pinned 2 of walking-leg");
  await button(page, "Draw its target").click();
  assert.equal(await page.locator("#point-count").textContent(), "19");
  await button(page, "Undo").click();
  assert.equal(await page.locator("#point-count").textContent(), "12");
  // They are remembered with their targets.
  await page.reload();
  await doing(page, "done");
  assert.match(await card.textContent(), /rms [\d.]+ cm/);
  assert.deepEqual(console_, []);
  await context.close();
  await end();
});

test("a pin of another path says so and is not praised; the drawing made larger makes its pins larger", async () => {
  const { page, said: console_, context, end } = await begun();
  await doing(page, "done");
  await button(page, "Pin linkage 1").click();
  await said(page, /^Pinned 1 is its card/);
  const pinned = button(page, "Pinned linkage 1");
  assert.deepEqual([await pinned.textContent(), await pinned.getAttribute("aria-pressed")], ["Pinned", "true"]);
  await pinned.click();
  assert.equal(await page.locator("[class*=pin-] > .pick").count(), 0, "a second click unpins");
  await button(page, "Pin linkage 1").click();
  const card = page.locator(".pick", { hasText: "Pinned 1" });
  await card.click();
  const verdict = () => card.locator(".verdict").textContent();
  const rms = async () => Number((await card.textContent()).match(/rms ([\d.]+)/)[1]);
  const praise = () => card.locator(".good").count();
  const [met, near, praised] = [await verdict(), await rms(), await praise()];
  assert.match(met, /^meets/);
  assert.ok(praised > 0);
  const width = page.locator("#path-width");
  const before = Number(await width.inputValue());
  // Twice as wide: so is the pinned linkage, here and a step back and forth.
  await width.fill(String(2 * before));
  await page.keyboard.press("Tab");
  await doing(page, "done");
  assert.deepEqual([await verdict(), await praise()], [met, praised]);
  assert.ok(Math.abs((await rms()) / near - 2) < 0.02, `${await rms()} of ${near}`);
  const large = await linkage(page);
  await button(page, "Undo").click();
  await doing(page, "done");
  assert.deepEqual([await verdict(), await rms()], [met, near]);
  const small = await linkage(page);
  assert.ok(
    large.every((x, i) => Math.abs(x - 2 * small[i]) < 0.03 || x === small[i]),
    `${large} of ${small}`,
  );
  assert.equal(await page.locator("#elsewhere").textContent(), "");
  // Another path, other wishes.
  await example(page, 6);
  await doing(page, "done");
  await card.click();
  assert.deepEqual([await verdict(), await praise()], ["pinned for another path", 0]);
  await page.waitForFunction(() => /pinned for another path/.test(document.querySelector("#elsewhere").textContent));
  assert.match(await card.locator(".quality").textContent(), /% of its path.*× its path/);
  await shot(page, "pinned-for-another");
  await button(page, "Undo").click();
  await doing(page, "done");
  assert.deepEqual([await verdict(), await praise()], [met, praised]);
  await tab(page, "wishes");
  await page.locator("#transmission").fill("12");
  await page.keyboard.press("Tab");
  await doing(page, "done");
  assert.deepEqual([await verdict(), await praise()], ["pinned with other wishes", 0]);
  assert.deepEqual(console_, []);
  await context.close();
  await end();
});

test("a reload keeps what is built: the linkage that is chosen, the sizes, the same plates to the byte", async () => {
  const { page, said: console_, context, end } = await begun();
  await doing(page, "done");
  await page.locator(".pick", { hasText: "Linkage 3" }).click();
  await tab(page, "build");
  const sizes = { "#thickness_mm": "5", "#hole_mm": "3.2", "#margin_mm": "4.5", "#kerf_mm": "0.15" };
  for (const [id, size] of Object.entries(sizes)) await page.locator(id).fill(size);
  const sheet = ["Width of the sheet", "Height of the sheet"].map((name) => page.getByLabel(name));
  for (const [i, field] of sheet.entries()) await field.fill(String(900 - 100 * i));
  const plates = async () => {
    await page.waitForFunction(() => document.querySelector("#plates svg")?.checkVisibility());
    assert.equal(await page.locator("#plates-of").textContent(), "Plates of Linkage 3");
    return saved(page, () => page.locator("#save-dxf").click());
  };
  const before = await plates();
  await page.reload();
  await page.waitForSelector("#strip li");
  assert.deepEqual(await pressed(page), ["Linkage 3"], "from the first card on");
  await doing(page, "done");
  assert.deepEqual(await pressed(page), ["Linkage 3"]);
  await tab(page, "build");
  for (const [id, size] of Object.entries(sizes)) assert.equal(await page.locator(id).inputValue(), size);
  assert.deepEqual(await Promise.all(sheet.map((field) => field.inputValue())), ["900", "800"]);
  assert.deepEqual(await plates(), before);
  await shot(page, "built-again");
  assert.deepEqual(console_, []);
  await context.close();
  await end();
});

test("a linkage that jams is not praised, and a wish that forbids it is one click", async () => {
  const { page, said: console_, context, end } = await begun();
  // What the studio answers, with a worst angle at which it jams for as long as no angle is asked for.
  let isAsked = false;
  await page.routeWebSocket(/live/, (socket) => {
    const server = socket.connectToServer();
    socket.onMessage((text) => {
      isAsked = JSON.parse(text).transmission_deg_min !== undefined;
      server.send(text);
    });
    server.onMessage((text) => {
      const answer = JSON.parse(text);
      const jamming = isAsked ? {} : { transmission_deg: 3.2 };
      socket.send(JSON.stringify({ ...answer, candidates: answer.candidates.map((one) => ({ ...one, ...jamming })) }));
    });
  });
  await page.reload();
  await tab(page, "wishes");
  await page.locator("#transmission").fill("");
  await page.keyboard.press("Tab");
  await doing(page, "done");
  const card = page.locator(".pick").first();
  assert.match(await card.locator(".quality").textContent(), /transmission 3\.2° \(it jams\)/);
  assert.equal(await card.locator(".verdict").textContent(), "meets what was asked, but jams");
  assert.match(await status(page), /^Best: .* meets what was asked, but jams/);
  assert.equal(await card.locator(".verdict.good").count(), 0);
  await shot(page, "jams");
  await button(page, "It jams: ask for at least 30°").click();
  await doing(page, "done");
  assert.equal(await page.locator("#transmission").inputValue(), "30");
  assert.match(await card.locator(".verdict").textContent(), /^meets everything/);
  assert.ok(await page.locator("#helps").isHidden());
  await button(page, "Undo").click();
  assert.equal(await page.locator("#transmission").inputValue(), "");
  // A box that was scaled shows four digits of its size; an empty board has no lengths.
  await page.locator("#path-width").fill("77.7");
  await page.keyboard.press("Tab");
  assert.match(await page.locator("#left").inputValue(), /^-82\.[67]\d?$/);
  await button(page, "Clear").click();
  assert.equal(await page.locator("#longest-said").textContent(), "at most 3 × the path");
  assert.deepEqual(console_, []);
  await context.close();
  await end();
});

test("the details say whether they are of what stands, and what they save is what they show", async () => {
  const { page, said: console_, context, end } = await begun();
  await doing(page, "done");
  await page.locator("#details summary").click();
  await page.waitForFunction(() => document.querySelector("#details-title").textContent === "Linkage 1 of walking-leg");
  await page.locator("#format").selectOption("json");
  const save = async () => JSON.parse((await saved(page, () => page.locator("#export").click())).text);
  const before = await save();
  await page.locator("#board svg").scrollIntoViewIfNeeded();
  const [x, y] = await page.evaluate(() => {
    const { x, y, width, height } = document.querySelector(".handle[data-point='12']").getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 10; i += 1) await page.mouse.move(x, y - i);
  await page.waitForFunction(
    () => document.querySelector("#details-title").textContent === "Linkage 1 of walking-leg, as it stood",
  );
  assert.deepEqual(
    await page.evaluate(async () => {
      const asked = [];
      const { fetch } = window;
      window.fetch = (path, init) => {
        asked.push([path, init?.body]);
        return fetch(path, init);
      };
      document.querySelector("#export").click();
      await new Promise((later) => {
        setTimeout(later, 500);
      });
      window.fetch = fetch;
      return asked.filter(([path]) => path === "/export").map(([, body]) => JSON.parse(body).of.drawn.linkage.a);
    }),
    [before.a ?? before.linkage.a],
  );
  await page.mouse.up();
  await doing(page, "done");
  await page.waitForFunction(() => document.querySelector("#details-title").textContent === "Linkage 1 of walking-leg");
  assert.notDeepEqual(await save(), before);
  assert.deepEqual(console_, []);
  await context.close();
  await end();
});

test("a long search is of what is drawn, under its name, with the budget of the problem where none is typed", async () => {
  const { page, context, end } = await begun();
  await doing(page, "done");
  const asked = [];
  page.on(
    "request",
    (request) => request.url().endsWith("/jobs") && request.method() === "POST" && asked.push(request.postDataJSON()),
  );
  await example(page, 1);
  await doing(page, "done");
  assert.equal(await page.locator("#job-name").getAttribute("placeholder"), "straight-stroke");
  assert.equal(await page.locator("#job-name").inputValue(), "");
  await drawer(page, "searches");
  await page.locator("#job-start").click();
  await page.waitForFunction(() => document.querySelector("#jobs li")?.dataset.state === "done", null, {
    timeout: 60_000,
  });
  assert.equal(asked.length, 1);
  assert.deepEqual([asked[0].ask.name, asked[0].set], ["straight-stroke", undefined]);
  assert.equal(await page.locator("#job-name").getAttribute("placeholder"), "straight-stroke-2");
  // Opened and pinned, it has its own target; the focus goes with the drawer that opens.
  await page.getByRole("button", { name: "Open straight-stroke" }).focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(
    () => document.querySelector("#details-title").textContent === "straight-stroke, candidate",
  );
  assert.ok(await page.evaluate(() => document.activeElement.matches("#details > summary")));
  await page.locator("#details-pin").click();
  assert.equal(await button(page, "Unpin pinned 1").count(), 1);
  await context.close();
  await end();
});

test("a tab that is not served is told why; a beginning that did not come is asked for again", async () => {
  const { page, context, end, address } = await begun(join(problems, "examples/pivot-box.toml"));
  // As where all places are taken: the studio answers, the connection is refused.
  const other = await context.newPage();
  await other.routeWebSocket(/live/, (socket) => void socket.close());
  await other.goto(new URL("/", address).href);
  await other.waitForFunction(() => /serves no more tabs/.test(document.querySelector("#status").textContent));
  assert.doesNotMatch(await status(other), /Start it again/);
  await other.close();
  // A busy studio gives no beginning: a reload gives it. What is kept is cleared when the next page begins, after the last
  // words of the one before.
  await forgetful(page);
  await page.route("**/beginning.json", (route) => route.fulfill({ status: 429, body: "too many requests\n" }), {
    times: 1,
  });
  await page.reload();
  await page.waitForSelector("#strip li");
  assert.equal(await page.locator("#name").inputValue(), "walking-leg");
  await page.reload();
  await page.waitForSelector("#strip li");
  assert.equal(await page.locator("#left").inputValue(), "-20");
  await context.close();
  await end();
});
