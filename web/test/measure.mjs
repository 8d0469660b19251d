// How fast the page is: medians over visits, each with nothing in a cache, in a browser that runs already.
// `node test/measure.mjs [TIMES]`
import { readFileSync } from "node:fs";
import { launch, open, paste, verdict } from "./browser.mjs";

const times = Number(process.argv[2] ?? 5);
const rsmss = readFileSync(new URL("../../tables/rsmss.ron", import.meta.url), "utf8");
const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];
const found = { "first paint": [], "table shown": [], "compiler ready": [], "first check of RSMSS": [], "check of RSMSS after ten changes": [] };
const browser = await launch();
const blank = await browser.newPage();
await blank.setContent("<p>The browser is there.</p>");
await blank.screenshot();
for (let time = 0; time < times; time++) {
  const page = await open(browser, { hash: "#rsmss" });
  await verdict(page);
  const took = async () => Number(await page.getAttribute("body", "data-took"));
  const [paint, table, ready] = await page.evaluate(() =>
    ["first-contentful-paint", "table", "compiler"].map((name) => performance.getEntriesByName(name)[0]?.startTime),
  );
  found["first paint"].push(paint);
  found["table shown"].push(table);
  found["compiler ready"].push(ready);
  found["first check of RSMSS"].push(await took());
  for (let change = 0; change < 10; change++) {
    const edition = await page.getAttribute("body", "data-edition");
    await paste(page, `// ${change}\n${rsmss}`);
    await page.waitForFunction((before) => document.body.dataset.edition !== before, edition);
  }
  found["check of RSMSS after ten changes"].push(await took());
  await page.context().close();
}
await browser.close();
for (const [name, values] of Object.entries(found)) {
  const all = values.map((value) => Math.round(value));
  console.log(`${name}: ${median(all)} ms (${all.join(", ")})`);
}
