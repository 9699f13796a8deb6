// Called by check-compare: opens the pages and uses them.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import { chromium } from "playwright-core";

const [run, files, shots] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
  ],
});

async function opened(file, width, height, colorScheme) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme });
  const page = await context.newPage();
  const messages = [];
  page.on("console", (message) => messages.push(message.text()));
  page.on("pageerror", (error) => messages.push(error.message));
  page.on("dialog", (dialog) => {
    messages.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => request.url().startsWith("file:") || messages.push(`asks for ${request.url()}`));
  await page.goto(`file://${resolve(file)}`);
  return { context, page, messages };
}

const column = (page, table, n) =>
  page.$$eval(`${table} tbody tr`, (rows, n) => rows.map((row) => row.cells[n].textContent.trim()), n);

// Looks: nothing sticks out of the page, at any width and in both schemes.
for (const file of [run, files]) {
  for (const [name, width, height] of [
    ["desktop", 1280, 900],
    ["phone", 390, 844],
    ["narrow", 320, 640],
  ]) {
    for (const scheme of ["light", "dark"]) {
      const { context, page, messages } = await opened(file, width, height, scheme);
      assert.equal(
        await page.evaluate(() => document.documentElement.scrollWidth - innerWidth),
        0,
        `${name}: sticks out`,
      );
      const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
      assert.equal(paper === "rgb(255, 255, 255)", scheme === "light", paper);
      assert.deepEqual(messages, []);
      if (shots) {
        mkdirSync(shots, { recursive: true });
        await page.screenshot({ path: `${shots}/${file.replace(".html", "")}-${name}-${scheme}.png`, fullPage: true });
      }
      await context.close();
    }
  }
}

// Use: sorting by mouse and keyboard, curves off and on, rows lit, names harmless.
{
  const { context, page, messages } = await opened(files, 1280, 900, "light");
  const heads = await page.$$eval("#figures thead button", (buttons) => buttons.map((b) => b.textContent));
  const rms = heads.indexOf("rms");
  const before = await column(page, "#figures", rms);
  const sort = page.locator("#figures thead button").nth(rms);
  await sort.click();
  const numbers = (list) => list.map(Number);
  assert.deepEqual(
    numbers(await column(page, "#figures", rms)),
    numbers(before).sort((x, y) => x - y),
  );
  await sort.focus();
  await page.keyboard.press("Enter");
  assert.deepEqual(
    numbers(await column(page, "#figures", rms)),
    numbers(before).sort((x, y) => y - x),
  );
  assert.equal(await page.locator("#figures th").nth(rms).getAttribute("aria-sort"), "descending");
  assert.equal(await page.locator("#figures th[aria-sort]").count(), 1);

  const shown = () => page.locator("#curves .curve:visible").count();
  const all = await page.locator("#curves .curve").count();
  assert.equal(await shown(), all);
  const box = page.locator("input[data-row='1']");
  await box.focus();
  await page.keyboard.press("Space");
  assert.equal(await shown(), all - 1);
  assert.equal(await page.locator("#trade .curve[data-row='1']").isVisible(), false);
  await page.locator("#none").click();
  assert.equal(await shown(), 0);
  await page.locator("#all").click();
  assert.equal(await shown(), all);
  await page.locator("#figures tbody tr").first().hover();
  assert.equal(await page.locator("#curves .curve.on").count(), 1);
  assert.deepEqual(messages, []);
  await context.close();
}
{
  const { context, page, messages } = await opened(run, 1280, 900, "light");
  const label = await page.locator("#figures tbody th").first().textContent();
  assert.match(label, /^<img src=x onerror=alert\(1\)>"&:1$/);
  assert.equal(await page.locator("img, script:not([type]) ~ script, iframe, object").count(), 0);
  // What is injected later runs no more than what is written: the policy holds.
  await page.evaluate(() => {
    const late = document.createElement("script");
    late.textContent = "window.broken = true";
    document.body.append(late);
  });
  assert.equal(await page.evaluate(() => window.broken), undefined);
  assert.equal(messages.filter((message) => !message.includes("Content Security Policy")).length, 0);
  const unnamed = await page.$$eval(
    "button, input, svg[role=img]",
    (all) => all.filter((e) => !(e.ariaLabel || e.textContent.trim() || e.labels?.length)).length,
  );
  assert.equal(unnamed, 0, "every control and drawing has a name");
  const pdf = await page.pdf({ format: "A4" });
  assert.ok(pdf.length > 10_000);
  await context.close();
}
{
  const { context, page, messages } = await opened(run.replace(".html", ".svg"), 900, 900, "light");
  assert.equal((await page.locator("text").count()) > 3, true);
  assert.deepEqual(messages, []);
  assert.ok(!readFileSync(run.replace(".html", ".svg"), "utf8").includes("<img"));
  await context.close();
}
await browser.close();
console.log("compare: the page opens, sorts, hides, fits and lets nothing in");
