// The views: atlas, decision, code and coverage, and the way from each to the table.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch, open, verdict } from "./browser.mjs";

let browser;
let page;
before(async () => {
  browser = await launch();
  page = await open(browser, { hash: "#rsmss" });
  await verdict(page);
});
after(async () => {
  assert.deepEqual(page?.said, []);
  await browser?.close();
});

/** The line that the cursor of the table is in. */
const line = () =>
  page.evaluate(() => {
    const content = document.querySelector("#editor .cm-content");
    const { state } = content.cmTile?.view ?? content.cmView?.view;
    return { number: state.doc.lineAt(state.selection.main.from).number, text: state.sliceDoc(state.selection.main.from, state.selection.main.to) };
  });

/** Moves to a place of the picture of the case at a place in the list, from 0 to 1, and returns it in pixels. */
async function point(index, x, y) {
  const panel = page.locator(".panel").nth(index);
  await panel.scrollIntoViewIfNeeded();
  const image = panel.locator("svg image").first();
  await image.waitFor();
  const box = await image.boundingBox();
  const at = [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at);
  return at;
}

test("the point under the cursor in the atlas is explained", async () => {
  await page.click("#tab-atlas");
  const at = await point(19, 0.25, 0.75);
  await page.waitForFunction(() => /case 20 gives/.test(document.querySelector(".under").textContent));
  assert.match(await page.textContent(".under"), /px=0\.2\d*.*py=0\.7\d*/);
  await page.mouse.click(...at);
  await page.waitForSelector(".answer .result");
  assert.match(await page.textContent(".answer"), /case 20: dual positive horizontal edge/);
  assert.match(await page.textContent(".answer .steps"), /value/);
  assert.match(await page.textContent(".answer"), /passed over before it/);
});

test("a decision can be made at any point, and leads to its row", async () => {
  await page.click("#tab-decision");
  await page.selectOption("#input-b", "entering");
  await page.selectOption("#input-H", "both");
  await page.selectOption("#input-V", "none");
  await page.selectOption("#input-tH", "positive_negative");
  await page.selectOption("#input-tV", "dual_positive");
  await page.waitForFunction(() => /case 4 needs n_top/.test(document.querySelector(".answer").textContent));
  await page.selectOption("#input-n_top", "left");
  await page.waitForFunction(() => /needs n_bottom/.test(document.querySelector(".answer").textContent));
  await page.selectOption("#input-n_bottom", "none");
  await page.fill("#input-px", "0.75");
  await page.fill("#input-py", "0.25");
  await page.waitForFunction(() => document.querySelector(".answer .result")?.textContent === "0.5");
  await page.click(".answer .link");
  assert.match((await line()).text, /^Case\(id: 4,/);
});

test("generated code is what the command writes, byte for byte", async () => {
  await page.click("#tab-code");
  await page.selectOption("#plan", "ladder");
  await page.selectOption("#target", "wgsl");
  const generated = () => {
    const content = document.querySelector(".generated .cm-content");
    const { doc } = (content?.cmTile?.view ?? content?.cmView?.view)?.state ?? {};
    return /Plan: {3}ladder/.test(doc) && doc.toString();
  };
  const shown = await (await page.waitForFunction(generated)).jsonValue();
  assert.equal(shown, readFileSync(new URL("../../generated/rsmss/ladder.wgsl", import.meta.url), "utf8"));
});

test("rows and generated lines lead to each other", async () => {
  await page.click("#tab-code");
  await page.evaluate(() => {
    const content = document.querySelector("#editor .cm-content");
    const view = content.cmTile?.view ?? content.cmView?.view;
    view.dispatch({ selection: { anchor: view.state.doc.toString().indexOf("Case(id: 17,") + 3 } });
  });
  await page.waitForSelector(".generated .cm-line.linked");
  assert.match(await page.locator(".generated .cm-line.linked").first().textContent(), /\/\/ case 17: corner of a horizontal edge/);
  const other = page.locator(".generated .cm-line", { hasText: "// case 16:" }).first();
  const wanted = Number(/rsmss\.ron:(\d+)/.exec(await other.textContent())[1]);
  await other.click();
  assert.equal((await line()).number, wanted);
});

test("every plan and target either gives code or says why not", async () => {
  await page.click("#tab-code");
  const values = (id) => page.$$eval(`${id} option`, (options) => options.map((option) => option.value));
  const [plans, targets] = [await values("#plan"), await values("#target")];
  assert.ok(plans.length >= 9 && targets.length >= 14);
  const settled = () => page.waitForFunction(() => !document.querySelector(".generated").classList.contains("waiting"), undefined, { timeout: 60_000 });
  await page.selectOption("#plan", "switch");
  for (const target of targets) {
    await page.selectOption("#target", target);
    await settled();
    assert.equal(await page.locator(".generated .refused").count(), 0, target);
    assert.ok((await page.textContent(".generated")).length > 200, target);
  }
  await page.selectOption("#target", "wgsl");
  for (const plan of plans) {
    await page.selectOption("#plan", plan);
    await settled();
    const refused = await page.locator(".generated .refused").allTextContents();
    assert.match(refused[0] ?? `Plan: ${plan}`, new RegExp(`\\b${plan}\\b`));
  }
});

test("every state has its square, which leads to the decision there", async () => {
  await page.click("#tab-coverage");
  await page.waitForSelector("[data-state]");
  assert.equal(await page.locator("[data-state]").count(), 1152);
  const square = page.locator("[data-state='500']");
  const id = (await square.textContent()).trim();
  await square.click();
  await page.waitForSelector(".answer .result");
  assert.match(await page.textContent(".answer"), new RegExp(`case ${id}\\b`));
});

test("everything is within reach of the keyboard", async () => {
  await page.keyboard.press("Alt+4");
  assert.equal(await page.getAttribute("body", "data-tab"), "code");
  await page.focus("#tab-code");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.evaluate(() => document.activeElement.id), "tab-coverage");
  await page.keyboard.press("Alt+2");
  await page.focus(".panel >> nth=19");
  await page.waitForSelector(".panel >> nth=19 >> svg");
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => /case 20 gives/.test(document.querySelector(".under").textContent));
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("body", "data-tab"), "decision");
});
