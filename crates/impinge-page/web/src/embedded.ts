// What the file carries: the scene that it opens, a recording, and the engine.

import { PageError } from "./messages";

export interface Scene {
  open: "recording" | "live" | "samples";
  title: string;
  /** Where the bytes of a live recording come from. */
  log?: string;
}

/** What the page opens. */
export function readScene(): Scene {
  return JSON.parse(textOf("impinge-scene")) as Scene;
}

/** The bytes of a recording, packed or not: the engine reads both. */
export function readRecording(): Uint8Array<ArrayBuffer> {
  return decodeBase64(textOf("impinge-recording"));
}

/** The module is compressed by gzip, which browsers unpack by themselves. */
export async function readModule(): Promise<Uint8Array<ArrayBuffer>> {
  const packed = decodeBase64(textOf("impinge-wasm"));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(unpacked).arrayBuffer());
}

/** The text of an element of the file. */
function textOf(id: string): string {
  const text = document.getElementById(id)?.textContent?.trim();
  if (!text) {
    throw new PageError(`The file has no element #${id} with a text in it.`);
  }
  return text;
}

/** Bytes of a text of base64; the browser refuses others. */
function decodeBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let index = 0; index < binary.length; index += 1) {
    bytes[index] = binary.charCodeAt(index);
  }
  return bytes;
}
