// The browser that the tests drive: Debian's Chromium, or the one that CHROMIUM names, without a window, with WebGPU and
// WebGL 2 in software. The page is opened from its file: it needs no server.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const here = dirname(fileURLToPath(import.meta.url));
export const PAGE = pathToFileURL(join(here, "../dist/index.html")).href;

const found = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(
  (path) => path && existsSync(path),
);

/** Starts the browser. */
export function launch(extra = []) {
  if (!found) throw new Error("Chromium is missing: install Debian's package `chromium`, or name one by CHROMIUM");
  const software = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"];
  const quiet = ["--no-sandbox", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  return chromium.launch({ executablePath: found, args: [...software, ...quiet, ...extra] });
}

/** Opens the page; what it says on the console, and what it asks the network for, is gathered. */
export async function open(browser, { width = 1280, height = 800, scheme = "light", hash = "", context } = {}) {
  context ??= await browser.newContext({ viewport: { width, height }, colorScheme: scheme });
  const page = await context.newPage();
  page.said = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && page.said.push(message.text()));
  page.on("pageerror", (error) => page.said.push(String(error)));
  page.on("request", (request) => /^(https?|wss?):/.test(request.url()) && page.said.push(`asked for ${request.url()}`));
  await page.goto(PAGE + hash);
  return page;
}

/** Waits until the compiler has said something of the table: its verdict on the bar below it. */
export async function verdict(page, kind = "good") {
  await page.waitForSelector(`#message.${kind}`, { state: "attached", timeout: 60_000 });
  return page.textContent("#message");
}

/** Puts a text in place of the table, as if it were pasted. */
export async function paste(page, text) {
  await page.evaluate((text) => {
    const view = document.querySelector("#editor .cm-content").cmTile?.view ?? document.querySelector("#editor .cm-content").cmView?.view;
    view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
  }, text);
}

/** The text of the table. */
export function text(page) {
  return page.evaluate(() => {
    const content = document.querySelector("#editor .cm-content");
    return (content.cmTile?.view ?? content.cmView?.view).state.doc.toString();
  });
}
