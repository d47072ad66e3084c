// The types of the engine's answers, which `PROTOCOL.md` of the crate specifies.

/** Three numbers; in 2D the third is 0. */
export type Vec3 = [number, number, number];
/** The components x, y, z, w of a unit quaternion. */
export type Quaternion = [number, number, number, number];

/** A card of the gallery. */
export interface SampleEntry {
  name: string;
  title: string;
  about: string;
  dimension: 2 | 3;
}

/**
 * The changes at a step. If there would be too many marks, the changes of several consecutive steps are added up at the
 * first of them.
 */
export interface Mark {
  step: number;
  started: number;
  stopped: number;
  proximities: number;
  added: number;
  removed: number;
  /** Changes of shapes, groups, query types, data, filters, skins and fixed flags, and requests to filter again. */
  changed: number;
  queries: number;
}

/** A control of a sample; `kind` selects its element. */
export type Control = { name: string; label: string } & (
  | { kind: "number"; value: number; min: number; max: number; step: number }
  | { kind: "choice"; value: string; choices: string[] }
  | { kind: "flag"; value: boolean }
  | { kind: "button" }
);

/** The description of a stage. */
export interface Info {
  kind: "recording" | "stream" | "sample";
  step: number;
  notes: string[];
  dimension: 2 | 3;
  scalar: string;
  title: string;
  about: string;
  written_by: string;
  /** The last step; null for samples, which have no end. */
  steps: number | null;
  /** Whether the record that ends a recording was read. */
  complete: boolean;
  /** The time between two steps, in seconds. */
  time_step: number;
  /** The least and the greatest corner of the box that the camera frames. */
  bounds: [Vec3, Vec3];
  /** The axis that points up on the screen. */
  up: Vec3;
  marks: Mark[];
  controls: Control[];
}

/** An event of the last update; `a` and `b` are the indices of objects. */
export type PairEvent =
  | { kind: "contact"; started: boolean; a: number; b: number }
  | { kind: "proximity"; a: number; b: number; before: string; after: string };

/** A number or a word that a sample shows. */
export interface Readout {
  label: string;
  value: string;
}

/** The state of a stage at a step. */
export interface Status {
  step: number;
  objects: number;
  pairs: number;
  contacts: number;
  /** The difference of a replay from its recording, in words; null if there is none. */
  diverged: string | null;
  /** All notes of a recording, if there are more than the page has; else empty. */
  notes: string[];
  /** The events of the step, up to a limit; `event_count` is the number of all of them. */
  events: PairEvent[];
  event_count: number;
  controls: Control[];
  readouts: Readout[];
}

/** The byte offset in the payload, and the number of elements. */
export type Section = [number, number];

/** A mesh in its own frame: the coordinates of its vertices, and the vertex indices of its triangles and edges. */
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

/**
 * The sections of a frame. Positions are relative to `origin`; colours are 32-bit words with red in the lowest byte.
 */
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
  /** Ids of meshes that are not used any more. */
  dropped: number[];
  lines: { count: number; ends: Section; color: Section; layer: Section };
  triangles: { count: number; corners: Section; color: Section; layer: Section };
  points: { count: number; at: Section; size: Section; color: Section; layer: Section };
  labels: Label[];
  layers: string[];
}

/** A frame with its payload, which lies in the engine's memory and is valid until the next call. */
export interface Frame extends FrameText {
  payload: Payload;
}

/** The bytes of an answer, read as arrays of numbers without a copy. */
export class Payload {
  constructor(
    private readonly buffer: ArrayBufferLike,
    private readonly start: number,
  ) {}

  /** Returns 32-bit floats. */
  floats([offset, count]: Section): Float32Array {
    return new Float32Array(this.buffer, this.start + offset, count);
  }

  /** Returns 32-bit unsigned integers. */
  words([offset, count]: Section): Uint32Array {
    return new Uint32Array(this.buffer, this.start + offset, count);
  }

  /** Returns the words as single bytes: colours as red, green, blue, alpha. */
  bytes([offset, count]: Section): Uint8Array {
    return new Uint8Array(this.buffer, this.start + offset, 4 * count);
  }
}

/** The groups of an object by their numbers. */
export type Groups = {
  membership: number[] | "all";
  whitelist: number[] | "all";
  blacklist: number[] | "all";
  self_collision: boolean;
};

/** The state of a pair of an object after the last update. `status` is present only for pairs with a proximity. */
export interface ObjectPair {
  object: number;
  kind: string;
  contacts?: number;
  depth?: number | null;
  touching?: boolean;
  status?: string;
}

/** The description of an object. Unbounded boxes are null. */
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

/**
 * A contact: the points on both objects, the unit normal from the first to the second, and the depth, which is positive
 * for an overlap.
 */
export interface ContactPoint {
  a: Vec3;
  b: Vec3;
  normal: Vec3;
  depth: number;
  features?: string;
}

/** One of the conditions for two objects to touch, and its result. */
export interface Test {
  name: string;
  passes: boolean;
  text: string;
}

/** The description of two objects. `points` is null if the objects touch or overlap. */
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

/** The object under the pointer. */
export interface PickAnswer {
  object: number | null;
  point: Vec3 | null;
  normal: Vec3 | null;
  time: number | null;
}

/** A hit of a ray; its time is the distance divided by the length of the direction. */
export interface RayHit {
  object: number;
  point: Vec3;
  normal: Vec3 | null;
  time: number;
  feature: string | null;
}

/** Objects in order of their distance from a point. */
export interface NearAnswer {
  nearest: { object: number; distance: number; point: Vec3 }[];
}
