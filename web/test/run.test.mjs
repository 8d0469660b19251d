// Run: the emitted shader on WebGPU and on WebGL 2, beside the interpreter.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, verdict } from "./browser.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** Waits for the verdict on a run that begins with an action. */
async function ran(page, action) {
  await page.evaluate(() => document.querySelector(".verdict")?.replaceChildren());
  await action();
  await page.waitForFunction(() => document.querySelector(".verdict")?.hasChildNodes() && !document.querySelector(".run.waiting"), undefined, { timeout: 120_000 });
  return page.textContent(".verdict");
}

for (const api of ["WebGPU", "WebGL 2"]) {
  for (const table of ["rsmss", "smsr", "pcg", "slab", "edge_integral", "shade"]) {
    test(`${table} on ${api} agrees with the interpreter, for every plan that suits it`, async () => {
      const page = await open(browser, { hash: `#${table}` });
      await verdict(page, "good, #message.odd");
      let said = await ran(page, () => page.click("#tab-run"));
      said = await ran(page, () => page.selectOption("#run-side", "64"));
      if ((await page.inputValue("#run-api")) !== api) said = await ran(page, () => page.selectOption("#run-api", api));
      assert.match(said, new RegExp(`points? on ${api}`));
      let run = 0;
      for (const plan of await page.$$eval("#run-plan option", (options) => options.map((option) => option.value))) {
        if ((await page.inputValue("#run-plan")) !== plan) said = await ran(page, () => page.selectOption("#run-plan", plan));
        if (/does not suit|cannot/.test(said)) continue;
        // A table without numbers has one point.
        const side = table === "slab" ? 1 : 64;
        assert.match(said, new RegExp(`${side * side} points? on`), `${plan}: ${said}`);
        assert.match(said, /the device agrees with the table/, `${plan}: ${said}`);
        const painted = await page.$$eval(".pictures canvas", (all) => all.map((canvas) => canvas.width));
        assert.deepEqual(painted, [side, side, side]);
        run++;
      }
      assert.ok(run > 0);
      assert.deepEqual(page.said, []);
      await page.context().close();
    });
  }
}

test("a device that computes something else is found out", async () => {
  const page = await open(browser, { hash: "" });
  await page.evaluate(() => {
    const create = GPUDevice.prototype.createShaderModule;
    GPUDevice.prototype.createShaderModule = function ({ code }) {
      return create.call(this, { code: code.replaceAll(/return RsmssResult\(/g, "return RsmssResult(0.5 + 0.25 * ") });
    };
  });
  await verdict(page);
  const said = await ran(page, () => page.click("#tab-run"));
  assert.match(said, /\d+ wrong/);
  assert.match(said, /expected case \d+ with/);
  await page.context().close();
});

test("a device that is lost is asked for anew", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  await page.evaluate(() => {
    const create = GPUDevice.prototype.createBindGroup;
    GPUDevice.prototype.createBindGroup = function (descriptor) {
      GPUDevice.prototype.createBindGroup = create;
      this.destroy();
      return create.call(this, descriptor);
    };
  });
  assert.match(await ran(page, () => page.click("#tab-run")), /^The device was lost/);
  assert.match(await ran(page, () => page.selectOption("#run-side", "32")), /1024 points on WebGPU.*the device agrees/s);
  await page.context().close();
});

test("without WebGPU there is WebGL 2", async () => {
  const context = await browser.newContext();
  await context.addInitScript(() => Object.defineProperty(Navigator.prototype, "gpu", { get: () => undefined }));
  const page = await open(browser, { hash: "#smsr", context });
  await verdict(page);
  assert.match(await ran(page, () => page.click("#tab-run")), /on WebGL 2.*the device agrees with the table/s);
  await context.close();
});

test("a pixel leads to the decision there", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  await ran(page, () => page.click("#tab-run"));
  await page.locator(".pictures canvas").first().click({ position: { x: 20, y: 30 } });
  await page.waitForSelector(".answer .result");
  assert.deepEqual(page.said, []);
  await page.context().close();
});
