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

/** The exports of the module. Addresses and lengths are in bytes. */
export interface Exports {
  memory: { buffer: ArrayBufferLike };
  /** Returns the address of a buffer for a message; 0 if there is not enough memory. */
  reserve(bytes: number): number;
  call(bytes: number): number;
  answer_bytes(): number;
}

/** The kind and content of a stage. */
export type Source = { kind: "recording"; bytes: Uint8Array } | { kind: "stream" } | { kind: "sample"; name: string };

/**
 * An error of the engine, which rejected a message and changed nothing. The error message is for developers who embed the
 * engine; `messages.ts` has the messages for people who read the page.
 */
export class EngineError extends Error {
  constructor(
    text: string,
    /** A `code` of the protocol, or `memory` if there is no memory for the message. */
    readonly code: string,
  ) {
    super(text);
  }
}

/** Compiles a module. The module has no imports. */
export async function loadEngine(bytes: Uint8Array<ArrayBuffer>): Promise<Engine> {
  const { instance } = await WebAssembly.instantiate(bytes, {});
  return new Engine(instance.exports as unknown as Exports);
}

/** The empty payload. */
const NO_BYTES = new Uint8Array(0);

/**
 * The engine. Each method sends a message of the protocol, and throws an `EngineError` if the engine rejects it. Calls
 * are synchronous.
 */
export class Engine {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder();

  constructor(private readonly exports: Exports) {}

  /** Returns the samples in the order of the gallery. */
  samples(): SampleEntry[] {
    return this.ask<{ samples: SampleEntry[] }>({ do: "samples" }).samples;
  }

  /** Opens a stage in place of the current stage. */
  open(source: Source): Info {
    if (source.kind === "recording") {
      return this.ask({ do: "open", kind: source.kind }, source.bytes);
    }
    return this.ask({ do: "open", ...source });
  }

  /** Sends the next bytes of a stream, in pieces of any size. */
  push(bytes: Uint8Array): Info {
    return this.ask({ do: "push" }, bytes);
  }

  /** Goes to a step of a recording. */
  seek(step: number): Status {
    return this.ask({ do: "seek", step });
  }

  /** Advances by `steps` steps. A recording stops at its end. */
  advance(steps: number): Status {
    return this.ask({ do: "advance", steps });
  }

  /** Starts a sample again with the present values of its controls, or goes to the first update of a recording. */
  reset(): Status {
    return this.ask({ do: "reset" });
  }

  /** Sets a control of a sample. */
  control(name: string, value: number | string | boolean | null): Status {
    return this.ask({ do: "control", name, value });
  }

  /**
   * Returns the frame to draw, which is valid until the next call. `known` is the number of mesh ids that the page has
   * received: only meshes with larger or equal ids are sent.
   */
  frame(layers: string[], selected: number[], known: number): Frame {
    const { text, payload } = this.exchange({ do: "frame", layers, selected, known }, NO_BYTES);
    return Object.assign(text as unknown as FrameText, { payload });
  }

  /** Returns the description of an object. */
  object(object: number): ObjectAnswer {
    return this.ask({ do: "object", object });
  }

  /** Returns the description of a pair, with the reasons why the objects touch or do not. */
  pair(a: number, b: number): PairAnswer {
    return this.ask({ do: "pair", a, b });
  }

  /**
   * Returns the first object that a ray hits. In 2D, returns the object that contains the point `from`, or the nearest
   * object within the distance `reach`.
   */
  pick(from: Vec3, direction: Vec3, reach: number): PickAnswer {
    return this.ask({ do: "pick", from, direction, reach });
  }

  /** Returns all hits up to a time, in order of time; `longest` is null for an endless ray. */
  ray(from: Vec3, direction: Vec3, longest: number | null): RayHit[] {
    return this.ask<{ hits: RayHit[] }>({ do: "ray", from, direction, ...(longest === null ? {} : { longest }) }).hits;
  }

  /** Returns the objects nearest to a point. */
  nearest(point: Vec3, count: number): NearAnswer["nearest"] {
    return this.ask<NearAnswer>({ do: "nearest", point, count }).nearest;
  }

  /** Moves an object, and updates the world. */
  drag(object: number, translation: Vec3): Status {
    return this.ask({ do: "drag", object, translation });
  }

  /** Sends a message whose answer has no payload. */
  private ask<Answer>(message: object, payload: Uint8Array = NO_BYTES): Answer {
    return this.exchange(message, payload).text as Answer;
  }

  /** Writes a message into the module's memory and processes it. The payload of the answer stays in that memory. */
  private exchange(message: object, payload: Uint8Array): { text: unknown; payload: Payload } {
    const text = this.encoder.encode(JSON.stringify(message));
    const start = 4 + padded(text.length);
    const address = this.exports.reserve(start + payload.length);
    if (address === 0) throw new EngineError(`there is no memory for ${payload.length} bytes`, "memory");
    // `reserve` and `call` may move the memory, so views are created after each.
    const bytes = new Uint8Array(this.exports.memory.buffer, address, start + payload.length);
    new DataView(bytes.buffer, address).setUint32(0, text.length, true);
    bytes.fill(32, 4, start);
    bytes.set(text, 4);
    bytes.set(payload, start);
    return this.answer(this.exports.call(bytes.length));
  }

  /** Parses the text of the answer at an address; throws the error that it reports. */
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

/** Rounds a length up to a multiple of four: payloads begin at such offsets. */
function padded(length: number): number {
  return (length + 3) & ~3;
}
