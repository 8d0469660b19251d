// The editor of the table: CodeMirror with our grammar, findings underlined with their message beside them, and repairs.
import { closeBrackets, closeBracketsKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, indentOnInput } from "@codemirror/language";
import { type Diagnostic as Lint, lintGutter, lintKeymap, nextDiagnostic, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Annotation, EditorState, RangeSet, StateEffect, StateField } from "@codemirror/state";
import {
  Decoration,
  type DecorationSet,
  EditorView,
  WidgetType,
  drawSelection,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSpecialChars,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import type { Diagnostic, Span } from "./api";
import { h } from "./dom";
import { table } from "./grammar";

/** A message under its line, where no line is too long for it. */
class Beside extends WidgetType {
  constructor(
    readonly severity: string,
    readonly message: string,
    readonly column: number,
  ) {
    super();
  }
  override eq(other: Beside): boolean {
    return other.severity === this.severity && other.message === this.message && other.column === this.column;
  }
  toDOM(): HTMLElement {
    // Under the place itself, or as far that way as leaves room for the message.
    const style = `margin-left: min(${this.column}ch, 25%)`;
    return h("div.under-line", { "aria-hidden": "true" }, h(`span.beside.${this.severity}`, { style }, this.message));
  }
}

const setBeside = StateEffect.define<DecorationSet>();
const setLinked = StateEffect.define<DecorationSet>();

/** Decorations that an effect replaces, and that move with the text. */
const field = (effect: typeof setBeside) =>
  StateField.define<DecorationSet>({
    create: () => Decoration.none,
    update: (value, change) => {
      const found = change.effects.find((one) => one.is(effect));
      return found ? (found.value as DecorationSet) : value.map(change.changes);
    },
    provide: (of) => EditorView.decorations.from(of),
  });
const beside = field(setBeside);
export const linked = field(setLinked);

/** Marks lines that belong to what is shown elsewhere. */
export function markLines(view: EditorView, lines: number[]): void {
  const mark = Decoration.line({ class: "linked" });
  const known = lines.filter((line) => line >= 1 && line <= view.state.doc.lines).sort((a, b) => a - b);
  const ranges = known.map((line) => mark.range(view.state.doc.line(line).from));
  view.dispatch({ effects: setLinked.of(RangeSet.of(ranges)) });
}

/** Set on changes that are not the user's typing. */
export const loaded = Annotation.define<boolean>();

export class Editor {
  readonly view: EditorView;

  constructor(
    parent: HTMLElement,
    on: { change(text: string, loaded: boolean): void; cursor(offset: number): void; drop(file: File): void },
  ) {
    const listen = EditorView.updateListener.of((update) => {
      if (update.docChanged) {
        const isLoaded = update.transactions.some((one) => one.annotation(loaded));
        on.change(update.state.doc.toString(), isLoaded);
      }
      if (update.selectionSet && !update.docChanged) on.cursor(update.state.selection.main.head);
    });
    const drop = EditorView.domEventHandlers({
      drop(event) {
        const file = event.dataTransfer?.files[0];
        if (!file) return false;
        event.preventDefault();
        on.drop(file);
        return true;
      },
    });
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        extensions: [
          lineNumbers(),
          lintGutter(),
          highlightActiveLine(),
          highlightActiveLineGutter(),
          highlightSpecialChars(),
          highlightSelectionMatches(),
          drawSelection(),
          history(),
          indentOnInput(),
          bracketMatching(),
          closeBrackets(),
          table(),
          beside,
          linked,
          listen,
          drop,
          EditorState.lineSeparator.of("\n"),
          EditorView.contentAttributes.of({ "aria-label": "The table", spellcheck: "false" }),
          keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...lintKeymap, indentWithTab]),
        ],
      }),
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Puts another text in place of all. */
  load(text: string): void {
    const { length } = this.view.state.doc;
    this.view.dispatch({
      changes: { from: 0, to: length, insert: text },
      selection: { anchor: 0 },
      scrollIntoView: true,
      annotations: loaded.of(true),
    });
  }

  /** Puts a text in place of all that differs from it as little as a formatted one does, where the cursor stays. */
  replace(text: string): void {
    const old = this.text;
    let from = 0;
    while (from < old.length && from < text.length && old[from] === text[from]) from++;
    let [end, newEnd] = [old.length, text.length];
    while (end > from && newEnd > from && old[end - 1] === text[newEnd - 1]) {
      end--;
      newEnd--;
    }
    if (end > from || newEnd > from) this.view.dispatch({ changes: { from, to: end, insert: text.slice(from, newEnd) } });
  }

  /** Shows findings where they belong. */
  show(diagnostics: Diagnostic[]): void {
    const { doc } = this.view.state;
    const within = (place: number) => Math.min(place, doc.length);
    const lints = diagnostics.map((one): Lint => {
      const [from, to] = one.labels[0]?.at ?? [0, 0];
      return {
        from: within(from),
        to: within(Math.max(to, from)),
        severity: one.severity === "note" ? "info" : one.severity,
        message: one.message,
        renderMessage: () => told(one),
        actions: one.repairs.map(({ title, at, replacement }) => ({
          name: title,
          apply: (view: EditorView) => {
            view.dispatch({ changes: { from: at[0], to: at[1], insert: replacement } });
            view.focus();
          },
        })),
      };
    });
    // One message a line, the gravest; what has a place of its own is said there.
    const lines = new Map<number, Diagnostic>();
    for (const one of diagnostics) {
      const first = one.labels[0];
      if (!first || one.severity === "note") continue;
      const line = doc.lineAt(within(first.at[0])).number;
      if (!lines.has(line) || one.severity === "error") lines.set(line, one);
    }
    const marks = [...lines]
      .sort(([a], [b]) => a - b)
      .map(([line, one]) => {
        const more = one.labels[0]?.message ? `: ${one.labels[0].message}` : "";
        const { from, to } = doc.line(line);
        const widget = new Beside(one.severity, one.message + more, within(one.labels[0]?.at[0] ?? 0) - from);
        return Decoration.widget({ widget, side: 1, block: true }).range(to);
      });
    this.view.dispatch(setDiagnostics(this.view.state, lints), { effects: setBeside.of(RangeSet.of(marks)) });
  }

  /** Selects a place and shows it. */
  reveal([from, to]: Span, focus = true): void {
    const { length } = this.view.state.doc;
    const [anchor, head] = [Math.min(from, length), Math.min(to, length)];
    this.view.dispatch({ selection: { anchor, head }, effects: EditorView.scrollIntoView(anchor, { y: "center" }) });
    if (focus) this.view.focus();
  }

  /** Goes to the next finding. */
  next(): void {
    nextDiagnostic(this.view);
  }
}

/** A finding as it is told in full. */
export function told(one: Diagnostic): HTMLElement {
  return h(
    "div.told",
    null,
    h("p", null, h("span.code", null, one.code), " ", one.message),
    one.labels[0]?.message && h("p.soft", null, one.labels[0].message),
    one.notes.map((note) => h("p.note", null, note)),
  );
}
