// The objects of a frame as instances: one draw of faces and one of edges for each mesh and opacity.

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedMesh,
  LineSegments,
  type Material,
  MeshBasicMaterial,
  MeshLambertMaterial,
  ShaderMaterial,
} from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { LINEAR } from "./color";
import { type Poses, writePose } from "./pose";
import type { Frame } from "./protocol";

/** Faces that meet at less than this angle, in radians, are shaded as one surface. */
const CREASE = 0.6;
/** Batches that no frame used for so many frames are released. */
const PATIENCE = 240;
const OPAQUE = 255;
/** The key of a batch is the id of its mesh times this, and its alpha. */
const KEYS = 256;
/** More instances than this cast no shadows. */
const SHADOW_LIMIT = 3000;

/** A mesh, copied out of the engine's memory. Sizes are scales of instances: ten thousand boxes are one mesh. */
interface Mesh {
  vertices: Float32Array;
  triangles: Uint32Array;
  lines: Uint32Array;
}

/** Batches by mesh and opacity. */
export class Solids {
  /** All batches, for the scene. */
  readonly group = new Group();
  private readonly meshes = new Map<number, Mesh>();
  private readonly batches = new Map<number, Batch>();
  /** Frames so far: the clock of what is released. */
  private frames = 0;

  constructor(private readonly flat: boolean) {}

  /** Meshes with ids below this number were received. */
  known = 0;

  /** Replaces what is drawn by the instances of a frame; nothing is allocated while batches are large enough. */
  update(frame: Frame): void {
    this.frames += 1;
    this.receive(frame);
    for (const batch of this.batches.values()) batch.count = 0;
    this.scatter(frame);
    const shadows = !this.flat && frame.instances.count <= SHADOW_LIMIT;
    for (const [key, batch] of this.batches) {
      if (batch.count > 0) batch.used = this.frames;
      batch.show(shadows);
      if (this.frames - batch.used > PATIENCE) this.release(key, batch);
    }
  }

  /** Releases the graphics memory. */
  dispose(): void {
    for (const [key, batch] of this.batches) this.release(key, batch);
  }

  /** Copies new meshes out of the engine's memory, and forgets those that it dropped. */
  private receive({ meshes, dropped, payload }: Frame): void {
    for (const id of dropped) this.meshes.delete(id);
    for (const [key, batch] of this.batches) if (!this.meshes.has(meshOf(key))) this.release(key, batch);
    for (const { id, vertices, triangles, lines } of meshes) {
      this.known = Math.max(this.known, id + 1);
      const [indices, edges] = [payload.words(triangles).slice(), payload.words(lines).slice()];
      this.meshes.set(id, { vertices: payload.floats(vertices).slice(), triangles: indices, lines: edges });
    }
  }

  /** Writes each instance into its batch. */
  private scatter({ instances, payload }: Frame): void {
    const mesh = payload.words(instances.mesh);
    const color = payload.bytes(instances.color);
    const poses = { pose: payload.floats(instances.pose), scale: payload.floats(instances.scale) };
    let batch: Batch | undefined;
    let lastKey = -1;
    for (let index = 0; index < instances.count; index += 1) {
      const key = (mesh[index] ?? 0) * KEYS + (color[4 * index + 3] ?? OPAQUE);
      // Neighbours mostly share a batch: the map is searched when they do not.
      if (key !== lastKey) batch = this.batches.get(key) ?? this.begin(key);
      lastKey = key;
      batch?.add(poses, color, index);
    }
  }

  /** A batch for a key that has none; undefined for a mesh that was not received. */
  private begin(key: number): Batch | undefined {
    const mesh = this.meshes.get(meshOf(key));
    if (!mesh) return undefined;
    const batch = new Batch(mesh, key % KEYS, this.flat);
    this.batches.set(key, batch);
    this.group.add(batch.faces, batch.edges);
    return batch;
  }

  /** Frees a batch; its mesh stays, since it may come again. */
  private release(key: number, batch: Batch): void {
    this.group.remove(batch.faces, batch.edges);
    batch.dispose();
    this.batches.delete(key);
  }
}

/** The id of the mesh of a batch's key. */
function meshOf(key: number): number {
  return Math.floor(key / KEYS);
}

/** All instances of one mesh with one opacity. */
class Batch {
  faces: InstancedMesh;
  readonly edges: LineSegments<InstancedBufferGeometry, ShaderMaterial>;
  count = 0;
  /** The frame that used it last. */
  used = 0;
  /** Instances for which there is room. */
  private capacity = 0;
  /** Poses in columns. */
  private matrix = new InstancedBufferAttribute(new Float32Array(0), 16);
  /** Linear light. */
  private color = new InstancedBufferAttribute(new Float32Array(0), 3);

  constructor(data: Mesh, alpha: number, flat: boolean) {
    this.faces = new InstancedMesh(facesOf(data, flat), faceMaterial(alpha, flat), 0);
    this.faces.frustumCulled = false;
    this.faces.renderOrder = alpha < OPAQUE ? 2 : 0;
    this.edges = new LineSegments(edgesOf(data), edgeMaterial(alpha, data.triangles.length > 0 ? 0.3 : 1));
    this.edges.frustumCulled = false;
    this.edges.renderOrder = flat ? 3 : 1;
    this.grow(16);
  }

  /** Adds an instance of a frame; the caller has them in any order. */
  add(poses: Poses, color: Uint8Array, index: number): void {
    if (this.count === this.capacity) this.grow(2 * this.capacity);
    writePose(poses, index, this.matrix.array as Float32Array, 16 * this.count);
    const into = this.color.array;
    into[3 * this.count] = LINEAR[color[4 * index] ?? 0] ?? 0;
    into[3 * this.count + 1] = LINEAR[color[4 * index + 1] ?? 0] ?? 0;
    into[3 * this.count + 2] = LINEAR[color[4 * index + 2] ?? 0] ?? 0;
    this.count += 1;
  }

  /** Sends what was added to the graphics memory. */
  show(shadows: boolean): void {
    const visible = this.count > 0;
    this.faces.visible = visible;
    this.edges.visible = visible;
    if (!visible) return;
    this.faces.count = this.count;
    this.faces.castShadow = shadows && !(this.faces.material as Material).transparent;
    this.faces.receiveShadow = shadows;
    this.edges.geometry.instanceCount = this.count;
    send(this.matrix, this.count);
    send(this.color, this.count);
  }

  dispose(): void {
    this.faces.geometry.dispose();
    (this.faces.material as Material).dispose();
    this.faces.dispose();
    this.edges.geometry.dispose();
    this.edges.material.dispose();
  }

  /** Faces and edges read the same two buffers. */
  private grow(capacity: number): void {
    this.matrix = larger(this.matrix, capacity);
    this.color = larger(this.color, capacity);
    this.capacity = capacity;
    // The renderer frees the buffers of an instanced mesh when it is disposed of; the mesh itself stays in use.
    this.faces.dispose();
    this.faces.instanceMatrix = this.matrix;
    this.faces.instanceColor = this.color;
    this.edges.geometry.dispose();
    this.edges.geometry.setAttribute("instanceMatrix", this.matrix);
    this.edges.geometry.setAttribute("instanceTint", this.color);
  }
}

/** A copy with room for more instances. */
function larger(old: InstancedBufferAttribute, capacity: number): InstancedBufferAttribute {
  const array = new Float32Array(capacity * old.itemSize);
  array.set(old.array);
  return new InstancedBufferAttribute(array, old.itemSize).setUsage(DynamicDrawUsage);
}

/** Uploads the first instances only. */
function send(attribute: InstancedBufferAttribute, count: number): void {
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, count * attribute.itemSize);
  attribute.needsUpdate = true;
}

/** Triangles; in 3D with normals that are smooth but for creases. */
function facesOf(data: Mesh, flat: boolean): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(data.vertices, 3));
  geometry.setIndex(new BufferAttribute(data.triangles, 1));
  return flat ? geometry : toCreasedNormals(geometry, CREASE);
}

/** The edges that the engine chose, such as those between faces at an angle. */
function edgesOf(data: Mesh): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(data.vertices, 3));
  geometry.setIndex(new BufferAttribute(data.lines, 1));
  return geometry;
}

/** In 2D areas that are as good as opaque, in 3D shaded faces. */
function faceMaterial(alpha: number, flat: boolean): Material {
  const opacity = flat ? 0.92 * (alpha / OPAQUE) : alpha / OPAQUE;
  const options = { transparent: opacity < 1, opacity, depthWrite: !flat && opacity === 1, side: 2 as const };
  if (flat) return new MeshBasicMaterial({ ...options, depthTest: false });
  // Faces are pushed back a little, so that edges on them are seen.
  return new MeshLambertMaterial({
    ...options,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

/** Edges in a darker tone of the object's colour; where there are no faces, the colour itself. */
function edgeMaterial(alpha: number, tone: number): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: `
      attribute mat4 instanceMatrix;
      attribute vec3 instanceTint;
      varying vec3 tint;
      void main() {
        tint = instanceTint;
        gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      uniform float opacity;
      uniform float tone;
      varying vec3 tint;
      void main() {
        gl_FragColor = vec4(tint * tone, opacity);
        #include <colorspace_fragment>
      }`,
    uniforms: { opacity: { value: 0.35 + 0.4 * (alpha / OPAQUE) }, tone: { value: tone } },
    transparent: true,
    depthWrite: false,
  });
}
