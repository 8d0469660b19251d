// The page: the table on the left, views of it on the right, and what happens between them.
import files from "embedded:tables";
import type { Checked, Point, Span } from "./api";
import type { App, Change, View } from "./app";
import { AtlasView } from "./atlas";
import { CodeView, save } from "./code";
import { Compiler, Stopped, embedded } from "./compiler";
import { Coverage } from "./coverage";
import { DecisionView } from "./decision";
import { divide } from "./divider";
import { byId, calm, h, plural, toast } from "./dom";
import { Editor } from "./editor";
import { Findings } from "./findings";
import { RunView } from "./run";
import { type Document, address, find, named, shipped } from "./share";
import { theme } from "./theme";

/** The table that is there when nobody says which. */
const FIRST = "rsmss.ron";
/** Milliseconds that one must not have typed for. */
const CALM = 120;

const compiler = new Compiler(byId("worker").textContent ?? "");
const status = byId("message");
const menu = h<HTMLSelectElement>("select", { id: "tables", "aria-label": "Tables to start from", change: () => choose(menu.value) });
const functions = h<HTMLSelectElement>("select", {
  id: "functions",
  "aria-label": "Function",
  change: () => {
    app.program = Number(functions.value);
    app.point = {};
    tell("table");
  },
});

const editor = new Editor(byId("editor"), {
  change(text, isLoaded) {
    if (!isLoaded) menu.value = "";
    status.className = "busy";
    (isLoaded ? check : later)(text);
  },
  cursor: (offset) => views.find((view) => view.id === tab)?.cursor?.(offset),
  drop: (file) => void openFile(file),
});

const app: App = {
  compiler,
  editor,
  choices: undefined,
  name: FIRST,
  checked: undefined,
  stale: true,
  edition: 0,
  program: 0,
  point: {},
  look(point: Point, isOpened = false) {
    app.point = point;
    if (isOpened) open("decision");
    tell("point");
  },
  reveal(at: Span) {
    if (narrow.matches) open("table");
    editor.reveal(at);
  },
  open,
};

const views: View[] = [new Findings(app), new AtlasView(app), new DecisionView(app), new CodeView(app), new Coverage(app), new RunView(app)];
const narrow = matchMedia("(max-width: 760px)");
let tab = "atlas";

// The table

const later = calm(CALM, (text: string) => check(text));
let asked = 0;

function check(text: string): void {
  const own = ++asked;
  compiler
    .check(app.name, text)
    .then(({ json, took }) => {
      if (own === asked) checked(json, took);
    })
    .catch((error) => {
      if (own !== asked || (error instanceof Stopped && error.replaced)) return;
      app.stale = true;
      editor.show([]);
      said("bad", error instanceof Error ? error.message : String(error));
      document.body.classList.add("stale");
    });
  void remember();
}

function checked(json: Checked, took: number): void {
  const found = json.diagnostics ?? [];
  const means = json.programs !== undefined;
  app.stale = !means;
  // Of a text that is no table, findings are new and everything else is of the table before.
  app.checked = means ? json : { ...app.checked, diagnostics: found, acknowledged: [] };
  if (means) app.edition++;
  editor.show(found);
  document.body.classList.toggle("stale", !means);
  document.body.dataset.edition = String(app.edition);
  const count = (severity: string) => found.filter((one) => one.severity === severity).length;
  const [errors, warnings] = [count("error"), count("warning")];
  const time = `checked in ${took < 10 ? took.toFixed(1) : Math.round(took)} ms`;
  if (json.error) said("bad", json.error);
  else if (errors > 0) said("bad", `${plural(errors, "error")}${warnings ? `, ${plural(warnings, "warning")}` : ""}`, time);
  else if (warnings > 0) said("odd", plural(warnings, "warning"), time);
  else said("good", "Nothing is wrong", time);
  document.body.dataset.took = String(took);
  const programs = app.checked.programs ?? [];
  if (means) {
    app.program = Math.min(app.program, Math.max(0, programs.length - 1));
    functions.replaceChildren(...programs.map((one, index) => h("option", { value: index }, one.function ?? one.name)));
    functions.value = String(app.program);
    functions.hidden = programs.length < 2;
    if (Object.keys(app.point).length === 0) app.point = { ...programs[app.program]?.examples[0]?.point };
  }
  const badge = byId("tab-findings");
  badge.dataset.count = errors + warnings > 0 ? String(errors + warnings) : "";
  badge.dataset.severity = errors > 0 ? "error" : "warning";
  tell("table");
}

function said(kind: string, text: string, time = ""): void {
  status.className = kind;
  status.replaceChildren(
    h("span", null, text),
    h("span.soft", null, time),
    h("button.small.stop", { click: () => compiler.stop(), title: "End the compiler's work; it begins anew with the next change" }, "Stop"),
  );
}

// The address

const remember = calm(400, async () => {
  const end = await address({ name: app.name, text: editor.text });
  const now = location.href.split("#")[0] + (end ?? "");
  if (now !== location.href) history.replaceState(null, "", now);
});

async function share(): Promise<void> {
  const end = await address({ name: app.name, text: editor.text });
  if (!end) {
    toast("The table is too large for a link. Save it as a file instead.");
    return;
  }
  history.replaceState(null, "", location.href.split("#")[0] + end);
  const holds = end.startsWith("#1.") ? "it holds the whole table" : "it leads to this table";
  try {
    await navigator.clipboard.writeText(location.href);
    toast(`The link is copied: ${holds}.`);
  } catch {
    toast(`The address of this page is the link: ${holds}.`);
  }
}

async function fromAddress(): Promise<Document | undefined> {
  try {
    return await find(location.hash);
  } catch (error) {
    toast(`This link leads to no table: ${error instanceof Error ? error.message : error}.`);
    return undefined;
  }
}

function load({ name, text }: Document): void {
  app.name = name;
  app.program = 0;
  app.point = {};
  menu.value = shipped(name)?.text === text ? name : "";
  document.title = `${name} – Umbrage playground`;
  if (editor.text === text) check(text);
  else editor.load(text);
}

function choose(name: string): void {
  const found = shipped(name);
  if (found) load(found);
}

async function openFile(file: File): Promise<void> {
  if (file.size > 16 << 20) {
    toast("A table has at most 16 MiB.");
    return;
  }
  load({ name: named(file.name), text: (await file.text()).replace(/^\ufeff/, "").replaceAll("\r\n", "\n") });
}

async function format(): Promise<void> {
  const text = editor.text;
  try {
    const { json } = await compiler.ask<{ text?: string }>("format", { do: "format", name: app.name, text });
    // What was typed meanwhile is worth more.
    if (editor.text !== text) return;
    if (json.text === undefined) toast("Only a table can be laid out: see the findings.");
    else editor.replace(json.text);
  } catch (error) {
    if (!(error instanceof Stopped && error.replaced)) toast(String(error));
  }
}

// Views

function tell(change: Change): void {
  views.find((view) => view.id === tab)?.update(change);
}

function open(id: string): void {
  tab = id;
  document.body.dataset.tab = id;
  for (const button of byId("tabs").querySelectorAll("[role=tab]")) {
    const isChosen = button.id === `tab-${id}`;
    button.setAttribute("aria-selected", String(isChosen));
    button.setAttribute("tabindex", isChosen ? "0" : "-1");
    if (isChosen) button.scrollIntoView({ block: "nearest", inline: "nearest" });
  }
  const view = views.find((view) => view.id === id);
  if (!view) return;
  byId("view").replaceChildren(view.element);
  view.update("shown");
}

const ids = () => [...(narrow.matches ? ["table"] : []), ...views.map((view) => view.id)];

function furnish(): void {
  const groups = [...new Set(files.map((file) => file.group))];
  const tables = files.filter(({ name }) => name.endsWith(".ron"));
  menu.replaceChildren(
    h("option", { value: "", hidden: true }, "your own table"),
    ...groups.map((group) =>
      h(
        "optgroup",
        { label: group },
        tables.filter((file) => file.group === group).map(({ name, title }) => h("option", { value: name, title }, name.replace(/\.ron$/, ""))),
      ),
    ),
  );
  const file = h<HTMLInputElement>("input", {
    type: "file",
    accept: ".ron,text/plain",
    hidden: true,
    change: () => {
      const chosen = file.files?.[0];
      if (chosen) void openFile(chosen);
      file.value = "";
    },
  });
  const button = (id: string, text: string, title: string, click: () => void) => h("button", { id, title, click }, text);
  byId("bar").replaceChildren(
    menu,
    functions,
    h("span.space"),
    button("format", "Format", "Lay the table out (Alt+Shift+F)", () => void format()),
    button("open", "Open", "Open a file, or drop one on the table", () => file.click()),
    button("save", "Save", "Save the table as a file", () => save(app.name, editor.text)),
    button("share", "Share", "Copy a link that holds the table", () => void share()),
    theme(),
    file,
  );
  functions.hidden = true;
  const tabs = [{ id: "table", title: "Table" }, ...views].map(({ id, title }) =>
    h("button", { id: `tab-${id}`, role: "tab", "aria-controls": id === "table" ? "table" : "view", click: () => open(id) }, title),
  );
  byId("tabs").replaceChildren(...tabs);
  byId("tabs").addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    const all = ids();
    const next = all[(all.indexOf(tab) + by + all.length) % all.length] ?? "atlas";
    open(next);
    byId(`tab-${next}`).focus();
  });
  byId("home").addEventListener("click", (event) => {
    event.preventDefault();
    choose(FIRST);
  });
}

addEventListener("keydown", (event) => {
  const number = Number(event.code.replace("Digit", ""));
  if (event.altKey && !event.ctrlKey && number >= 1 && number <= views.length) {
    event.preventDefault();
    open(views[number - 1]?.id ?? "atlas");
  } else if (event.altKey && event.shiftKey && event.code === "KeyF") {
    event.preventDefault();
    void format();
  } else if ((event.ctrlKey || event.metaKey) && event.key === "s") {
    event.preventDefault();
    void share();
  }
});
addEventListener("hashchange", async () => {
  const found = await fromAddress();
  if (found && (found.text !== editor.text || found.name !== app.name)) load(found);
});
narrow.addEventListener("change", () => {
  if (!narrow.matches && tab === "table") open("atlas");
});

async function begin(): Promise<void> {
  furnish();
  divide();
  open(narrow.matches ? "table" : tab);
  said("busy", "The compiler is on its way");
  const first = (await fromAddress()) ?? shipped(FIRST);
  if (first) load(first);
  performance.mark("table");
  // The compiler stands at the end of the page, which may still be on its way.
  if (document.readyState === "loading") await new Promise((ready) => addEventListener("DOMContentLoaded", ready, { once: true }));
  try {
    const module = await embedded(byId("compiler").textContent ?? "");
    app.choices = await compiler.begin(module, files.map(({ name, text }) => [name, text]));
    tell("shown");
    performance.mark("compiler");
  } catch (error) {
    said("bad", `This browser cannot run the compiler: ${error instanceof Error ? error.message : error}`);
  }
}
void begin();
