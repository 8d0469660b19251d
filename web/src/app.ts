// The state that the views share, and how they hear of changes.
import type { Checked, Choices, Point, Program, Span } from "./api";
import type { Compiler } from "./compiler";
import type { Editor } from "./editor";

/** A view of the table, on a tab of its own. */
export interface View {
  readonly id: string;
  readonly title: string;
  readonly element: HTMLElement;
  /** Called when the table, the function or the point has changed while the view is shown, and when it comes to be. */
  update(changed: Change): void;
  /** Called when the cursor moved in the table. */
  cursor?(offset: number): void;
}

/** A change that views hear of; `shown` is the view itself coming to be shown. */
export type Change = "table" | "point" | "shown";

export interface App {
  readonly compiler: Compiler;
  readonly editor: Editor;
  choices: Choices | undefined;
  /** The name of the table's file. */
  name: string;
  /** The table as it last was one; kept while the text is none. */
  checked: Checked | undefined;
  /** True while the text is no table, so that what is shown is of an earlier one. */
  stale: boolean;
  /** Counts the tables that were checked. */
  edition: number;
  /** The function that is looked at, in a table of functions. */
  program: number;
  /** The point that is looked at; what it leaves out is as the table says. */
  point: Point;
  /** Looks at a point. */
  look(point: Point, open?: boolean): void;
  /** Looks at a place of the table. */
  reveal(at: Span): void;
  open(id: string): void;
}

/** The program that is looked at. */
export function program(app: App): Program | undefined {
  return app.checked?.programs?.[app.program];
}
