// The worker: hands messages to the compiler and its answers back. A trap ends it; the page then starts another.

interface Exports {
  memory: WebAssembly.Memory;
  reserve(bytes: number): number;
  answer(): number;
  answer_bytes(): number;
  last_words(): number;
  last_words_bytes(): number;
}

let compiler: Exports | undefined;

const encoder = new TextEncoder();
const decoder = new TextDecoder();

function ask({ memory, reserve, answer, answer_bytes }: Exports, json: unknown, bytes?: Uint8Array) {
  const text = encoder.encode(JSON.stringify(json));
  const length = 4 + text.length + (bytes?.length ?? 0);
  const at = reserve(length);
  // Memory may have grown, so its buffer is asked for anew each time.
  const room = new Uint8Array(memory.buffer, at, length);
  new DataView(memory.buffer).setUint32(at, text.length, true);
  room.set(text, 4);
  if (bytes) room.set(bytes, 4 + text.length);
  const from = answer();
  const answered = new Uint8Array(memory.buffer, from, answer_bytes());
  const end = 4 + new DataView(memory.buffer).getUint32(from, true);
  return { json: JSON.parse(decoder.decode(answered.subarray(4, end))), bytes: answered.slice(end) };
}

/** The reason of a trap, in words. */
function reason(error: unknown): string {
  if (error instanceof RangeError) return "it nests more deeply, or takes more memory, than a browser allows";
  const exports = compiler;
  try {
    const length = exports?.last_words_bytes() ?? 0;
    if (exports && length > 0) return decoder.decode(new Uint8Array(exports.memory.buffer, exports.last_words(), length));
  } catch {
    // What is left of the module is no longer fit to be read.
  }
  return String(error);
}

/**
 * What the module asks for. A library for plots brings bindings to pages along, which nothing here calls: the compiler
 * needs nothing from its surroundings, and would be told so.
 */
function imports(module: WebAssembly.Module): WebAssembly.Imports {
  const all: WebAssembly.Imports = {};
  for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
    if (kind !== "function") throw new Error(`the compiler asks for ${from}.${name}`);
    const absent = () => {
      throw new Error(`the compiler called ${from}.${name}`);
    };
    (all[from] ??= {})[name] = absent;
  }
  return all;
}

self.onmessage = async ({ data }: MessageEvent) => {
  if (data.module) {
    const instance = await WebAssembly.instantiate(data.module as WebAssembly.Module, imports(data.module));
    compiler = instance.exports as unknown as Exports;
    return;
  }
  try {
    if (!compiler) throw new Error("the compiler is not there yet");
    const start = performance.now();
    const answered = ask(compiler, data.json, data.bytes);
    const took = performance.now() - start;
    self.postMessage({ id: data.id, ...answered, took }, { transfer: [answered.bytes.buffer] });
  } catch (error) {
    self.postMessage({ id: data.id, trap: reason(error) });
  }
};
