// Highlighting of tables and of the expressions in them: the grammar of `editors/`, which Visual Studio Code reads, read
// here. It needs few of the means of such grammars: matches, begins and ends, captures, and rules that include each other.
import { HighlightStyle, LanguageSupport, StreamLanguage, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { tags } from "@lezer/highlight";
import grammar from "../../editors/vscode/syntaxes/umbrage.tmLanguage.json";

interface Raw {
  name?: string;
  match?: string;
  begin?: string;
  end?: string;
  include?: string;
  captures?: Record<string, { name: string }>;
  beginCaptures?: Record<string, { name: string }>;
  endCaptures?: Record<string, { name: string }>;
  patterns?: Raw[];
}
const { patterns: top, repository } = grammar as { patterns: Raw[]; repository: Record<string, Raw> };

interface Rule {
  raw: Raw;
  start: RegExp;
}

interface Context {
  raw: Raw;
  end: RegExp | null;
  rules: Rule[];
}

interface State {
  stack: Context[];
  /** Pieces of a match that are still to be given, with the place each ends at. */
  pending: [end: number, style: string | null][];
}

const styles: [scope: string, style: string][] = [
  ["comment", "comment"],
  ["constant.character.escape", "escape"],
  ["punctuation.definition.string", "quote"],
  ["string", "string"],
  ["variable.other.member", "propertyName"],
  ["punctuation", "punctuation"],
  ["entity.name.tag", "declared"],
  ["keyword.control", "keyword"],
  ["constant.language", "atom"],
  ["entity.name.type", "typeName"],
  ["constant.other", "level"],
  ["support.function", "builtin"],
  ["entity.name.function", "called"],
  ["keyword.operator", "operator"],
  ["variable.other", "variableName"],
  ["constant.numeric", "number"],
  ["meta.attribute", "meta"],
];
const style = (scope?: string) => styles.find(([known]) => scope?.startsWith(known))?.[1] ?? null;

const known = new Map<Raw, Rule[]>();

/** The rules that may begin within a rule, includes followed. */
function rules(of: Raw): Rule[] {
  let found = known.get(of);
  if (!found) {
    found = [];
    known.set(of, found);
    for (const raw of of.patterns ?? []) {
      const included = raw.include ? repository[raw.include.slice(1)] : raw;
      if (!included) continue;
      const start = included.match ?? included.begin;
      if (start === undefined) found.push(...rules(included));
      else found.push({ raw: included, start: new RegExp(start, "dg") });
    }
  }
  return found;
}

const root: Context = { raw: { patterns: top }, end: null, rules: rules({ patterns: top }) };

function first(line: string, at: number, pattern: RegExp): RegExpExecArray | null {
  pattern.lastIndex = at;
  return pattern.exec(line);
}

/** The pieces of a match: its groups with their styles, and what lies between. */
function pieces(match: RegExpExecArray, captures: Raw["captures"], whole: string | null): State["pending"] {
  const found: State["pending"] = [];
  let at = match.index;
  const end = at + match[0].length;
  const groups = Object.entries(captures ?? {}).flatMap(([number, { name }]) => {
    const place = match.indices?.[Number(number)];
    return place ? [{ from: place[0], to: place[1], style: style(name) }] : [];
  });
  for (const group of groups.sort((a, b) => a.from - b.from)) {
    if (group.from > at) found.push([group.from, whole]);
    if (group.to > at) found.push([group.to, group.style]);
    at = Math.max(at, group.to);
  }
  if (end > at) found.push([end, whole]);
  return found;
}

/** Puts the pieces up to the next token into the state; moves through the stack. */
function step(line: string, at: number, state: State): void {
  // Each turn consumes something or leaves a rule that ended where it stood.
  for (let turn = 0; turn < 32; turn++) {
    const context = state.stack.at(-1) ?? root;
    const inner = style(context.raw.name);
    const end = context.end && first(line, at, context.end);
    let best: { match: RegExpExecArray; rule: Rule } | undefined;
    for (const rule of context.rules) {
      const match = first(line, at, rule.start);
      if (match && match[0].length > 0 && match.index < (best?.match.index ?? Infinity)) best = { match, rule };
    }
    if (end && end.index <= (best?.match.index ?? Infinity)) {
      if (end.index > at) state.pending.push([end.index, inner]);
      state.pending.push(...pieces(end, context.raw.endCaptures, inner));
      state.stack.pop();
      if (state.pending.length > 0) return;
      continue;
    }
    if (!best) {
      state.pending.push([line.length, inner]);
      return;
    }
    const { match, rule } = best;
    if (match.index > at) state.pending.push([match.index, inner]);
    const own = style(rule.raw.name);
    if (rule.raw.match) {
      state.pending.push(...pieces(match, rule.raw.captures, own ?? inner));
    } else {
      state.pending.push(...pieces(match, rule.raw.beginCaptures, own ?? inner));
      const ends = (rule.raw.end ?? "$").replace(/\\(\d)/g, (_, n) => (match[Number(n)] ?? "").replace(/[^\w]/g, "\\$&"));
      state.stack.push({ raw: rule.raw, end: new RegExp(ends, "dg"), rules: rules(rule.raw) });
    }
    return;
  }
  state.pending.push([line.length, null]);
}

/** Lines longer than this are left as they are. */
const LONGEST = 5000;

const language = StreamLanguage.define<State>({
  name: "umbrage",
  startState: () => ({ stack: [], pending: [] }),
  copyState: ({ stack, pending }) => ({ stack: [...stack], pending: [...pending] }),
  token(stream, state) {
    if (stream.sol()) state.pending = [];
    if (stream.string.length > LONGEST) {
      stream.skipToEnd();
      return null;
    }
    if (state.pending.length === 0) step(stream.string, stream.pos, state);
    const [end, found] = state.pending.shift() ?? [stream.string.length, null];
    stream.pos = Math.max(end, stream.pos + 1);
    return found;
  },
  languageData: {
    commentTokens: { line: "//", block: { open: "/*", close: "*/" } },
    closeBrackets: { brackets: ["(", "[", "{", '"'] },
    indentOnInput: /^\s*[)\]}]$/,
  },
  tokenTable: {
    quote: tags.punctuation,
    declared: tags.definition(tags.variableName),
    level: tags.constant(tags.variableName),
    builtin: tags.standard(tags.variableName),
    called: tags.function(tags.variableName),
  },
});

/** Colours come from the style of the page, so that light and dark are one decision. */
const colours = HighlightStyle.define([
  { tag: tags.comment, class: "t-comment" },
  { tag: [tags.string, tags.escape], class: "t-string" },
  { tag: tags.propertyName, class: "t-field" },
  { tag: [tags.punctuation, tags.meta], class: "t-faint" },
  { tag: tags.definition(tags.variableName), class: "t-declared" },
  { tag: tags.keyword, class: "t-keyword" },
  { tag: tags.typeName, class: "t-type" },
  { tag: [tags.constant(tags.variableName), tags.atom], class: "t-level" },
  { tag: [tags.standard(tags.variableName), tags.function(tags.variableName)], class: "t-function" },
  { tag: tags.operator, class: "t-operator" },
  { tag: tags.number, class: "t-number" },
]);

export const table = (): LanguageSupport =>
  new LanguageSupport(language, [syntaxHighlighting(colours), indentUnit.of("    ")]);

const words =
  "if|else|switch|case|default|break|return|for|while|loop|let|var|const|fn|pub|struct|impl|enum|match|use|mod|in|out|inout|uniform|layout|precision|static|inline|using|namespace|override";
const types =
  "f32|u32|i32|bool|float|u?int|void|vec[234](<\\w+>)?|[biu]?vec[234]|float[234]|u?int[234]|array|str|String|usize|u8|Option|Self|self|highp|metal";

/** C and its kin, as much as generated code has. */
export const code = (): LanguageSupport =>
  new LanguageSupport(
    StreamLanguage.define<null>({
      name: "generated",
      startState: () => null,
      token(stream) {
        if (stream.eatSpace()) return null;
        if (stream.match(/^(\/\/|#).*/)) return "comment";
        if (stream.match(/^"([^"\\]|\\.)*"/)) return "string";
        if (stream.match(/^(0x[\da-f]+|\d[\d_]*(\.\d*)?(e[+-]?\d+)?)(u|f|_?[uif]\d+)?/i)) return "number";
        if (stream.match(new RegExp(`^(${words})\\b`))) return "keyword";
        if (stream.match(new RegExp(`^(${types})\\b`))) return "typeName";
        if (stream.match(/^(true|false|[A-Z][A-Z\d_]+)\b/)) return "level";
        if (stream.match(/^[A-Za-z_]\w*(?=\()/)) return "called";
        if (stream.match(/^[A-Za-z_]\w*/)) return null;
        if (stream.match(/^[-+*/%<>!|=&^?]+/)) return "operator";
        stream.next();
        return "punctuation";
      },
      tokenTable: { level: tags.constant(tags.variableName), called: tags.function(tags.variableName) },
    }),
    [syntaxHighlighting(colours)],
  );
