// The table: open it, break it, mend it, lay it out.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch, open, paste, text, verdict } from "./browser.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const rsmss = readFileSync(new URL("../../tables/rsmss.ron", import.meta.url), "utf8");

test("the page opens with a table that is right, and says nothing on the console", async () => {
  const page = await open(browser);
  assert.match(await verdict(page), /^Nothing is wrong/);
  assert.equal(await text(page), rsmss);
  await page.waitForSelector(".panel.drawn svg");
  assert.deepEqual(page.said, []);
  const paint = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime);
  console.log(`first paint after ${paint?.toFixed(0)} ms; RSMSS: ${await page.textContent("#message .soft")}`);
  await page.context().close();
});

test("a mistake is underlined with its message beside it, and gone once it is mended", async () => {
  const page = await open(browser, { hash: "#rsmss" });
  await verdict(page);
  await paste(page, rsmss.replace("if tV == dual_positive {", "if tV == dual_positiv {"));
  assert.match(await verdict(page, "bad"), /^1 error/);
  await page.click("#tab-findings");
  assert.match(await page.textContent(".finding.error .headline"), /`dual_positiv`/);
  await page.click(".finding.error .headline");
  assert.equal(await page.locator(".cm-lintRange-error").first().textContent(), "dual_positiv");
  assert.match(await page.locator(".beside.error").textContent(), /`dual_positiv`/);
  assert.equal(await page.locator("#tab-findings").getAttribute("data-count"), "1");
  // What the compiler would write instead is one click away.
  await page.click(".finding.error .actions button");
  await verdict(page);
  assert.equal(await text(page), rsmss);
  assert.equal(await page.locator(".cm-lintRange-error, .beside.error").count(), 0);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

test("a changed level breaks a case, as a newcomer would see within a minute", async () => {
  const page = await open(browser, { hash: "#rsmss" });
  await verdict(page);
  await paste(page, rsmss.replace('("1 - py", "V == bottom")', '("1 - py", "V == top")'));
  assert.match(await verdict(page, "bad"), /error/);
  await page.click("#tab-findings");
  const found = await page.textContent(".findings");
  assert.match(found, /case 20/);
  // The article on a code is in the page, too.
  await page.click(".finding .actions summary");
  await page.waitForSelector(".finding .article p");
  await page.locator("#editor .cm-content").press("Control+z");
  await verdict(page);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

test("tables are laid out as `umbrage fmt` does it", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  const smsr = await text(page);
  await paste(page, smsr.replaceAll(/\n {8}Case\(/g, "\n  Case("));
  await verdict(page);
  assert.notEqual(await text(page), smsr);
  await page.locator("#editor .cm-content").press("Alt+Shift+F");
  await page.waitForFunction((whole) => {
    const content = document.querySelector("#editor .cm-content");
    return (content.cmTile?.view ?? content.cmView?.view).state.doc.toString() === whole;
  }, smsr);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

test("every table that comes with the page can be chosen, and means something", async () => {
  const page = await open(browser);
  await verdict(page);
  const names = await page.$$eval("#tables option[title]", (options) => options.map((option) => option.value));
  assert.ok(names.length >= 24, String(names));
  for (const name of names) {
    const edition = await page.getAttribute("body", "data-edition");
    await page.selectOption("#tables", name);
    await page.waitForFunction((before) => document.body.dataset.edition !== before, edition, { timeout: 60_000 });
    assert.doesNotMatch(await page.textContent("#message"), /stopped|gave up/, name);
    console.log(`${name}: ${await page.textContent("#message > :first-child")}, ${await page.textContent("#message .soft")}`);
  }
  assert.deepEqual(page.said, []);
  await page.context().close();
});
