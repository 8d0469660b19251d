// The table in the address: shared, opened elsewhere, loaded again; and links that are broken.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { PAGE, launch, open, paste, text, verdict } from "./browser.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const link = (value) => `#1.${deflateRawSync(Buffer.from(typeof value === "string" ? value : JSON.stringify(value))).toString("base64url")}`;

test("a link holds the whole table", async () => {
  const page = await open(browser, { hash: "#smsr.ron" });
  await verdict(page);
  const changed = (await text(page)).replace("Table(", "// Grüße, 影\nTable(");
  await paste(page, changed);
  await page.waitForFunction(() => document.querySelector("#message").className === "good");
  await page.click("#share");
  await page.waitForFunction(() => location.hash.startsWith("#1."));
  await page.waitForSelector("#toast.on");
  assert.match(await page.textContent("#toast"), /link/);
  const url = page.url();
  assert.ok(url.length < 8000, `${url.length}`);
  const other = await open(browser, { hash: new URL(url).hash });
  await verdict(other);
  assert.equal(await text(other), changed);
  assert.match(await other.title(), /^smsr\.ron/);
  await other.reload();
  await verdict(other);
  assert.equal(await text(other), changed);
  assert.deepEqual([...page.said, ...other.said], []);
  await Promise.all([page.context().close(), other.context().close()]);
});

test("what was typed is in the address without asking, and a table that came with the page is there by its name", async () => {
  const page = await open(browser);
  await verdict(page);
  await page.waitForFunction(() => location.hash === "#rsmss.ron");
  const rsmss = await text(page);
  await paste(page, `// mine\n${rsmss}`);
  await page.waitForFunction(() => location.hash.startsWith("#1."));
  await page.reload();
  await verdict(page);
  assert.equal(await text(page), `// mine\n${rsmss}`);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

const broken = [
  ["#1.AAAA", /cut off or was changed/],
  ["#1.%%%", /cut off or was changed/],
  ["#%E0%A4%A", /neither a table/],
  [link(["a.ron", "Table("]).slice(0, -6), /cut off or was changed/],
  [link({ name: "x" }), /holds no table/],
  [link("no JSON"), /cut off or was changed/],
  ["#no-such-table", /neither a table that comes with Umbrage/],
  // 64 MiB of blanks, in 64 KiB.
  [link(["a.ron", " ".repeat(64 << 20)]), /unfolds to more than a table may have/],
];
for (const [hash, expected] of broken) {
  test(`a broken link says so and leads to a table all the same: ${hash.slice(0, 20)}`, async () => {
    const page = await open(browser, { hash });
    await page.waitForSelector("#toast.on");
    assert.match(await page.textContent("#toast"), expected);
    await verdict(page);
    assert.match(await text(page), /name: "rsmss"/);
    assert.deepEqual(page.said, []);
    await page.context().close();
  });
}

test("what a link holds is text, whatever it looks like", async () => {
  const evil = '<img src=x onerror="document.title=1">';
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  const smsr = await text(page);
  const changed = smsr.replace(/doc: "[^"]*"/g, `doc: ${JSON.stringify(evil)}`).replace(/title: "[^"]*"/, `title: ${JSON.stringify(evil)}`);
  const other = await open(browser, { hash: link(["../../<b>.ron", changed]) });
  await verdict(other, "good, #message.odd");
  for (const tab of ["findings", "atlas", "decision", "code", "coverage", "run"]) {
    await other.click(`#tab-${tab}`);
    await other.waitForTimeout(600);
    assert.equal(await other.locator("#view img, header img").count(), 0, tab);
  }
  assert.match(await other.title(), /^_b_\.ron/);
  // The page's policy would have said so.
  assert.deepEqual(other.said, []);
  await Promise.all([page.context().close(), other.context().close()]);
});

test("another link in the same window is followed", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  await page.evaluate(() => {
    location.hash = "#pcg";
  });
  await page.waitForFunction(() => document.title.startsWith("pcg.ron"));
  await verdict(page);
  assert.ok(page.url().startsWith(PAGE));
  await page.context().close();
});
