// What is asked of the engine and what it answers. `PROTOCOL.md` of the crate is the contract.

/** Three numbers; in 2D the third is 0. */
export type Vec3 = [number, number, number];
/** x, y, z, w. */
export type Quaternion = [number, number, number, number];

/** A card of the gallery. */
export interface SampleEntry {
  name: string;
  title: string;
  about: string;
  dimension: 2 | 3;
}

/** What happened at a step, or in some steps from this one on where there would be too many marks. */
export interface Mark {
  step: number;
  started: number;
  stopped: number;
  proximities: number;
  added: number;
  removed: number;
  /** Objects with another shape, groups, query, data or filter. */
  changed: number;
  queries: number;
}

/** A control of a sample: its kind says how it is operated. */
export type Control = { name: string; label: string } & (
  | { kind: "number"; value: number; min: number; max: number; step: number }
  | { kind: "choice"; value: string; choices: string[] }
  | { kind: "flag"; value: boolean }
  | { kind: "button" }
);

/** What a stage is. */
export interface Info {
  kind: "recording" | "stream" | "sample";
  step: number;
  notes: string[];
  dimension: 2 | 3;
  scalar: string;
  title: string;
  about: string;
  written_by: string;
  /** The last step; samples run without end. */
  steps: number | null;
  /** The end of a recording came. */
  complete: boolean;
  /** Seconds from a step to the next. */
  time_step: number;
  /** The least and the greatest corner of what the camera frames. */
  bounds: [Vec3, Vec3];
  /** The axis that points up on the screen. */
  up: Vec3;
  marks: Mark[];
  controls: Control[];
}

/** An event of the last update; `a` and `b` are objects. */
export type PairEvent =
  | { kind: "contact"; started: boolean; a: number; b: number }
  | { kind: "proximity"; a: number; b: number; before: string; after: string };

/** A number or a word of a sample, ready to be shown. */
export interface Readout {
  label: string;
  value: string;
}

/** How a stage stands at a step. */
export interface Status {
  step: number;
  objects: number;
  pairs: number;
  contacts: number;
  /** In what a replay differs from its recording, in words. */
  diverged: string | null;
  /** The first events of the step; `event_count` in all. */
  events: PairEvent[];
  event_count: number;
  controls: Control[];
  readouts: Readout[];
}

/** Byte offset in the payload, and the number of elements. */
export type Section = [number, number];

/** A mesh in its own frame: numbers of its vertices, indices of triangles and of edges. */
export interface FrameMesh {
  id: number;
  vertices: Section;
  triangles: Section;
  lines: Section;
}

/** A text in the picture; the colour has red in its lowest byte. */
export interface Label {
  at: Vec3;
  text: string;
  color: number;
  layer: number;
}

/** The sections of a frame. Positions are relative to the origin; colours are words. */
export interface FrameText {
  origin: Vec3;
  meshes: FrameMesh[];
  instances: {
    count: number;
    mesh: Section;
    object: Section;
    color: Section;
    pose: Section;
    scale: Section;
    flags: Section;
  };
  /** Ids of meshes that will not be used again. */
  dropped: number[];
  lines: { count: number; ends: Section; color: Section; layer: Section };
  triangles: { count: number; corners: Section; color: Section; layer: Section };
  points: { count: number; at: Section; size: Section; color: Section; layer: Section };
  labels: Label[];
  layers: string[];
}

/** A frame with its payload, which is the engine's memory: it must be read before the next call. */
export interface Frame extends FrameText {
  payload: Payload;
}

/** Bytes of an answer, read as arrays of numbers without a copy. */
export class Payload {
  constructor(
    private readonly buffer: ArrayBufferLike,
    private readonly start: number,
  ) {}

  /** Numbers of 32 bits. */
  floats([offset, count]: Section): Float32Array {
    return new Float32Array(this.buffer, this.start + offset, count);
  }

  /** Whole numbers of 32 bits. */
  words([offset, count]: Section): Uint32Array {
    return new Uint32Array(this.buffer, this.start + offset, count);
  }

  /** Words as single bytes: colours as red, green, blue, alpha. */
  bytes([offset, count]: Section): Uint8Array {
    return new Uint8Array(this.buffer, this.start + offset, 4 * count);
  }
}

/** Groups by their numbers. */
export type Groups = {
  membership: number[] | "all";
  whitelist: number[] | "all";
  blacklist: number[] | "all";
  self_collision: boolean;
};

/** A pair of an object, as of the last update: of contacts or of proximity. */
export interface ObjectPair {
  object: number;
  kind: string;
  contacts?: number;
  depth?: number | null;
  touching?: boolean;
  status?: string;
}

/** All about an object. Boxes without an end are null. */
export interface ObjectAnswer {
  object: number;
  shape: { kind: string; text: string };
  label: string | null;
  translation: Vec3;
  rotation: Quaternion;
  groups: Groups;
  query: { kind: string; linear?: number; angular?: number; margin?: number };
  tight_box: [Vec3, Vec3] | null;
  loosened_box: [Vec3, Vec3] | null;
  pairs: ObjectPair[];
}

/** Points on both, the unit normal from the first to the second, and the depth, positive inside. */
export interface ContactPoint {
  a: Vec3;
  b: Vec3;
  normal: Vec3;
  depth: number;
  features?: string;
}

/** A reason for which two objects touch or do not. */
export interface Test {
  name: string;
  passes: boolean;
  text: string;
}

/** All about two objects. `points` are null where they overlap. */
export interface PairAnswer {
  a: number;
  b: number;
  distance: number | null;
  points: [Vec3, Vec3] | null;
  contact: ContactPoint | null;
  proximity: string | null;
  manifolds: { contacts: ContactPoint[] }[];
  why: { touch: boolean; text: string; tests: Test[] };
}

/** What is under the pointer. */
export interface PickAnswer {
  object: number | null;
  point: Vec3 | null;
  normal: Vec3 | null;
  time: number | null;
}

/** A hit; its time is in lengths of the direction. */
export interface RayHit {
  object: number;
  point: Vec3;
  normal: Vec3 | null;
  time: number;
  feature: string | null;
}

/** Objects in the order of their distance from a point. */
export interface NearAnswer {
  nearest: { object: number; distance: number; point: Vec3 }[];
}
