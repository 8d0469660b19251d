// What the compiler answers: the shapes of the messages of `web/wasm`.

/** A place in the table, in halves of UTF-16. */
export type Span = [from: number, to: number];
export type Severity = "note" | "warning" | "error";
export type Point = Record<string, string>;

export interface Diagnostic {
  code: string;
  severity: Severity;
  message: string;
  labels: { at: Span; message: string }[];
  notes: string[];
  repairs: { title: string; at: Span; replacement: string }[];
  acknowledged?: string;
}

export type Domain =
  | { kind: "levels" | "bool"; levels: string[] }
  | { kind: "number"; lo: number; hi: number; unit: string }
  | { kind: "integer" | "word"; lo: number; hi: number };

export interface Input {
  name: string;
  doc: string;
  domain: Domain;
  fetched: number | null;
  default: string | null;
  least: string;
}

export interface Case {
  id: number;
  doc: string;
  section: string;
  /** The number of lines of its value. */
  lines: number;
  under: string[];
  at: Span;
  line: number;
}

export interface Program {
  name: string;
  function: string | null;
  states: number;
  inputs: Input[];
  output: string;
  cases: Case[];
  examples: { row: number; at: Span; point: Point }[];
  count: number;
}

export interface Checked {
  error?: string;
  name?: string;
  title?: string;
  origin?: string;
  diagnostics?: Diagnostic[];
  acknowledged?: Diagnostic[];
  programs?: Program[];
}

export interface Choices {
  version: string;
  plans: { name: string; summary: string }[];
  targets: { name: string; extension: string }[];
}

/** An answer may say instead why there is none. */
export interface Refusal {
  error?: string;
  diagnostics?: Diagnostic[];
}

export interface Matrix extends Refusal {
  html: string;
}

export interface Panel extends Refusal {
  svg: string;
  width: number;
  shown: { point: Point; place: [number, number, number, number]; across: string | null; down: string | null } | null;
}

export interface Tested {
  condition: string;
  facts: string[];
}

export interface Decision extends Refusal {
  point: Point;
  /** A fetched input that is needed and not given. */
  needs?: string;
  by?: number | null;
  refused: { case: number; doc: string; at: Span; fails: Tested }[];
  case: { id: number; doc: string; section: string; lines: number; at: Span; line: number } | null;
  also: number[];
  guard: Tested[];
  refused_lines: Tested[];
  line: { at: Span; line: number } | null;
  value_line: number | null;
  line_condition: Tested[];
  steps: { name: string; formula: string; numbers: string | null; because: string | null; value: string }[];
  fetched: string[];
  cost: number;
  value: string;
}

/** A part of the bytes of an answer: where it begins, and how long it is. */
export type Piece = [start: number, length: number];

export interface Code extends Refusal {
  text?: string;
  bytes?: Piece;
}

export interface Run extends Refusal {
  rows: number;
  out: number;
  workgroup: number;
  wgsl: string;
  passes: string[];
  texels: number;
  uniforms: [plain: string, fetched: string, lookup: string, width: string];
  plan: string;
  pixels: Piece;
  cases: Piece;
  plain: Piece;
  fetched?: Piece;
  lookup?: Piece;
}

export interface Verdict extends Refusal {
  equal: number;
  admissible: number;
  reordered: number;
  offending: number;
  excluded: number;
  worst: number | null;
  offenders: { inputs: string; reason: string }[];
  pixels: Piece;
  marks: Piece;
}
