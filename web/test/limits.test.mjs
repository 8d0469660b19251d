// What a page must live through: tables that are too large, nest too deeply or take too long, and a compiler that gives up.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, paste, text, verdict } from "./browser.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** Shows that the page is alive: another table is checked. */
async function alive(page) {
  await page.selectOption("#tables", "first.ron");
  await verdict(page);
  await page.click("#tab-decision");
  await page.waitForSelector(".answer .result");
}

test("a table of 16 MiB is looked at, a larger one refused", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  const smsr = await text(page);
  const padded = (bytes) => smsr + `// ${"x".repeat(77)}\n`.repeat(Math.floor((bytes - smsr.length) / 81));
  await paste(page, padded(16 << 20));
  await page.waitForFunction(() => document.querySelector("#message").className === "busy");
  assert.match(await verdict(page), /^Nothing is wrong/);
  await page.click("#share");
  await page.waitForSelector("#toast.on");
  assert.match(await page.textContent("#toast"), /too large for a link|link/);
  await paste(page, padded(17 << 20));
  assert.match(await verdict(page, "bad"), /at most 16 MiB/);
  await alive(page);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

const strange = {
  "nothing at all": "",
  "a closing parenthesis": ")".repeat(100_000),
  "a hundred thousand opening ones": "(".repeat(100_000),
  "an expression that nests without end": `Table(language: 1, name: "deep", hit_policy: First, inputs: {"x": Range(from: 0, to: 1)}, output: Number(), cases: [Case(id: 1, when: true, value: "${"(".repeat(200_000)}x${")".repeat(200_000)}")], default: 0)`,
  "sums of sums": `Table(language: 1, name: "long", hit_policy: First, inputs: {"x": Range(from: 0, to: 1)}, output: Number(), cases: [Case(id: 1, when: true, value: "${"x + ".repeat(100_000)}x")], default: 0)`,
  "an import that is not there": `Table(language: 1, name: "lone", imports: {"other": "../../etc/passwd"}, functions: [])`,
  "half of a pair of UTF-16": "Table(name: \"\ud800\")",
};
/** Symmetries whose images never come back to where they began. */
const orbits = `Table(language: 2, name: "orbits", hit_policy: First,
  inputs: {"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1), "a": Int(from: 0, to: 50)},
  symmetries: {"half": Symmetry(map: {"x": "x * 0.7 + 0.1"}), "turn": Symmetry(map: {"x": "0.6 * x - 0.8 * y + 0.5", "y": "0.8 * x + 0.6 * y"}), "on": Symmetry(map: {"a": "(a + 1) % 51"})},
  output: Number(), cases: [Case(id: 1, when: "x < 0.3 && a % 7 == 2", value: "x * y"MORE)], default: 0)`;
test("the page lives through endless orbits", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  // As cases they are refused; as symmetries they are looked at as far as is reasonable.
  await paste(page, orbits.replace("MORE", ', images: ["half", "turn", "on"]'));
  await verdict(page, "bad");
  await paste(page, orbits.replace("MORE", ""));
  await page.waitForFunction(() => !/^(busy|bad)$/.test(document.querySelector("#message").className), undefined, { timeout: 60_000 });
  for (const tab of ["findings", "atlas", "code", "coverage", "run"]) await page.click(`#tab-${tab}`);
  await alive(page);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

for (const [name, table] of Object.entries(strange)) {
  test(`the page lives through ${name}`, async () => {
    const page = await open(browser, { hash: "#smsr" });
    await verdict(page);
    await paste(page, table);
    await page.waitForFunction(() => document.querySelector("#message").className === "bad", undefined, { timeout: 60_000 });
    await alive(page);
    assert.deepEqual(page.said, []);
    await page.context().close();
  });
}

/** A table of so many states that looking at all of them takes longer than a page should. */
function enormous(bits) {
  const inputs = Array.from({ length: bits }, (_, index) => `"b${index}": Bool()`).join(", ");
  const cases = Array.from({ length: 40 }, (_, index) => {
    const when = Array.from({ length: 6 }, (_, part) => `b${(index * 7 + part * 5) % bits} ${part % 2 ? "||" : "&&"} !b${(index * 3 + part) % bits}`);
    return `Case(id: ${index + 1}, when: "${when.join(" && ")} && x > ${index / 41}", value: "x * ${index} / 41")`;
  });
  return `Table(language: 1, name: "enormous", hit_policy: Unique, inputs: {${inputs}, "x": Range(from: 0, to: 1)}, output: Number(), cases: [${cases.join(", ")}], default: 0)`;
}

test("a table that takes long can be stopped, and typing goes on meanwhile", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  await paste(page, enormous(22));
  await page.waitForSelector("#message.busy .stop", { state: "visible", timeout: 15_000 });
  // The page answers while the compiler works.
  const start = Date.now();
  await page.click("#tab-findings");
  await page.keyboard.press("Alt+3");
  assert.ok(Date.now() - start < 2000);
  await page.click("#message .stop");
  assert.match(await verdict(page, "bad"), /stopped/);
  await alive(page);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

test("a table that is never done is given up by itself", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  // One question is lost on its way, so that there is no end to it.
  await page.evaluate(() => {
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message) {
      if (message.json?.do === "check") Worker.prototype.postMessage = post;
      else post.call(this, message);
    };
  });
  await paste(page, "Table(");
  await page.waitForFunction(() => document.querySelector("#message").className === "bad", undefined, { timeout: 60_000 });
  assert.match(await page.textContent("#message"), /stopped after 20 seconds/);
  await alive(page);
  await page.context().close();
});

test("a new table does not wait for the old one", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  await paste(page, enormous(22));
  await page.waitForTimeout(1500);
  await alive(page);
  assert.deepEqual(page.said, []);
  await page.context().close();
});

test("a compiler that gives up is started again", async () => {
  const page = await open(browser, { hash: "#smsr" });
  await verdict(page);
  await page.click("#tab-code");
  await page.waitForSelector(".generated .cm-line");
  // The next answer is a trap, as if memory had run out.
  await page.evaluate(() => {
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message) {
      if (message.json?.do === "code") {
        Worker.prototype.postMessage = post;
        this.onmessage({ data: { id: message.id, trap: "unreachable" } });
      } else post.call(this, message);
    };
  });
  await page.selectOption("#plan", "ladder");
  await page.waitForSelector(".generated .refused");
  assert.match(await page.textContent(".generated .refused"), /the compiler gave up: unreachable/);
  await page.selectOption("#plan", "tree");
  await page.waitForSelector(".generated .cm-line");
  assert.deepEqual(page.said, []);
  await page.context().close();
});
