// Pictures of the page to look at, and the one in the README: `node test/shots.mjs DIRECTORY`.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { launch, open, verdict } from "./browser.mjs";

const to = process.argv[2] ?? "shots";
mkdirSync(to, { recursive: true });
const browser = await launch();
for (const [width, height, scheme] of [[1280, 800, "light"], [1280, 800, "dark"], [400, 820, "light"], [400, 820, "dark"]]) {
  const page = await open(browser, { width, height, scheme, hash: "#rsmss.ron" });
  await verdict(page);
  const shot = async (name) => page.screenshot({ path: join(to, `${width}-${scheme}-${name}.png`) });
  await page.evaluate(() => {
    const content = document.querySelector("#editor .cm-content");
    const view = content.cmTile?.view ?? content.cmView?.view;
    const at = view.state.doc.toString().indexOf("Case(id: 20,");
    view.dispatch({ selection: { anchor: at }, effects: view.constructor.scrollIntoView(at, { y: "center" }) });
  });
  if (width < 760) await shot("table");
  await page.click("#tab-atlas");
  await page.locator(".panel").nth(19).scrollIntoViewIfNeeded();
  await page.waitForSelector(".panel >> nth=19 >> svg image");
  await page.waitForTimeout(2500);
  const box = await page.locator(".panel").nth(19).locator("svg image").first().boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.4 * box.height);
  await page.waitForTimeout(600);
  await shot("atlas");
  await page.mouse.click(box.x + 0.3 * box.width, box.y + 0.4 * box.height);
  await page.waitForSelector(".answer .result");
  await shot("decision");
  for (const tab of ["code", "coverage", "run", "findings"]) {
    await page.click(`#tab-${tab}`);
    await page.waitForTimeout(tab === "run" ? 3500 : 1200);
    await shot(tab);
  }
  await page.evaluate(() => {
    const content = document.querySelector("#editor .cm-content");
    const view = content.cmTile?.view ?? content.cmView?.view;
    const text = view.state.doc.toString();
    const at = text.indexOf('("1 - py", "V == bottom")');
    view.dispatch({ changes: { from: at, to: at + 25, insert: '("1 - py", "V == botom")' } });
  });
  await verdict(page, "bad");
  await page.waitForTimeout(500);
  await shot("mistake");
  if (page.said.length > 0) console.log(width, scheme, page.said);
  await page.context().close();
}
await browser.close();
