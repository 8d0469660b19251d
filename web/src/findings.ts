// Findings: what is wrong with the table or odd, with the place of each, repairs, and what its code means.
import type { Diagnostic } from "./api";
import type { App, Change, View } from "./app";
import { h, plural } from "./dom";

export class Findings implements View {
  readonly id = "findings";
  readonly title = "Findings";
  readonly element = h("div.pane.findings");

  constructor(private readonly app: App) {}

  update(change: Change): void {
    if (change === "point") return;
    const { checked } = this.app;
    const found = checked?.diagnostics ?? [];
    const known = checked?.acknowledged ?? [];
    const list = (all: Diagnostic[]) => h("ol.list", null, all.map((one) => this.item(one)));
    this.element.replaceChildren(
      ...(found.length > 0 ? [list(found)] : [checked ? this.clean() : h("p.soft", null, "The compiler is on its way.")]),
      ...(known.length > 0
        ? [h("details", null, h("summary", null, `${plural(known.length, "finding")} that the table acknowledges`), list(known))]
        : []),
    );
  }

  private clean(): HTMLElement {
    const { checked } = this.app;
    const programs = checked?.programs ?? [];
    const examples = programs.reduce((sum, one) => sum + one.examples.length, 0);
    const facts = programs.every((one) => one.function)
      ? [plural(programs.length, "function"), `${plural(examples, "example")} run`]
      : [
          plural(programs[0]?.count ?? 0, "case"),
          plural(programs[0]?.inputs.length ?? 0, "input"),
          plural(programs[0]?.states ?? 0, "state"),
          `${plural(examples, "example")} run`,
        ];
    return h(
      "div.clean",
      null,
      h("h2", null, checked?.title || checked?.name || ""),
      checked?.origin ? h("p.soft", null, checked.origin) : null,
      h("p", null, h("span.ok", null, "✓ "), "Nothing is wrong with this table: ", facts.join(", "), "."),
      h("p.soft", null, "Change a level, a number or a condition on the left, and see what the checks say of it."),
    );
  }

  private item(one: Diagnostic): HTMLElement {
    const { app } = this;
    const at = one.labels[0];
    const line = at && app.editor.view.state.doc.lineAt(Math.min(at.at[0], app.editor.view.state.doc.length)).number;
    return h(
      `li.finding.${one.severity}`,
      null,
      h(
        "button.headline",
        { click: () => at && app.reveal(at.at), title: "Show it in the table" },
        h(`span.badge.${one.severity}`, null, one.severity),
        h("span", null, one.message),
        line && h("span.where", null, `line ${line}`),
      ),
      one.labels
        .filter((label) => label.message !== "")
        .map((label) => h("button.label", { click: () => app.reveal(label.at) }, label.message)),
      one.notes.map((note) => h("p.note", null, note)),
      one.acknowledged && h("p.soft", null, "Acknowledged: ", one.acknowledged),
      h(
        "p.actions",
        null,
        one.repairs.map((repair) =>
          h(
            "button.small",
            {
              click: () => {
                const [from, to] = repair.at;
                app.editor.view.dispatch({ changes: { from, to, insert: repair.replacement } });
              },
            },
            repair.title,
          ),
        ),
        this.article(one.code),
      ),
    );
  }

  /** What a code means, on request. */
  private article(code: string): HTMLElement {
    const text = h("div.article");
    const details = h("details", null, h("summary", null, `what ${code} means`), text);
    details.addEventListener("toggle", async () => {
      if (text.hasChildNodes()) return;
      const { json } = await this.app.compiler.ask<{ meaning?: string; text?: string }>(`article ${code}`, { do: "article", code });
      text.replaceChildren(...prose(json.text ?? ""));
    });
    return details;
  }
}

/** The little Markdown that articles are written in: paragraphs, code, emphasis of code. */
function prose(text: string): HTMLElement[] {
  return text
    .split(/(```[^\n]*\n[\s\S]*?```)/)
    .flatMap((part) => {
      const fenced = /^```([^\n]*)\n([\s\S]*?)```/.exec(part);
      if (fenced) {
        const kind = fenced[1]?.includes("wrong") ? "For instance" : fenced[1]?.includes("right") ? "Better" : "";
        return [h("figure", null, kind && h("figcaption", null, kind), h("pre", null, fenced[2]?.trimEnd()))];
      }
      return part
        .split(/\n{2,}/)
        .filter((paragraph) => paragraph.trim() !== "")
        .map((paragraph) => h("p", null, paragraph.split(/(`[^`]*`)/).map((piece) => (piece.startsWith("`") ? h("code", null, piece.slice(1, -1)) : piece))));
    });
}
