// A recording that grows while it is watched.

/** Hands over the bytes of a stream in order, and returns when it ends; a failed request is an error with its reason. */
export async function follow(address: string, take: (bytes: Uint8Array) => void): Promise<void> {
  const response = await fetch(address);
  if (!response.ok || !response.body) throw new Error(`${address} answers ${response.status} ${response.statusText}`);
  const reader = response.body.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    take(value);
  }
}
