// Why something cannot be shown, in the words of the compiler.
import type { Refusal } from "./api";
import { Stopped } from "./compiler";
import { h } from "./dom";

/** The reason that an answer is none; nothing, if it is one. */
export function refused(answer: Refusal): HTMLElement | undefined {
  const { error, diagnostics } = answer;
  if (error === undefined && diagnostics === undefined) return undefined;
  const notes = (one: { message: string; notes: string[] }) => [
    h("p", null, one.message),
    ...one.notes.map((note) => h("p.soft", null, note)),
  ];
  return h("div.refused", null, error && h("p", null, error), diagnostics?.map(notes));
}

/** A failed question, said where its answer would stand; nothing where a newer question took its place. */
export function failed(error: unknown): HTMLElement | undefined {
  if (error instanceof Stopped && error.replaced) return undefined;
  return h("div.refused", null, h("p", null, error instanceof Error ? error.message : String(error)));
}
