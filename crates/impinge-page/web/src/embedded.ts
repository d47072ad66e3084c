// The data embedded in the file: the scene to open, a recording, and the engine.

import { PageError } from "./messages";

export interface Scene {
  open: "recording" | "live" | "samples";
  title: string;
  /** The address of the bytes of a live recording. */
  log?: string;
}

/** Returns the scene that the page opens. */
export function readScene(): Scene {
  return JSON.parse(textOf("impinge-scene")) as Scene;
}

/** Returns the bytes of the embedded recording. The engine accepts packed and unpacked recordings. */
export function readRecording(): Uint8Array<ArrayBuffer> {
  return decodeBase64(textOf("impinge-recording"));
}

/** Returns the bytes of the module. In the file they are compressed by gzip; the browser decompresses them. */
export async function readModule(): Promise<Uint8Array<ArrayBuffer>> {
  const packed = decodeBase64(textOf("impinge-wasm"));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(unpacked).arrayBuffer());
}

/** Returns the text of an element of the file; an error if it is missing or empty. */
function textOf(id: string): string {
  const text = document.getElementById(id)?.textContent?.trim();
  if (!text) {
    throw new PageError(`The file has no element #${id} with a text in it.`);
  }
  return text;
}

/** Decodes base64. Throws an error of the browser if the text is not base64. */
function decodeBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let index = 0; index < binary.length; index += 1) {
    bytes[index] = binary.charCodeAt(index);
  }
  return bytes;
}
