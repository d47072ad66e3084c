// Reads a recording that is still being written.

import { PageError } from "./messages";

/**
 * Passes the bytes of a stream to `take` in order, and returns at its end. Throws a `PageError` if the request fails.
 */
export async function follow(address: string, take: (bytes: Uint8Array) => void): Promise<void> {
  const response = await fetch(address).catch(lost);
  if (!response.ok || !response.body) throw new PageError(refusal(response));
  const reader = response.body.getReader();
  for (;;) {
    const { done, value } = await reader.read().catch(lost);
    if (done) return;
    take(value);
  }
}

/** Returns a sentence about the reason why the server refuses the stream. */
function refusal({ status, statusText }: Response): string {
  if (status === 503) return "Too many pages follow this recording. Close one of them and load this page again.";
  return `The recording cannot be followed: its program answers ${status} ${statusText}.`;
}

function lost(): never {
  throw new PageError("The connection to the program of this recording is lost.");
}
