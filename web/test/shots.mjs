// Pictures of the page to look at: `node test/shots.mjs DIRECTORY`.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { launch, open, verdict } from "./browser.mjs";

const to = process.argv[2] ?? "shots";
mkdirSync(to, { recursive: true });
const browser = await launch();
for (const [width, height, scheme] of [[1280, 800, "light"], [1280, 800, "dark"], [400, 820, "light"], [400, 820, "dark"]]) {
  const page = await open(browser, { width, height, scheme, hash: "#rsmss.ron" });
  await verdict(page);
  const tabs = width < 760 ? ["table", "findings", "atlas", "decision", "code", "coverage", "run"] : ["findings", "atlas", "decision", "code", "coverage", "run"];
  for (const tab of tabs) {
    await page.click(`#tab-${tab}`);
    await page.waitForTimeout(tab === "run" || tab === "atlas" ? 4000 : 1200);
    await page.screenshot({ path: join(to, `${width}-${scheme}-${tab}.png`) });
  }
  console.log(width, scheme, page.said);
  await page.context().close();
}
await browser.close();
