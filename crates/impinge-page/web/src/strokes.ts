// Lines, points and triangles of a frame: one buffer of each, refilled for each frame.

import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  Group,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  MeshBasicMaterial,
  Points,
  ShaderMaterial,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { LINEAR } from "./color";
import type { Frame } from "./protocol";

/** These layers are drawn behind solids where they are behind them; the others lie on the surfaces of solids. */
const IN_DEPTH = new Set(["object", "tight box", "loosened box", "tree"]);

/** Line segments of one width, in pixels. */
export class Lines {
  readonly object: LineSegments2;
  private readonly geometry = new LineSegmentsGeometry();
  private readonly material: LineMaterial;
  /** Six numbers for each segment, relative to the origin. */
  private ends = new Float32Array(0);
  /** Three parts of linear light for each segment. */
  private colors = new Float32Array(0);
  /** Segments since `begin`. */
  private count = 0;

  constructor(width: number, depthTest: boolean) {
    this.material = new LineMaterial({ linewidth: width, vertexColors: true, depthTest, depthWrite: false });
    this.material.transparent = true;
    this.object = new LineSegments2(this.geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = depthTest ? 4 : 6;
    this.reserve(64);
  }

  /** Forgets the segments; the buffers stay. */
  begin(): void {
    this.count = 0;
  }

  /** Adds a segment: six numbers from `ends[at]`, and a colour's bytes from `bytes[color]`. */
  add(ends: ArrayLike<number>, at: number, bytes: ArrayLike<number>, color: number): void {
    if (6 * this.count === this.ends.length) this.reserve(2 * this.count);
    for (let index = 0; index < 6; index += 1) this.ends[6 * this.count + index] = ends[at + index] ?? 0;
    for (let index = 0; index < 3; index += 1) {
      this.colors[3 * this.count + index] = LINEAR[bytes[color + index] ?? 0] ?? 0;
    }
    this.count += 1;
  }

  /** Sends what was added to the graphics memory, and no more than that. */
  end(): void {
    this.object.visible = this.count > 0;
    this.geometry.instanceCount = this.count;
    for (const name of ["instanceStart", "instanceColorStart"]) {
      const { data } = this.geometry.getAttribute(name) as InterleavedBufferAttribute;
      data.clearUpdateRanges();
      data.addUpdateRange(0, this.count * data.stride);
      data.needsUpdate = true;
    }
  }

  /** Releases the graphics memory. */
  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }

  /** Makes room for so many segments. Both ends share a buffer, and so do both colours. */
  private reserve(capacity: number): void {
    const [ends, colors] = [new Float32Array(6 * capacity), new Float32Array(3 * capacity)];
    ends.set(this.ends);
    colors.set(this.colors);
    this.ends = ends;
    this.colors = colors;
    this.geometry.dispose();
    const segment = new InstancedInterleavedBuffer(ends, 6, 1).setUsage(DynamicDrawUsage);
    const color = new InstancedInterleavedBuffer(colors, 3, 1).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("instanceStart", new InterleavedBufferAttribute(segment, 3, 0));
    this.geometry.setAttribute("instanceEnd", new InterleavedBufferAttribute(segment, 3, 3));
    this.geometry.setAttribute("instanceColorStart", new InterleavedBufferAttribute(color, 3, 0));
    this.geometry.setAttribute("instanceColorEnd", new InterleavedBufferAttribute(color, 3, 0));
  }
}

/** Discs of a least and a greatest size on the screen, with a rim that sets them off from what is below. */
export class Dots {
  readonly object: Points<BufferGeometry, ShaderMaterial>;
  private readonly buffers = new Buffers({ position: 3, size: 1, color: 3 });

  constructor() {
    this.object = new Points(this.buffers.geometry, dotMaterial());
    this.object.frustumCulled = false;
    this.object.renderOrder = 7;
  }

  /** `pixels` of the screen for a length of 1, on a screen with so many pixels for one of CSS. */
  scale(pixels: number, density: number): void {
    const { uniforms } = this.object.material;
    uniforms.pixels!.value = pixels;
    uniforms.density!.value = density;
  }

  /** Copies the points of a frame. */
  update({ points, payload }: Frame): void {
    const [at, size] = [payload.floats(points.at), payload.floats(points.size)];
    const color = payload.bytes(points.color);
    this.buffers.reserve(points.count);
    this.buffers.array("position").set(at);
    this.buffers.array("size").set(size);
    writeColors(color, points.count, 3, this.buffers.array("color"));
    this.buffers.end(points.count);
    this.object.visible = points.count > 0;
  }

  dispose(): void {
    this.buffers.geometry.dispose();
    this.object.material.dispose();
  }
}

/** Faces without shading, such as the area of a manifold. */
export class Faces {
  readonly object: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly buffers = new Buffers({ position: 3, color: 4 });

  constructor() {
    const material = new MeshBasicMaterial({ vertexColors: true, transparent: true, side: DoubleSide });
    material.depthWrite = false;
    material.depthTest = false;
    this.object = new Mesh(this.buffers.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 5;
  }

  /** Copies the triangles of a frame; each has one colour, which its three corners repeat. */
  update({ triangles, payload }: Frame): void {
    const bytes = payload.bytes(triangles.color);
    this.buffers.reserve(3 * triangles.count);
    this.buffers.array("position").set(payload.floats(triangles.corners));
    const colors = this.buffers.array("color");
    for (let corner = 0; corner < 3 * triangles.count; corner += 1) {
      const from = 4 * Math.floor(corner / 3);
      for (let part = 0; part < 3; part += 1) colors[4 * corner + part] = LINEAR[bytes[from + part] ?? 0] ?? 0;
      colors[4 * corner + 3] = (bytes[from + 3] ?? 255) / 255;
    }
    this.buffers.end(3 * triangles.count);
    this.object.visible = triangles.count > 0;
  }

  dispose(): void {
    this.buffers.geometry.dispose();
    this.object.material.dispose();
  }
}

/** All of a frame that is not an object. */
export class Strokes {
  readonly group = new Group();
  // What lies in space, and what lies on surfaces, which would flicker if it were tested for depth.
  private readonly behind = new Lines(1.5, true);
  private readonly above = new Lines(2.25, false);
  private readonly dots = new Dots();
  private readonly faces = new Faces();

  constructor() {
    this.group.add(this.behind.object, this.above.object, this.dots.object, this.faces.object);
  }

  /** See `Dots.scale`. */
  scale(pixels: number, density: number): void {
    this.dots.scale(pixels, density);
  }

  /** Replaces all by what a frame has. */
  update(frame: Frame): void {
    const { lines, payload } = frame;
    const inDepth = frame.layers.map((name) => IN_DEPTH.has(name));
    const [ends, color, layer] = [payload.floats(lines.ends), payload.bytes(lines.color), payload.words(lines.layer)];
    this.behind.begin();
    this.above.begin();
    for (let index = 0; index < lines.count; index += 1) {
      const batch = inDepth[layer[index] ?? 0] ? this.behind : this.above;
      batch.add(ends, 6 * index, color, 4 * index);
    }
    this.behind.end();
    this.above.end();
    this.dots.update(frame);
    this.faces.update(frame);
  }

  dispose(): void {
    for (const part of [this.behind, this.above, this.dots, this.faces]) part.dispose();
  }
}

/** Attributes of a geometry that grow by doubling. */
class Buffers {
  readonly geometry = new BufferGeometry();
  /** In vertices. */
  private capacity = 0;

  /** `sizes` has the numbers for a vertex of each attribute. */
  constructor(private readonly sizes: Record<string, number>) {
    this.reserve(64);
  }

  /** Grows if it must; what was written is lost, since each frame writes all. */
  reserve(count: number): void {
    if (count <= this.capacity) return;
    this.capacity = Math.max(count, 2 * this.capacity);
    this.geometry.dispose();
    for (const [name, size] of Object.entries(this.sizes)) {
      const attribute = new BufferAttribute(new Float32Array(size * this.capacity), size);
      this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
  }

  /** The numbers of an attribute, to be written in place. */
  array(name: string): Float32Array {
    return this.geometry.getAttribute(name).array as Float32Array;
  }

  /** Draws so many vertices, and sends them. */
  end(count: number): void {
    this.geometry.setDrawRange(0, count);
    for (const [name, size] of Object.entries(this.sizes)) {
      const attribute = this.geometry.getAttribute(name) as BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, size * count);
      attribute.needsUpdate = true;
    }
  }
}

/** Bytes of red, green, blue and alpha as linear light; alpha is left out. */
function writeColors(bytes: Uint8Array, count: number, size: number, into: Float32Array): void {
  for (let index = 0; index < count; index += 1) {
    for (let part = 0; part < 3; part += 1) into[size * index + part] = LINEAR[bytes[4 * index + part] ?? 0] ?? 0;
  }
}

/** Points with a size in the world that stay legible: from 6 to 11 pixels wide. */
function dotMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: `
      attribute float size;
      attribute vec3 color;
      uniform float pixels;
      uniform float density;
      varying vec3 tint;
      void main() {
        tint = color;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_PointSize = clamp(size * pixels, 6.0, 11.0) * density;
      }`,
    fragmentShader: `
      varying vec3 tint;
      void main() {
        float reach = 2.0 * length(gl_PointCoord - 0.5);
        if (reach > 1.0) discard;
        gl_FragColor = vec4(reach > 0.72 ? mix(tint, vec3(1.0), 0.75) : tint, 1.0);
        #include <colorspace_fragment>
      }`,
    uniforms: { pixels: { value: 1 }, density: { value: 1 } },
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
}
