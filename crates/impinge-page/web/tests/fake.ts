// A small engine of boxes without rotation, with the exports of the real engine. With it the page's drawing can be
// tested and measured without the cost of collision detection. Rays and searches of nearest objects find nothing. The
// stage `texts2:60` is `boxes2:60` with a text at each box. A stream has ten more steps after each piece of bytes. A
// recording gets a note at step 10, a stream with its second piece.

import type { Exports } from "../src/engine";
import type { Control, FrameText, Label, Section, Vec3 } from "../src/protocol";

interface Box {
  at: Vec3;
  half: Vec3;
}

/** A world as a function of the step. */
interface Stage {
  /** Whether each box has a text. */
  isNamed: boolean;
  dimension: 2 | 3;
  steps: number | null;
  boxes: (step: number) => Box[];
}

/**
 * Returns a stage with boxes in a square or a cube. Its name, such as `boxes2:400` or `boxes3:10000`, has the dimension
 * and the number of boxes.
 */
function makeStage(name: string, steps: number | null): Stage {
  const isNamed = name.startsWith("texts");
  const dimension = name.includes("2:") ? 2 : 3;
  const count = Number(name.split(":")[1] ?? 60);
  const side = Math.ceil(count ** (1 / dimension));
  const center = (index: number, step: number): Vec3 => {
    const row = Math.floor(index / side) % side;
    const fall = Math.max(0, 1 - step / 120);
    return [(index % side) * 1.5, row * (1 + fall) + 0.5, dimension === 2 ? 0 : Math.floor(index / side / side) * 1.5];
  };
  const half: Vec3 = dimension === 2 ? [0.5, 0.5, 0] : [0.5, 0.5, 0.5];
  const boxes = (step: number): Box[] =>
    Array.from({ length: count }, (_, index) => ({ at: center(index, step), half }));
  return { isNamed, dimension, steps, boxes };
}

/** Returns the gap between two boxes along each axis; negative if they overlap. */
function gaps(a: Box, b: Box): Vec3 {
  return a.at.map((part, axis) => Math.abs(part - b.at[axis]!) - a.half[axis]! - b.half[axis]!) as Vec3;
}

/** The note of recordings and streams. */
const NOTE = "The pair filter teams lets all pairs through.";

class FakeEngine {
  private kind = "recording";
  private stage = makeStage("boxes3:60", 240);
  private step = 0;
  private moved = new Map<number, Vec3>();

  answer(message: Record<string, unknown>): { text: object; payload?: ArrayBuffer } {
    switch (message.do) {
      case "samples":
        return { text: { samples: [2, 3].map((dimension) => entry(dimension)) } };
      case "open":
        return { text: this.open(message) };
      case "push":
        this.stage.steps! += 10;
        return { text: this.info() };
      case "seek":
      case "advance":
        return { text: this.go(message) };
      case "reset":
        return { text: this.go({ do: "seek", step: 0 }) };
      case "drag":
        this.moved.set(message.object as number, message.translation as Vec3);
        return { text: this.status() };
      case "frame":
        return this.frame(message.known as number);
      case "pick":
        return { text: this.pick(message.from as Vec3, message.direction as Vec3) };
      case "object":
        return { text: this.object(message.object as number) };
      case "pair":
        return { text: this.pair(message.a as number, message.b as number) };
      case "nearest":
        return { text: { nearest: [] } };
      case "ray":
        return { text: { hits: [] } };
      default:
        return { text: this.status() };
    }
  }

  private get boxes(): Box[] {
    const boxes = this.stage.boxes(this.step);
    for (const [index, at] of this.moved) boxes[index]!.at = at;
    return boxes;
  }

  private open(message: Record<string, unknown>): object {
    this.kind = String(message.kind);
    const stages: Record<string, Stage> = {
      recording: makeStage("boxes3:60", 240),
      stream: makeStage("boxes2:60", 0),
      sample: makeStage(String(message.name), null),
    };
    this.stage = stages[this.kind]!;
    this.step = 0;
    this.moved.clear();
    return this.info();
  }

  private info(): object {
    const marks = Array.from({ length: 40 }, (_, index) => ({
      step: index * 6,
      started: index % 4,
      stopped: index % 3,
      proximities: 0,
      added: index % 13 === 0 ? 1 : 0,
      removed: index % 17 === 5 ? 1 : 0,
      changed: 0,
      queries: index % 7 === 0 ? 1 : 0,
    }));
    const { dimension, steps } = this.stage;
    const ats = this.stage.boxes(0).map(({ at }) => at);
    const bound = (most: (...parts: number[]) => number, by: number): number[] =>
      [0, 1, 2].map((axis) => most(...ats.map((at) => at[axis]!)) + (dimension === 2 && axis === 2 ? 0 : by));
    return {
      kind: this.kind,
      step: this.step,
      notes: this.kind === "stream" && steps! > 10 ? [NOTE] : [],
      dimension,
      scalar: "f32",
      title: "",
      about: "",
      written_by: "fake",
      steps,
      complete: true,
      time_step: 1 / 60,
      bounds: [bound(Math.min, -0.5), bound(Math.max, 0.5)],
      up: [0, 1, 0],
      marks: steps === null ? [] : marks,
      controls: this.kind === "sample" ? controls() : [],
    };
  }

  private go(message: Record<string, unknown>): object {
    const steps = ((message.do === "seek" ? message.step : message.steps) as number) ?? 1;
    // The real engine rejects such numbers too.
    if (!(Number.isInteger(steps) && steps >= 0)) return { error: `invalid value: ${steps}`, code: "message" };
    this.step = message.do === "seek" ? steps : this.step + steps;
    this.step = Math.min(this.step, this.stage.steps ?? Infinity);
    this.moved.clear();
    return this.status();
  }

  private status(): object {
    const events = [{ kind: "contact", started: true, a: 0, b: 1 }];
    const readouts = this.stage.steps === null ? [{ label: "Distance", value: "0.125" }] : [];
    return {
      step: this.step,
      objects: this.boxes.length,
      pairs: 1,
      contacts: 2,
      diverged: null,
      notes: this.kind === "recording" && this.step === 10 ? [NOTE] : [],
      events,
      event_count: 1,
      controls: [],
      readouts,
    };
  }

  private frame(known: number): { text: FrameText; payload: ArrayBuffer } {
    const { boxes } = this;
    const writer = new Writer();
    const cube = cubeMesh(this.stage.dimension);
    const meshes =
      known > 0
        ? []
        : [
            {
              id: 0,
              vertices: writer.floats(cube.vertices),
              triangles: writer.words(cube.triangles),
              lines: writer.words(cube.lines),
            },
          ];
    const colors = [0xffb89262, 0xff929e5e, 0xffa89280, 0x58c87896].map((color) => color >>> 0);
    const instances = {
      count: boxes.length,
      mesh: writer.words(boxes.map(() => 0)),
      object: writer.words(boxes.map((_, index) => index)),
      color: writer.words(boxes.map((_, index) => colors[index % 4]!)),
      pose: writer.floats(boxes.flatMap(({ at }) => [...at, 0, 0, 0, 1])),
      scale: writer.floats(boxes.flatMap(() => [1, 1, 1])),
      flags: writer.words(boxes.map(() => 0)),
    };
    const at = boxes[0]!.at;
    const top: Vec3 = [at[0], at[1] + 1, at[2]];
    const text: FrameText = {
      origin: [0, 0, 0],
      meshes,
      instances,
      dropped: [],
      lines: {
        count: 1,
        ends: writer.floats([...at, ...top]),
        color: writer.words([0xff3cc8ff]),
        layer: writer.words([1]),
      },
      triangles: { count: 0, corners: [0, 0], color: [0, 0], layer: [0, 0] },
      points: {
        count: 1,
        at: writer.floats(at),
        size: writer.floats([0.1]),
        color: writer.words([0xff3c50ff]),
        layer: writer.words([0]),
      },
      labels: [{ at: top, text: "normal", color: 0xff3c50ff, layer: 1 }, ...this.names(boxes)],
      layers: ["contact", "normal"],
    };
    return { text, payload: writer.bytes() };
  }

  private names(boxes: Box[]): Label[] {
    if (!this.stage.isNamed) return [];
    return boxes.map(({ at }, index) => ({ at, text: `number ${index}`, color: 0xff3cc8ff, layer: 0 }));
  }

  /** Returns the first box that a ray hits, by the slab method; in 2D the first box that contains the point `from`. */
  private pick(from: Vec3, direction: Vec3): object {
    let best = { object: null as number | null, time: Infinity };
    this.boxes.forEach(({ at, half }, object) => {
      let [enter, leave] = [-Infinity, Infinity];
      for (let axis = 0; axis < this.stage.dimension; axis += 1) {
        const speed = this.stage.dimension === 2 ? 1e-30 : direction[axis]!;
        const times = [-1, 1].map((side) => (at[axis]! + side * half[axis]! - from[axis]!) / speed);
        enter = Math.max(enter, Math.min(...times));
        leave = Math.min(leave, Math.max(...times));
      }
      const inside = this.stage.dimension === 3 || (enter <= 0 && leave >= 0);
      if (inside && enter <= leave && enter < best.time) best = { object, time: enter };
    });
    const point =
      best.object === null ? null : from.map((part, axis) => part + direction[axis]! * Math.max(best.time, 0));
    return { ...best, point, normal: null };
  }

  private object(object: number): object {
    const box = this.boxes[object];
    if (!box) return { error: `no object has the number ${object}`, code: "no-object" };
    return {
      object,
      shape: { kind: "cuboid", text: "cuboid, half extents 0.5 × 0.5 × 0.5" },
      label: `box ${object}`,
      translation: box.at,
      rotation: [0, 0, 0, 1],
      groups: { membership: "all", whitelist: "all", blacklist: [], self_collision: false },
      query: { kind: "contacts", linear: 0.01, angular: 0 },
      tight_box: null,
      loosened_box: null,
      pairs: [{ object: object + 1, kind: "contacts", contacts: 4, depth: 0.01, touching: true }],
    };
  }

  private pair(a: number, b: number): object {
    const [one, two] = [this.boxes[a]!, this.boxes[b]!];
    const gap = gaps(one, two);
    const apart = Math.hypot(...gap.map((part) => Math.max(part, 0)));
    const nearest = (from: Box, to: Box): Vec3 =>
      from.at.map((part, axis) =>
        Math.max(part - from.half[axis]!, Math.min(to.at[axis]!, part + from.half[axis]!)),
      ) as Vec3;
    const tests = ["groups", "filter", "boxes", "distance"].map((name) => ({
      name,
      passes: name !== "distance",
      text: `${apart} apart`,
    }));
    return {
      a,
      b,
      distance: apart,
      points: apart > 0 ? [nearest(one, two), nearest(two, one)] : null,
      contact: null,
      proximity: "disjoint",
      manifolds: [],
      why: { touch: apart === 0, text: `They are ${apart} apart.`, tests },
    };
  }
}

function entry(dimension: number): object {
  return {
    name: `boxes${dimension}:60`,
    title: `Boxes in ${dimension}D`,
    about: "Sixty boxes come together. Drag one away.",
    dimension,
  };
}

function controls(): Control[] {
  return [
    { name: "speed", label: "Speed", kind: "number", value: 1, min: 0, max: 5, step: 0.1 },
    { name: "first", label: "First shape", kind: "choice", value: "ball", choices: ["ball", "box"] },
    { name: "solid", label: "Solid", kind: "flag", value: true },
    { name: "drop", label: "Drop one", kind: "button" },
  ];
}

function cubeMesh(dimension: 2 | 3): { vertices: number[]; triangles: number[]; lines: number[] } {
  if (dimension === 2) {
    return {
      vertices: [-0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5, 0],
      triangles: [0, 1, 2, 0, 2, 3],
      lines: [0, 1, 1, 2, 2, 3, 3, 0],
    };
  }
  const vertices = Array.from({ length: 24 }, (_, index) => ((Math.floor(index / 3) >> index % 3) & 1) - 0.5);
  const triangles = [
    0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5,
  ];
  return { vertices, triangles, lines: [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7] };
}

/** Collects the sections of a payload. */
class Writer {
  private readonly parts: (Float32Array | Uint32Array)[] = [];
  private length = 0;

  floats(numbers: number[]): Section {
    return this.push(Float32Array.from(numbers));
  }

  words(numbers: number[]): Section {
    return this.push(Uint32Array.from(numbers));
  }

  bytes(): ArrayBuffer {
    const all = new Uint8Array(this.length);
    let at = 0;
    for (const part of this.parts) {
      all.set(new Uint8Array(part.buffer), at);
      at += part.byteLength;
    }
    return all.buffer;
  }

  private push(part: Float32Array | Uint32Array): Section {
    const section: Section = [this.length, part.length];
    this.parts.push(part);
    this.length += part.byteLength;
    return section;
  }
}

/** The address of messages. It is not 0, which would mean that there is no memory. */
const ADDRESS = 8;

/** Returns the exports of a module whose memory is replaced by each call. */
function fakeExports(): Exports {
  const engine = new FakeEngine();
  const memory = { buffer: new ArrayBuffer(0) };
  let length = 0;
  const call = (bytes: number): number => {
    const size = new DataView(memory.buffer).getUint32(ADDRESS, true);
    const text = new TextDecoder().decode(new Uint8Array(memory.buffer, ADDRESS + 4, Math.min(size, bytes - 4)));
    const answer = engine.answer(JSON.parse(text) as Record<string, unknown>);
    const json = new TextEncoder().encode(JSON.stringify(answer.text));
    const start = 4 + ((json.length + 3) & ~3);
    const all = new Uint8Array(start + (answer.payload?.byteLength ?? 0));
    new DataView(all.buffer).setUint32(0, json.length, true);
    all.set(json, 4);
    if (answer.payload) all.set(new Uint8Array(answer.payload), start);
    memory.buffer = all.buffer;
    length = all.length;
    return 0;
  };
  const reserve = (bytes: number): number => {
    memory.buffer = new ArrayBuffer(ADDRESS + ((bytes + 3) & ~3));
    return ADDRESS;
  };
  return { memory, reserve, call, answer_bytes: () => length };
}

// In the page these exports replace those of the module.
WebAssembly.instantiate = (async () => ({
  instance: { exports: fakeExports() },
})) as unknown as typeof WebAssembly.instantiate;
