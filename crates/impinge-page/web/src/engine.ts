// The engine: impinge as a WebAssembly module, called with messages of JSON text and bytes.

import {
  type Frame,
  type FrameText,
  type Info,
  type NearAnswer,
  type ObjectAnswer,
  type PairAnswer,
  Payload,
  type PickAnswer,
  type RayHit,
  type SampleEntry,
  type Status,
  type Vec3,
} from "./protocol";

/** What the module exports. Addresses and lengths are in bytes. */
export interface Exports {
  memory: { buffer: ArrayBufferLike };
  /** 0 where there is no memory. */
  reserve(bytes: number): number;
  call(bytes: number): number;
  answer_bytes(): number;
}

/** What a stage is made of. */
export type Source = { kind: "recording"; bytes: Uint8Array } | { kind: "stream" } | { kind: "sample"; name: string };

/** The engine refused a message, and nothing has changed. The text is not for readers: `messages.ts` has theirs. */
export class EngineError extends Error {
  constructor(
    text: string,
    /** What went wrong, in a word of the protocol. */
    readonly code: string,
  ) {
    super(text);
  }
}

/** Compiles a module. It asks nothing of its surroundings, so that it has no imports. */
export async function loadEngine(bytes: Uint8Array<ArrayBuffer>): Promise<Engine> {
  const { instance } = await WebAssembly.instantiate(bytes, {});
  return new Engine(instance.exports as unknown as Exports);
}

/** Most messages have no payload. */
const NO_BYTES = new Uint8Array(0);

/** Each method is a message of the protocol; a refusal is an `EngineError`. Calls are synchronous. */
export class Engine {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder();

  constructor(private readonly exports: Exports) {}

  /** The gallery in its order. */
  samples(): SampleEntry[] {
    return this.ask<{ samples: SampleEntry[] }>({ do: "samples" }).samples;
  }

  /** Replaces the stage. */
  open(source: Source): Info {
    if (source.kind === "recording") {
      return this.ask({ do: "open", kind: source.kind }, source.bytes);
    }
    return this.ask({ do: "open", ...source });
  }

  /** Bytes that follow in a stream, in pieces of any size. */
  push(bytes: Uint8Array): Info {
    return this.ask({ do: "push" }, bytes);
  }

  /** Goes to a step of a recording. */
  seek(step: number): Status {
    return this.ask({ do: "seek", step });
  }

  /** Goes on; a recording stays at its end. */
  advance(steps: number): Status {
    return this.ask({ do: "advance", steps });
  }

  /** A sample begins again with its controls as they are. */
  reset(): Status {
    return this.ask({ do: "reset" });
  }

  /** Sets a control of a sample. */
  control(name: string, value: number | string | boolean | null): Status {
    return this.ask({ do: "control", name, value });
  }

  /** What is to be drawn. `known` is the number of meshes that the page has. The answer dies with the next call. */
  frame(layers: string[], selected: number[], known: number): Frame {
    const { text, payload } = this.exchange({ do: "frame", layers, selected, known }, NO_BYTES);
    return Object.assign(text as unknown as FrameText, { payload });
  }

  /** All about an object. */
  object(object: number): ObjectAnswer {
    return this.ask({ do: "object", object });
  }

  /** All about two objects, and why they touch or do not. */
  pair(a: number, b: number): PairAnswer {
    return this.ask({ do: "pair", a, b });
  }

  /** `reach` counts in 2D: how far an object may be that does not hold the point. */
  pick(from: Vec3, direction: Vec3, reach: number): PickAnswer {
    return this.ask({ do: "pick", from, direction, reach });
  }

  /** All hits up to a time, in their order; null for a ray without an end. */
  ray(from: Vec3, direction: Vec3, longest: number | null): RayHit[] {
    return this.ask<{ hits: RayHit[] }>({ do: "ray", from, direction, ...(longest === null ? {} : { longest }) }).hits;
  }

  /** The objects nearest to a point. */
  nearest(point: Vec3, count: number): NearAnswer["nearest"] {
    return this.ask<NearAnswer>({ do: "nearest", point, count }).nearest;
  }

  /** Moves an object, and updates the world. */
  drag(object: number, translation: Vec3): Status {
    return this.ask({ do: "drag", object, translation });
  }

  /** For messages whose answer has no payload. */
  private ask<Answer>(message: object, payload: Uint8Array = NO_BYTES): Answer {
    return this.exchange(message, payload).text as Answer;
  }

  /** Writes a message into the module's memory, and reads the answer in place. */
  private exchange(message: object, payload: Uint8Array): { text: unknown; payload: Payload } {
    const text = this.encoder.encode(JSON.stringify(message));
    const start = 4 + padded(text.length);
    const address = this.exports.reserve(start + payload.length);
    if (address === 0) throw new EngineError(`there is no memory for ${payload.length} bytes`, "memory");
    // `reserve` and `call` may move the memory: views are made after each.
    const bytes = new Uint8Array(this.exports.memory.buffer, address, start + payload.length);
    new DataView(bytes.buffer, address).setUint32(0, text.length, true);
    bytes.fill(32, 4, start);
    bytes.set(text, 4);
    bytes.set(payload, start);
    return this.answer(this.exports.call(bytes.length));
  }

  /** Reads an answer; its payload stays in the module's memory. */
  private answer(address: number): { text: unknown; payload: Payload } {
    const { buffer } = this.exports.memory;
    const length = new DataView(buffer, address).getUint32(0, true);
    const text: unknown = JSON.parse(this.decoder.decode(new Uint8Array(buffer, address + 4, length)));
    if (text !== null && typeof text === "object" && "error" in text) {
      throw new EngineError(String(text.error), "code" in text ? String(text.code) : "");
    }
    return { text, payload: new Payload(buffer, address + 4 + padded(length)) };
  }
}

/** The next multiple of four: payloads begin at one. */
function padded(length: number): number {
  return (length + 3) & ~3;
}
