// The compiler as the page sees it: questions and promises. It runs in a worker that is ended and started again when a
// question takes too long, when it traps, or when a newer table makes its work worthless; the page itself never waits.
import type { Checked, Choices } from "./api";

export interface Answer<T> {
  json: T;
  bytes: Uint8Array<ArrayBuffer>;
  /** Milliseconds within the compiler. */
  took: number;
}

/** Why there is no answer. */
export class Stopped extends Error {
  /** True where a newer question took its place, so that nobody needs to be told. */
  constructor(
    message: string,
    readonly replaced = false,
  ) {
    super(message);
  }
}

interface Question {
  id: number;
  json: Record<string, unknown>;
  bytes?: Uint8Array;
  /** Questions of one kind take each other's place. */
  kind: string;
  resolve(answer: Answer<never>): void;
  reject(error: Stopped): void;
}

/** Milliseconds until the compiler is stopped. */
export const PATIENCE = 20_000;
/** Milliseconds that a new table waits for an answer about the old one before the worker is ended. */
const COURTESY = 150;

export class Compiler {
  private module?: WebAssembly.Module;
  private worker?: Worker;
  private readonly waiting: Question[] = [];
  private current?: Question;
  private started = 0;
  private timer = 0;
  private next = 1;
  private texts: [string, string][] = [];
  /** The last table that was checked, which a new worker must be told first. */
  private known?: { name: string; text: string };
  private readonly script: string;
  /** Times in a row that a worker did not even begin. */
  private failures = 0;

  constructor(script: string) {
    this.script = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  }

  /** Begins with the compiler's module and the texts that tables may import. */
  async begin(module: WebAssembly.Module, texts: [string, string][]): Promise<Choices> {
    this.module = module;
    this.texts = texts;
    return (await this.ask<Choices>("begin", { do: "begin", texts })).json;
  }

  /** Checks a table. Everything that was asked about the one before is dropped. */
  async check(name: string, text: string): Promise<Answer<Checked>> {
    this.drop(() => true);
    const current = this.current;
    if (current && current.kind !== "begin") {
      const left = Math.max(0, this.started + COURTESY - performance.now());
      setTimeout(() => {
        if (this.current === current) this.restart(new Stopped("the table was changed", true));
      }, left);
    }
    this.known = undefined;
    const answer = await this.ask<Checked>("check", { do: "check", name, text });
    this.known = { name, text };
    return answer;
  }

  /** Asks about the table as it was last checked. A question of the same kind that still waits is dropped. */
  ask<T>(kind: string, json: Record<string, unknown>, bytes?: Uint8Array): Promise<Answer<T>> {
    this.drop((question) => question.kind === kind);
    return new Promise((resolve, reject) => {
      const question = { id: this.next++, json, bytes, kind, resolve, reject } as unknown as Question;
      // Tables are read with what they import at hand.
      if (kind === "begin") this.waiting.unshift(question);
      else this.waiting.push(question);
      this.go();
    });
  }

  /** Ends what runs and what waits, because somebody said so. */
  stop(): void {
    this.drop(() => true);
    if (this.current) this.restart(new Stopped("stopped"));
  }

  /** True while the compiler works. */
  get busy(): boolean {
    return this.current !== undefined;
  }

  private drop(which: (question: Question) => boolean): void {
    for (let at = this.waiting.length - 1; at >= 0; at--) {
      const question = this.waiting[at];
      if (question && question.kind !== "begin" && which(question)) {
        this.waiting.splice(at, 1);
        question.reject(new Stopped("replaced", true));
      }
    }
  }

  private go(): void {
    if (this.current || !this.module) return;
    if (!this.worker) this.start(this.module);
    const question = this.waiting.shift();
    if (!question) return;
    this.current = question;
    this.started = performance.now();
    this.timer = window.setTimeout(() => {
      this.restart(new Stopped(`stopped after ${PATIENCE / 1000} seconds: this takes longer than a page should`));
    }, PATIENCE);
    this.worker?.postMessage({ id: question.id, json: question.json, bytes: question.bytes });
  }

  private start(module: WebAssembly.Module): void {
    const worker = new Worker(this.script);
    worker.onmessage = ({ data }) => {
      const question = this.current;
      if (!question || data.id !== question.id) return;
      if (data.trap !== undefined) {
        this.restart(new Stopped(`the compiler gave up: ${data.trap}`));
        return;
      }
      this.finish();
      question.resolve(data as Answer<never>);
      this.go();
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.restart(new Stopped(`the compiler gave up: ${event.message}`));
    };
    worker.postMessage({ module });
    this.worker = worker;
  }

  private finish(): void {
    clearTimeout(this.timer);
    this.current = undefined;
  }

  /** Ends the worker, rejects what it was doing, and tells a new one what the old one knew. */
  private restart(reason: Stopped): void {
    const question = this.current;
    this.worker?.terminate();
    this.worker = undefined;
    this.finish();
    question?.reject(reason);
    this.failures = question?.kind === "begin" ? this.failures + 1 : 0;
    if (this.failures > 2) return;
    const again = (json: Record<string, unknown>): Question => {
      return { id: this.next++, json, kind: "begin", resolve: () => {}, reject: () => {} };
    };
    const known = this.known;
    // A table that could not be checked is not tried again.
    if (known && question?.kind !== "check" && !reason.replaced) this.waiting.unshift(again({ do: "check", ...known }));
    this.waiting.unshift(again({ do: "begin", texts: this.texts }));
    this.go();
  }
}

/** Decodes the compiler that stands in the page. */
export async function embedded(base64: string): Promise<WebAssembly.Module> {
  const bytes = Uint8Array.from(atob(base64.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}
