// A studio and a browser for tests: see .ci/check-studio.

import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before } from "node:test";
import { chromium } from "playwright-core";

export const program = process.env.LINKWRIGHT;
/** Where pictures go; none are taken without it. */
export const shots = process.env.SCREENSHOTS;
/** Times are asserted only where they are asked for: a busy machine is no fault of the page. */
export const timing = process.env.TIMING !== undefined;
/** A folder with the page to be tested in place of the one in the program. */
const built = process.env.PAGE;

export function browser() {
  const local = built ? ["--disable-features=LocalNetworkAccessChecks"] : [];
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      ...local,
    ],
  });
}

const running = new Set();

/** Ends what a failed test has left. */
export function endAll() {
  for (const child of running) child.kill("SIGKILL");
}

/** A studio of its own; its address, and how to end it. */
export async function studio(...options) {
  const child = spawn(program, ["studio", "--no-open", ...options], { stdio: ["ignore", "pipe", "ignore"] });
  running.add(child);
  child.once("exit", () => running.delete(child));
  const address = await new Promise((tell, fail) => {
    child.stdout.once("data", (text) => tell(String(text).trim()));
    child.once("exit", (code) => fail(new Error(`the studio ended with ${code}`)));
  });
  return {
    address,
    child,
    end: () =>
      new Promise((ended) => {
        child.once("exit", ended);
        child.kill("SIGINT");
      }),
  };
}

/** Goes to an address that the studio has printed. */
export async function gone(page, address) {
  await page.goto(address);
  if (built && address.includes("token=")) await page.goto(new URL("/", address).href);
}

/** A page of it, watched: what the console says is kept. In a context of its own, or one more in `context`. */
export async function opened(browser, address, { context: shared, ...options } = {}) {
  const context =
    shared ?? (await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options }));
  if (built && !shared) {
    const headers = {
      "content-security-policy":
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:",
    };
    for (const [path, file, contentType] of [
      ["/app.js", "app.js", "text/javascript"],
      ["/style.css", "style.css", "text/css"],
      ["/more.js", "more.js", "text/javascript"],
      ["/more.css", "more.css", "text/css"],
      ["/", "index.html", "text/html; charset=utf-8"],
    ]) {
      await context.route(
        (url) => url.pathname === path && !url.search,
        (route) => route.fulfill({ body: readFileSync(`${built}/${file}`), contentType, headers }),
      );
    }
  }
  const page = await context.newPage();
  await gone(page, address);
  const said = [];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  await page.waitForSelector("#strip li");
  return { page, said, context };
}

/** A browser and a folder for the tests of a file, cleared away after them. */
export function house(name) {
  const made = { work: mkdtempSync(join(tmpdir(), `linkwright-${name}-`)), browser: null, studios: 0 };
  before(async () => {
    if (shots) mkdirSync(shots, { recursive: true });
    made.browser = await browser();
  });
  after(async () => {
    await made.browser?.close();
    endAll();
    rmSync(made.work, { recursive: true, force: true });
  });
  return made;
}

/** A studio on a free port, which saves in a folder of its own in the house, with a page. */
export async function begun(house, more = [], options = {}) {
  house.studios += 1;
  const running = await studio("--port", "0", "--out", join(house.work, `results-${house.studios}`), ...more);
  return { ...running, ...(await opened(house.browser, running.address, options)) };
}

export const status = (page) => page.locator("#status").textContent();

/** Waits until the last edit is answered and this is done for it. */
export const doing = (page, what) =>
  page.waitForFunction(
    (what) => document.body.dataset.doing === what && document.body.dataset.answered === document.body.dataset.asked,
    what,
    { timeout: 90_000 },
  );

/** Opens a tab beside the board. */
export const tab = (page, name) => page.locator(`#tab-${name}`).click();

/** Opens a drawer below the board: the details, or the saved searches. */
export async function drawer(page, name) {
  if (!(await page.locator(`#${name}`).evaluate((one) => one.open))) await page.locator(`#${name} > summary`).click();
}

/** Loads an example of the gallery by its number. Those without a picture come with the second script, which the first
 * click of them loads. */
export async function example(page, number) {
  if (await page.locator("#gallery").isHidden()) await button(page, "Examples").click();
  const one = page.locator("#gallery .example").nth(number);
  const later = (await one.locator("svg").count()) === 0;
  await one.click();
  if (later) await page.waitForFunction(() => globalThis.kit);
}

/** The problem file that the page saves. */
export async function problemText(page) {
  await tab(page, "build");
  const coming = page.waitForEvent("download").catch((error) => error);
  await page.getByRole("button", { name: "Problem file" }).click();
  const download = await coming;
  if (download instanceof Error) throw new Error(`the click gave no file, the page says: ${await status(page)}`);
  return readFileSync(await download.path(), "utf8");
}

export const button = (page, name) => page.getByRole("button", { name, exact: true });
