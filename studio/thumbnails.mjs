#!/usr/bin/env node
// The linkages of the gallery's pictures: what the studio finds for each example, in src/thumbnails.json. Needs a build of
// the program (LINKWRIGHT) with a page that has the examples, and Chromium.

import { writeFileSync } from "node:fs";
import { button, doing, endAll, browser as launched, opened, studio } from "./harness.mjs";

const browser = await launched();
const { address, end } = await studio("--port", "18490");
const { page } = await opened(browser, address);
const shown = {};
// What the socket brings: of each problem the latest answer.
const answers = await page.context().newCDPSession(page);
let latest = null;
await answers.send("Network.enable");
answers.on("Network.webSocketFrameReceived", ({ response }) => {
  latest = JSON.parse(response.payloadData);
});
const names = await page.locator("#gallery .example:has(svg)").allTextContents();
const digits = (value) =>
  typeof value === "number" ? Number(value.toPrecision(5)) : Array.isArray(value) ? value.map(digits) : value;
for (const name of names) {
  if (await page.locator("#gallery").isHidden()) await button(page, "Examples").click();
  await page.locator("#gallery .example", { hasText: name }).click();
  await doing(page, "done");
  const { linkage, drive, crank_deg, t1_at } = latest.candidates[0];
  const rounded = (one) => Object.fromEntries(Object.entries(one).map(([key, value]) => [key, digits(value)]));
  const key = await page.locator("#name").inputValue();
  // Of the crank angles: which way it turns, or how far it rocks.
  const rocks = drive.kind === "rock";
  const ends = rocks ? [Math.min(...crank_deg), Math.max(...crank_deg)] : crank_deg.slice(0, 2);
  const t1 = t1_at.slice(0, 2);
  shown[key] = { linkage: rounded(linkage), drive: rounded(drive), crank_deg: digits(ends), t1_at: t1 };
}
writeFileSync(new URL("src/thumbnails.json", import.meta.url), `${JSON.stringify(shown, null, 2)}\n`);
await end();
await browser.close();
endAll();
