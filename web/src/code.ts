// Generated code of any plan and target, with links between its lines and the rows of the table.
import { EditorState } from "@codemirror/state";
import { EditorView, lineNumbers } from "@codemirror/view";
import { search, searchKeymap } from "@codemirror/search";
import { keymap } from "@codemirror/view";
import type { Code } from "./api";
import { type App, type Change, type View, program } from "./app";
import { h, toast } from "./dom";
import { linked, markLines } from "./editor";
import { code } from "./grammar";
import { failed, refused } from "./refused";

/** A stretch of generated lines that stems from a line of the table. */
interface Link {
  line: number;
  from: number;
  to: number;
}

/** The links that comments such as `// case 17: … (section 3; rsmss.ron:372)` make. */
export function links(text: string, file: string): Link[] {
  const lines = text.split("\n");
  const depth = (line: string) => line.length - line.trimStart().length;
  const found: Link[] = [];
  for (const [index, line] of lines.entries()) {
    const named = /^\s*\/\/.*[(\s]([\w.-]+):(\d+)\)\s*$/.exec(line);
    if (!named || named[1] !== file) continue;
    let to = index + 1;
    while (to < lines.length) {
      const next = lines[to] ?? "";
      if (next.trim() === "" || depth(next) < depth(line) || /^\s*\/\/ case /.test(next)) break;
      to++;
    }
    found.push({ line: Number(named[2]), from: index + 1, to });
  }
  return found;
}

export class CodeView implements View {
  readonly id = "code";
  readonly title = "Code";
  private readonly plan = h<HTMLSelectElement>("select", { id: "plan", change: () => this.update("shown") });
  private readonly target = h<HTMLSelectElement>("select", { id: "target", change: () => this.update("shown") });
  private readonly summary = h("span.soft.summary");
  private readonly place = h("div.generated");
  readonly element = h(
    "div.pane.codes",
    null,
    h(
      "div.controls",
      null,
      h("label", null, "Plan ", this.plan),
      h("label", null, "Target ", this.target),
      h("button.small", { click: () => this.copy() }, "Copy"),
      h("button.small", { click: () => this.save() }, "Save"),
    ),
    this.summary,
    this.place,
  );
  private view?: EditorView;
  private found: Link[] = [];
  private shown = "";
  private bytes?: Uint8Array<ArrayBuffer>;
  private text = "";

  constructor(private readonly app: App) {}

  update(change: Change): void {
    const { choices } = this.app;
    if (change === "point" || !choices || this.app.stale) return;
    if (this.plan.options.length === 0) {
      this.plan.replaceChildren(...choices.plans.map(({ name, summary }) => h("option", { value: name, title: summary }, name)));
      this.target.replaceChildren(...choices.targets.map(({ name }) => h("option", { value: name }, name)));
      this.plan.value = "ordered";
    }
    this.summary.textContent = choices.plans.find(({ name }) => name === this.plan.value)?.summary ?? "";
    const wanted = `${this.app.edition} ${this.plan.value} ${this.target.value}`;
    if (wanted === this.shown) return;
    this.shown = wanted;
    void this.fetch();
  }

  private async fetch(): Promise<void> {
    if (!program(this.app)) {
      this.put(h("p.soft", null, "The table declares things for others; there is nothing to generate."));
      return;
    }
    try {
      this.place.classList.add("waiting");
      const { json, bytes } = await this.app.compiler.ask<Code>("code", { do: "code", plan: this.plan.value, target: this.target.value });
      const reason = refused(json);
      this.bytes = json.bytes ? bytes.slice(json.bytes[0], json.bytes[0] + json.bytes[1]) : undefined;
      this.text = json.text ?? "";
      if (reason) this.put(reason);
      else if (this.bytes) this.put(h("pre.bytes", null, hexadecimal(this.bytes)));
      else this.read(this.text);
    } catch (error) {
      this.shown = "";
      const reason = failed(error);
      if (reason) this.put(reason);
    } finally {
      this.place.classList.remove("waiting");
    }
  }

  private put(element: HTMLElement): void {
    this.view?.destroy();
    this.view = undefined;
    this.found = [];
    this.place.replaceChildren(element);
  }

  private read(text: string): void {
    this.found = links(text, this.app.name);
    if (this.view) {
      const { length } = this.view.state.doc;
      this.view.dispatch({ changes: { from: 0, to: length, insert: text } });
    } else {
      this.place.replaceChildren();
      this.view = new EditorView({
        parent: this.place,
        state: EditorState.create({
          doc: text,
          extensions: [
            lineNumbers(),
            EditorState.readOnly.of(true),
            EditorView.contentAttributes.of({ "aria-label": "Generated code" }),
            search(),
            keymap.of(searchKeymap),
            code(),
            linked,
            EditorView.domEventHandlers({ click: (event, view) => this.clicked(event, view) }),
          ],
        }),
      });
    }
    this.cursor(this.app.editor.view.state.selection.main.head);
  }

  /** Shows the row that a line stems from. */
  private clicked(event: MouseEvent, view: EditorView): boolean {
    const offset = view.posAtCoords({ x: event.clientX, y: event.clientY });
    if (offset === null || !view.state.selection.main.empty) return false;
    const line = view.state.doc.lineAt(offset).number;
    // The innermost stretch is the one that began last.
    const link = this.found.findLast((link) => link.from <= line && line <= link.to);
    const { doc } = this.app.editor.view.state;
    if (!link || link.line > doc.lines) return false;
    const at = doc.line(link.line);
    this.app.reveal([at.from + (at.text.length - at.text.trimStart().length), at.to]);
    return false;
  }

  /** Marks what stems from the row that the cursor is in. */
  cursor(offset: number): void {
    const { view } = this;
    const row = program(this.app)?.cases.find((one) => one.at[0] <= offset && offset <= one.at[1]);
    if (!view) return;
    const { doc } = this.app.editor.view.state;
    const here = doc.lineAt(Math.min(offset, doc.length)).number;
    const [first, last] = row ? row.at.map((at) => doc.lineAt(Math.min(at, doc.length)).number) : [0, -1];
    const ofRow = this.found.filter((link) => link.line >= (first ?? 0) && link.line <= (last ?? -1));
    const ofLine = ofRow.filter((link) => link.line === here && here !== first);
    const chosen = ofLine.length > 0 ? ofLine : ofRow;
    markLines(view, [...new Set(chosen.flatMap(({ from, to }) => Array.from({ length: to - from + 1 }, (_, index) => from + index)))]);
    const start = chosen[0];
    if (start) view.dispatch({ effects: EditorView.scrollIntoView(view.state.doc.line(start.from).from, { y: "center" }) });
  }

  private async copy(): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.text);
      toast("copied");
    } catch {
      toast("The browser does not let pages copy; select the text instead.");
    }
  }

  private save(): void {
    const extension = this.app.choices?.targets.find(({ name }) => name === this.target.value)?.extension ?? "txt";
    save(`${this.app.name.replace(/\.ron$/, "")}.${this.plan.value}.${extension}`, this.bytes ?? this.text);
  }
}

/** Lets the browser save a file. */
export function save(name: string, contents: BlobPart): void {
  const link = h<HTMLAnchorElement>("a", { download: name });
  link.href = URL.createObjectURL(new Blob([contents]));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Words in hexadecimal, as much as anybody reads. */
function hexadecimal(bytes: Uint8Array<ArrayBuffer>): string {
  const words = new Uint32Array(bytes.buffer, 0, bytes.length >> 2);
  const shown = Array.from(words.subarray(0, 2048), (word) => word.toString(16).padStart(8, "0"));
  const lines = Array.from({ length: Math.ceil(shown.length / 8) }, (_, index) => shown.slice(8 * index, 8 * index + 8).join(" "));
  const more = words.length > shown.length ? `\n… ${words.length - shown.length} more words: save it` : "";
  return `${words.length} words\n\n${lines.join("\n")}${more}`;
}
