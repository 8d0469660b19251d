// The table in the address: by its name where it came with the page, or else whole, compressed.
import files from "embedded:tables";

export interface Document {
  name: string;
  text: string;
}

/** Longest address that is made: more is cut off by what passes it on. */
const LONGEST = 64 << 10;
/** Most bytes that an address may unfold to, as many as a table may have. */
const MOST = 16 << 20;

async function through(bytes: Uint8Array<ArrayBuffer>, stream: GenericTransformStream): Promise<Uint8Array<ArrayBuffer>> {
  const reader = new Blob([bytes]).stream().pipeThrough(stream as TransformStream<Uint8Array, Uint8Array>).getReader();
  const parts: Uint8Array[] = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > MOST) {
      await reader.cancel();
      throw new Error("it unfolds to more than a table may have");
    }
    parts.push(value);
  }
  const whole = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

function base64(bytes: Uint8Array): string {
  let text = "";
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

function unbase64(text: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
}

/** A file that came with the page. */
export function shipped(name: string): Document | undefined {
  return files.find((file) => file.name === name);
}

/** The end of the address that leads to a table; nothing for one that is too large. */
export async function address(document: Document): Promise<string | undefined> {
  if (shipped(document.name)?.text === document.text) return `#${encodeURIComponent(document.name)}`;
  if (document.text.length > MOST) return undefined;
  const bytes = new TextEncoder().encode(JSON.stringify([document.name, document.text]));
  const packed = base64(await through(bytes, new CompressionStream("deflate-raw")));
  return packed.length <= LONGEST ? `#1.${packed}` : undefined;
}

/** The table that an address leads to; nothing for an address without one. */
export async function find(hash: string): Promise<Document | undefined> {
  const word = hash.replace(/^#/, "");
  if (word === "") return undefined;
  if (!word.startsWith("1.")) {
    const name = decoded(word);
    const found = shipped(name) ?? shipped(`${name}.ron`);
    if (!found) throw new Error(`\`${name.slice(0, 60)}\` is neither a table that comes with Umbrage nor a table itself`);
    return found;
  }
  let read: unknown;
  try {
    const bytes = await through(unbase64(word.slice(2)), new DecompressionStream("deflate-raw"));
    read = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
  } catch (error) {
    throw new Error(`it is cut off or was changed on the way (${error instanceof Error ? error.message : error})`);
  }
  if (!Array.isArray(read) || typeof read[0] !== "string" || typeof read[1] !== "string") throw new Error("it holds no table");
  return { name: named(read[0]), text: read[1] };
}

/** A name in an address; one that is written wrongly stays as it is. */
function decoded(word: string): string {
  try {
    return decodeURIComponent(word);
  } catch {
    return word;
  }
}

/** A name of a file without what could lead elsewhere. */
export function named(name: string): string {
  const plain = name.split(/[\\/]/).at(-1)?.replace(/[^\w.-]/g, "_").slice(0, 80) ?? "";
  return plain.endsWith(".ron") ? plain : `${plain || "table"}.ron`;
}
