// Error messages for people who read the page. The engine's own messages are for the developers who embed it.

import { EngineError } from "./engine";

/** An error whose message is written for people who read the page. */
export class PageError extends Error {}

/** The message for each code of an `EngineError`. */
const SENTENCES: Record<string, string> = {
  message: "This page has made a mistake and goes on without what was asked. Loading it again may help.",
  "unknown-sample": "There is no sample of this name.",
  "no-object": "This object is gone.",
  world: "The world does not take this position.",
  sample: "The sample does not take this.",
  "no-recording": "What this page carries is not a recording.",
  version: "The recording was written by another version of impinge, which this page cannot read.",
  damaged: "The recording is damaged and cannot be read.",
  foreign: "The recording is of a kind of world, shape or filter that this page does not have.",
  memory: "The browser has no memory left for this.",
};
const UNKNOWN = "Something went wrong in this page. Loading it again may help.";

/**
 * Returns the message for any thrown value. Values other than a `PageError` are also written to the browser's console.
 */
export function sentence(error: unknown): string {
  if (error instanceof PageError) return error.message;
  console.warn(error);
  return (error instanceof EngineError && SENTENCES[error.code]) || UNKNOWN;
}
