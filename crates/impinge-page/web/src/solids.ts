// The objects of a frame as instances: one draw call for faces and one for edges per mesh and opacity.

import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedMesh,
  LineSegments,
  type Material,
  Matrix4,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  ShaderMaterial,
  Vector3,
} from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { grown, upload } from "./buffers";
import { LINEAR } from "./color";
import { ORDER } from "./order";
import type { Frame } from "./protocol";

/** The maximum angle in radians between faces that are shaded as one smooth surface. */
const CREASE = 0.6;
/**
 * The number of frames without instances after which a batch is released. A batch whose instances come and go every few
 * frames is kept.
 */
const MAX_IDLE_FRAMES = 240;
/** The alpha of opaque objects, and the number of possible values of alpha. */
const [OPAQUE, ALPHAS] = [255, 256];
/** The object index of an instance that is not an object. */
const NO_OBJECT = 0xffffffff;
/** The maximum number of instances with which shadows are drawn. */
const MAX_SHADOWS = 3000;

// Scratch values for one instance, so that nothing is allocated per instance.
const translation = new Vector3();
const rotation = new Quaternion();
const scale = new Vector3();
const pose = new Matrix4();

/** A mesh, copied out of the engine's memory. Instances of different sizes share a mesh: their scales differ. */
interface Mesh {
  vertices: Float32Array;
  triangles: Uint32Array;
  lines: Uint32Array;
}

/**
 * The poses and scales of a frame's instances. A pose has seven numbers: a translation and a unit quaternion x, y, z,
 * w. A scale has three numbers: the factors along the axes of the mesh.
 */
interface Poses {
  pose: Float32Array;
  scale: Float32Array;
}

/** The batches of a stage. A batch is all instances of one mesh with one alpha; its key is `mesh * ALPHAS + alpha`. */
export class Solids {
  /** All batches, for the scene. */
  readonly group = new Group();
  private readonly meshes = new Map<number, Mesh>();
  private readonly batches = new Map<number, Batch>();
  /** The number of frames so far, to find idle batches. */
  private frames = 0;
  /** Opposite corners of the boxes around instances that are not objects, such as the shape at the end of a cast. */
  private readonly corners: Vector3[] = [];

  /** The number of mesh ids that were received: meshes with smaller ids are known. */
  known = 0;

  constructor(private readonly flat: boolean) {}

  /**
   * Replaces the drawn objects by the instances of a frame. Nothing is allocated while the batches are large enough.
   */
  update(frame: Frame): void {
    this.frames += 1;
    this.receive(frame);
    for (const batch of this.batches.values()) batch.count = 0;
    this.corners.length = 0;
    this.scatter(frame);
    const shadows = !this.flat && frame.instances.count <= MAX_SHADOWS;
    for (const [key, batch] of this.batches) {
      if (batch.count > 0) batch.used = this.frames;
      batch.show(shadows);
      if (this.frames - batch.used > MAX_IDLE_FRAMES) this.release(key, batch);
    }
  }

  /** Returns points that the camera frames in addition to the objects. */
  points(): Vector3[] {
    return this.corners;
  }

  /** Releases the graphics memory. */
  dispose(): void {
    for (const [key, batch] of this.batches) this.release(key, batch);
  }

  /** Copies new meshes out of the engine's memory. Deletes the meshes that the engine dropped, with their batches. */
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
    const object = payload.words(instances.object);
    const color = payload.bytes(instances.color);
    const poses = { pose: payload.floats(instances.pose), scale: payload.floats(instances.scale) };
    let batch: Batch | undefined;
    let lastKey = -1;
    for (let index = 0; index < instances.count; index += 1) {
      const key = (mesh[index] ?? 0) * ALPHAS + (color[4 * index + 3] ?? OPAQUE);
      // Consecutive instances mostly share a batch, which saves the search in the map.
      if (key !== lastKey) batch = this.batches.get(key) ?? this.begin(key);
      lastKey = key;
      batch?.add(poses, color, index);
      if (batch && object[index] === NO_OBJECT) this.corners.push(...batch.lastBox());
    }
  }

  /** Creates the batch with a key; undefined if its mesh was not received. */
  private begin(key: number): Batch | undefined {
    const mesh = this.meshes.get(meshOf(key));
    if (!mesh) return undefined;
    const batch = new Batch(mesh, key % ALPHAS, this.flat);
    this.batches.set(key, batch);
    this.group.add(batch.faces, batch.edges);
    return batch;
  }

  /** Releases a batch. Its mesh stays, since instances of the mesh may appear again. */
  private release(key: number, batch: Batch): void {
    this.group.remove(batch.faces, batch.edges);
    batch.dispose();
    this.batches.delete(key);
  }
}

/** Returns the id of the mesh in the key of a batch. */
function meshOf(key: number): number {
  return Math.floor(key / ALPHAS);
}

/** All instances of one mesh with one alpha. */
class Batch {
  faces: InstancedMesh;
  readonly edges: LineSegments<InstancedBufferGeometry, ShaderMaterial>;
  count = 0;
  /** The last frame in which the batch had instances. */
  used = 0;
  /** The number of instances for which the buffers have space. */
  private capacity = 0;
  /**
   * The 4 × 4 matrices of the instances, column by column. They apply the scale, then the rotation, then the
   * translation.
   */
  private matrix = new InstancedBufferAttribute(new Float32Array(0), 16);
  /** Red, green and blue of the instances in linear light. */
  private color = new InstancedBufferAttribute(new Float32Array(0), 3);

  constructor(data: Mesh, alpha: number, flat: boolean) {
    this.faces = new InstancedMesh(facesOf(data, flat), faceMaterial(alpha, flat), 0);
    this.faces.frustumCulled = false;
    this.faces.renderOrder = alpha < OPAQUE ? ORDER.transparentSolids : ORDER.solids;
    this.edges = new LineSegments(edgesOf(data), edgeMaterial(alpha, data.triangles.length > 0));
    this.edges.frustumCulled = false;
    this.edges.renderOrder = flat ? ORDER.edgesOfAreas : ORDER.edges;
    this.grow();
  }

  /** Adds an instance of a frame. */
  add(poses: Poses, color: Uint8Array, index: number): void {
    if (this.count === this.capacity) this.grow();
    translation.fromArray(poses.pose, 7 * index);
    rotation.fromArray(poses.pose, 7 * index + 3);
    scale.fromArray(poses.scale, 3 * index);
    pose.compose(translation, rotation, scale).toArray(this.matrix.array, 16 * this.count);
    const into = this.color.array;
    for (let part = 0; part < 3; part += 1) into[3 * this.count + part] = LINEAR[color[4 * index + part] ?? 0] ?? 0;
    this.count += 1;
  }

  /** Returns opposite corners of the box around the instance that was added last. */
  lastBox(): [Vector3, Vector3] {
    const { geometry } = this.edges;
    if (!geometry.boundingBox) geometry.computeBoundingBox();
    const { min, max } = new Box3().copy(geometry.boundingBox ?? new Box3()).applyMatrix4(pose);
    return [min, max];
  }

  /** Marks the added instances for upload and drawing. A batch without instances is hidden. */
  show(shadows: boolean): void {
    const visible = this.count > 0;
    this.faces.visible = visible;
    this.edges.visible = visible;
    if (!visible) return;
    this.faces.count = this.count;
    this.faces.castShadow = shadows && !(this.faces.material as Material).transparent;
    this.faces.receiveShadow = shadows;
    this.edges.geometry.instanceCount = this.count;
    for (const attribute of [this.matrix, this.color]) upload(attribute, this.count * attribute.itemSize);
  }

  dispose(): void {
    this.faces.geometry.dispose();
    (this.faces.material as Material).dispose();
    this.faces.dispose();
    this.edges.geometry.dispose();
    this.edges.material.dispose();
  }

  /** Makes space for at least one more instance and keeps the content. Faces and edges share the two buffers. */
  private grow(): void {
    const capacity = grown(this.capacity, this.capacity + 1);
    this.matrix = larger(this.matrix, capacity);
    this.color = larger(this.color, capacity);
    this.capacity = capacity;
    // Disposing of an instanced mesh frees its buffers; the object itself can be used again.
    this.faces.dispose();
    this.faces.instanceMatrix = this.matrix;
    this.faces.instanceColor = this.color;
    this.edges.geometry.dispose();
    this.edges.geometry.setAttribute("instanceMatrix", this.matrix);
    this.edges.geometry.setAttribute("instanceTint", this.color);
  }
}

/** Returns a copy of an attribute with a larger capacity. */
function larger(old: InstancedBufferAttribute, capacity: number): InstancedBufferAttribute {
  const array = new Float32Array(capacity * old.itemSize);
  array.set(old.array);
  return new InstancedBufferAttribute(array, old.itemSize).setUsage(DynamicDrawUsage);
}

/** Returns the triangles of a mesh; in 3D with normals that are smooth except at creases. */
function facesOf(data: Mesh, flat: boolean): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(data.vertices, 3));
  geometry.setIndex(new BufferAttribute(data.triangles, 1));
  return flat ? geometry : toCreasedNormals(geometry, CREASE);
}

/** Returns the lines of a mesh, which the engine has selected, for example the edges between faces at an angle. */
function edgesOf(data: Mesh): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(data.vertices, 3));
  geometry.setIndex(new BufferAttribute(data.lines, 1));
  return geometry;
}

/** Returns the material of faces: in 2D unshaded areas, always slightly transparent; in 3D shaded faces. */
function faceMaterial(alpha: number, flat: boolean): Material {
  const opacity = flat ? 0.92 * (alpha / OPAQUE) : alpha / OPAQUE;
  const options = { transparent: opacity < 1, opacity, depthWrite: !flat && opacity === 1, side: 2 as const };
  if (flat) return new MeshBasicMaterial({ ...options, depthTest: false });
  // Faces are offset away from the camera, so that edges on them are visible.
  return new MeshLambertMaterial({
    ...options,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

/** Returns the material of edges: a darker tone of the object's colour, or the colour itself if there are no faces. */
function edgeMaterial(alpha: number, hasFaces: boolean): ShaderMaterial {
  const opacity = hasFaces ? 0.35 + 0.4 * (alpha / OPAQUE) : alpha / OPAQUE;
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
    uniforms: { opacity: { value: opacity }, tone: { value: hasFaces ? 0.3 : 1 } },
    transparent: true,
    depthWrite: false,
  });
}
