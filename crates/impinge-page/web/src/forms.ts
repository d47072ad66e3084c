// Meshes that differ by a scale along their axes share a form, so that boxes of ten thousand sizes are one draw.

import type { FrameMesh, Payload, Vec3 } from "./protocol";

/** Vertices within the cube from -1 to 1, and the triangles and edges between them. */
export interface Form {
  /** Counts up with the forms of a stage. */
  id: number;
  vertices: Float32Array;
  triangles: Uint32Array;
  lines: Uint32Array;
  /** Meshes that are this form with a scale. */
  meshes: number;
}

/** A mesh: a form, stretched along its axes. */
export interface ScaledForm {
  form: Form;
  scale: Vec3;
}

/** Meshes with more numbers than this have a form of their own: comparing them would cost more than it saves. */
const COMPARED = 3000;
/** Coordinates that differ by less than this part of the size are the same. */
const GRAIN = 1e-4;

export class Forms {
  private readonly meshes = new Map<number, ScaledForm & { key: string }>();
  private readonly forms = new Map<string, Form>();
  private next = 0;
  /** Meshes with ids below this number were received. */
  known = 0;

  /** The form of a mesh; undefined for one that was not received or was dropped. */
  get(mesh: number): ScaledForm | undefined {
    return this.meshes.get(mesh);
  }

  /** Copies a mesh out of the engine's memory. */
  receive(mesh: FrameMesh, payload: Payload): void {
    this.known = Math.max(this.known, mesh.id + 1);
    const vertices = payload.floats(mesh.vertices).slice();
    const [triangles, lines] = [payload.words(mesh.triangles), payload.words(mesh.lines)];
    const scale = normalize(vertices);
    const key = vertices.length > COMPARED ? `mesh ${mesh.id}` : keyOf(vertices, triangles, lines);
    const form = this.forms.get(key) ?? this.add(key, vertices, triangles.slice(), lines.slice());
    form.meshes += 1;
    this.meshes.set(mesh.id, { form, scale, key });
  }

  /** Forgets a mesh, and its form with the last one that has it. Returns the id of a form that is gone. */
  drop(mesh: number): number | null {
    const found = this.meshes.get(mesh);
    if (!found) return null;
    this.meshes.delete(mesh);
    found.form.meshes -= 1;
    if (found.form.meshes > 0) return null;
    this.forms.delete(found.key);
    return found.form.id;
  }

  private add(key: string, vertices: Float32Array, triangles: Uint32Array, lines: Uint32Array): Form {
    const form = { id: this.next, vertices, triangles, lines, meshes: 0 };
    this.next += 1;
    this.forms.set(key, form);
    return form;
  }
}

/** Divides by the largest coordinate along each axis, and returns these; 1 for an axis without any extent. */
function normalize(vertices: Float32Array): Vec3 {
  const scale: Vec3 = [0, 0, 0];
  vertices.forEach((part, index) => {
    const axis = index % 3;
    scale[axis] = Math.max(scale[axis] ?? 0, Math.abs(part));
  });
  for (const axis of [0, 1, 2]) scale[axis] ||= 1;
  vertices.forEach((part, index) => {
    vertices[index] = part / (scale[index % 3] ?? 1);
  });
  return scale;
}

/** Equal for equal forms; coordinates are rounded, since they were divided. */
function keyOf(vertices: Float32Array, triangles: Uint32Array, lines: Uint32Array): string {
  const places = Array.from(vertices, (part) => Math.round(part / GRAIN));
  return [places.join(), triangles.join(), lines.join()].join(";");
}
