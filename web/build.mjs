// Builds the page: dist/index.html, one file that needs no other, no server and no network.
//
// The compiler must have been built before (`cargo xtask web` does both): its WebAssembly is named by the first
// argument. It goes into the page compressed; scripts go in as they are, and the page's own policy admits these and no others.
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build, transform } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "..");
const wasm = process.argv[2] ?? join(here, "wasm/target/wasm32-unknown-unknown/release/umbrage_playground.wasm");

/** The tables that come with Umbrage, and what they read: one copy, the one in the repository. */
function texts() {
  const folders = [
    ["tables", "The tables that come with Umbrage"],
    ["docs/examples", "Examples of the documentation"],
    ["docs", "Tables as `stabilise` rewrites them"],
    ["tables/published", "Exactly as printed, misprints included"],
  ];
  return folders.flatMap(([folder, group]) =>
    readdirSync(join(root, folder))
      .filter((name) => /\.(ron|csv)$/.test(name))
      .sort()
      .map((name) => {
        const text = readFileSync(join(root, folder, name), "utf8");
        return { name, group, title: /\btitle: "([^"]*)"/.exec(text)?.[1] ?? "", text };
      }),
  );
}

const embedded = {
  name: "embedded",
  setup(build) {
    build.onResolve({ filter: /^embedded:/ }, ({ path }) => ({ path, namespace: "embedded" }));
    build.onLoad({ filter: /.*/, namespace: "embedded" }, () => ({ contents: JSON.stringify(texts()), loader: "json" }));
  },
};

/** The packages that a script was made of. */
const packages = new Set();

async function script(entry) {
  const result = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    charset: "utf8",
    legalComments: "none",
    loader: { ".tmLanguage.json": "json" },
    plugins: [embedded],
    metafile: true,
    write: false,
    logLevel: "warning",
  });
  for (const input of Object.keys(result.metafile.inputs)) {
    const name = /node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1];
    if (name) packages.add(name);
  }
  return result.outputFiles[0].text;
}

/** The licences of these packages, which allow it if they are told. */
function licences() {
  const list = readFileSync(join(root, "deny.toml"), "utf8").split("\nallow = [")[1].split("]")[0];
  const allowed = [...list.matchAll(/"([^"]+)"/g)].map(([, licence]) => licence);
  return [...packages].sort().map((name) => {
    const folder = join(here, "node_modules", name);
    const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    if (!allowed.includes(license)) throw new Error(`${name}: \`${license}\` is not among the licences that deny.toml allows`);
    const file = ["LICENSE", "LICENSE.md", "LICENSE.txt"].map((file) => join(folder, file)).find(existsSync);
    if (!file) throw new Error(`${name} does not bring the text of its licence`);
    return `${name} ${version}\n\n${readFileSync(file, "utf8").trim()}`;
  });
}

const [main, worker] = [await script("main.ts"), await script("worker.ts")];
const style = (await transform(readFileSync(join(here, "src/style.css"), "utf8"), { loader: "css", minify: true })).code;
const compiler = gzipSync(readFileSync(wasm), { level: 9 });

const policy = [
  "default-src 'none'",
  `script-src 'sha256-${createHash("sha256").update(main).digest("base64")}' 'wasm-unsafe-eval'`,
  "worker-src blob:",
  "style-src 'unsafe-inline'",
  "img-src data:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

// A comment of HTML ends at two hyphens and a bracket.
const notices = licences().join("\n\n\n").replaceAll("--", "- -");
const parts = { policy, style, main, worker, notices, compiler: compiler.toString("base64") };
const page = readFileSync(join(here, "src/index.html"), "utf8").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
mkdirSync(join(here, "dist"), { recursive: true });
writeFileSync(join(here, "dist/index.html"), page);
const kib = (bytes) => `${Math.round(bytes / 1024)} KiB`;
console.log(
  `web/dist/index.html: ${kib(page.length)}, of it the compiler ${kib(parts.compiler.length)}, scripts ${kib(main.length + worker.length)}`,
);
