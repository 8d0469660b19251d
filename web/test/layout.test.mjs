// Widths and colours: nothing sticks out at 1280 or at 400 pixels, in the light and in the dark.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, verdict } from "./browser.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

for (const width of [1280, 400]) {
  test(`nothing sticks out at ${width} pixels`, async () => {
    const page = await open(browser, { width, hash: "#rsmss" });
    await verdict(page);
    for (const tab of await page.$$eval("#tabs [role=tab]", (all) => all.map((one) => one.id))) {
      if (!(await page.isVisible(`#${tab}`))) continue;
      await page.click(`#${tab}`);
      await page.waitForTimeout(800);
      const [page_, view] = await page.evaluate(() => {
        const pane = document.querySelector("#view .pane:not(.coverage):not(.codes)");
        return [document.documentElement.scrollWidth, pane && pane.clientWidth > 0 ? pane.scrollWidth - pane.clientWidth : 0];
      });
      assert.ok(page_ <= width, `${tab}: ${page_}`);
      assert.ok(view <= 0, `${tab}: the view is ${view} too wide`);
      assert.ok(await page.isVisible("#share"), tab);
    }
    assert.deepEqual(page.said, []);
    await page.context().close();
  });
}

test("at 400 pixels a link into the table leads there", async () => {
  const page = await open(browser, { width: 400, hash: "#smsr" });
  await verdict(page);
  assert.equal(await page.getAttribute("body", "data-tab"), "table");
  await page.click("#tab-decision");
  await page.waitForSelector(".answer .result");
  await page.click(".answer .link");
  assert.equal(await page.getAttribute("body", "data-tab"), "table");
  assert.ok(await page.isVisible("#editor .cm-content"));
  await page.context().close();
});

test("colours follow the system until somebody chooses", async () => {
  const page = await open(browser, { scheme: "dark", hash: "#smsr" });
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  assert.equal(await ground(), "rgb(20, 22, 26)");
  await page.click("#theme");
  assert.equal(await ground(), "rgb(246, 245, 241)");
  await page.reload();
  assert.equal(await ground(), "rgb(246, 245, 241)");
  await page.click("#theme");
  await page.emulateMedia({ colorScheme: "light" });
  assert.equal(await ground(), "rgb(20, 22, 26)");
  await page.context().close();
});
