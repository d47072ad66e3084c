// Lines, points and triangles of a frame, each in a buffer that is refilled for each frame.

import {
  type BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  Group,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  MeshBasicMaterial,
  Points,
  ShaderMaterial,
  Vector3,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { Buffers, grown, upload } from "./buffers";
import { LINEAR } from "./color";
import { ORDER } from "./order";
import type { Frame } from "./protocol";

/**
 * The layers whose lines are hidden by solids in front of them. The lines of the other layers lie mostly on the
 * surfaces of solids, where rounding would decide which is nearer, so they are drawn over all solids.
 */
const IN_DEPTH = new Set(["object", "tight box", "loosened box", "tree"]);

/**
 * The minimum diameter of a dot, in CSS pixels, and the number of dots above which it is halved, so that dots do not
 * cover the picture.
 */
const [MIN_DOT, CROWD] = [5, 1000];

/** Line segments of one width in CSS pixels. */
export class Lines {
  readonly object: LineSegments2;
  private readonly geometry = new LineSegmentsGeometry();
  private readonly material: LineMaterial;
  /** Six numbers per segment, in the stage's frame. */
  private ends = new Float32Array(0);
  /** Red, green and blue in linear light per segment. */
  private colors = new Float32Array(0);
  /** The number of segments since `begin`. */
  private count = 0;

  /** `order` is a value of `ORDER`. Only lines with the value `ORDER.lines` are tested for depth. */
  constructor(width: number, order: number) {
    const depthTest = order === ORDER.lines;
    this.material = new LineMaterial({ linewidth: width, vertexColors: true, depthTest, depthWrite: false });
    this.material.transparent = true;
    this.object = new LineSegments2(this.geometry, this.material);
    // With culling, the bounding sphere would have to be computed for each frame.
    this.object.frustumCulled = false;
    this.object.renderOrder = order;
  }

  /** Removes the segments, and reserves space for `most` segments. */
  begin(most: number): void {
    this.count = 0;
    const capacity = grown(this.ends.length / 6, Math.max(most, 1));
    if (6 * capacity > this.ends.length) this.reserve(capacity);
  }

  /**
   * Adds a segment: the six numbers that begin at `ends[at]`, and the sRGB bytes of a colour that begin at
   * `bytes[color]`.
   */
  add(ends: ArrayLike<number>, at: number, bytes: ArrayLike<number>, color: number): void {
    for (let index = 0; index < 6; index += 1) this.ends[6 * this.count + index] = ends[at + index] ?? 0;
    for (let index = 0; index < 3; index += 1) {
      this.colors[3 * this.count + index] = LINEAR[bytes[color + index] ?? 0] ?? 0;
    }
    this.count += 1;
  }

  /** Returns the ends of the segments. */
  points(): Generator<Vector3> {
    return pointsOf(this.ends, 2 * this.count);
  }

  /** Marks the added segments for upload and drawing. */
  end(): void {
    this.object.visible = this.count > 0;
    this.geometry.instanceCount = this.count;
    for (const name of ["instanceStart", "instanceColorStart"]) {
      const { data } = this.geometry.getAttribute(name) as InterleavedBufferAttribute;
      upload(data, this.count * data.stride);
    }
  }

  /** Releases the graphics memory. */
  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }

  /** Creates new buffers in the layout of LineSegmentsGeometry: both ends are in one buffer, and have one colour. */
  private reserve(capacity: number): void {
    this.ends = new Float32Array(6 * capacity);
    this.colors = new Float32Array(3 * capacity);
    this.geometry.dispose();
    const segment = new InstancedInterleavedBuffer(this.ends, 6, 1).setUsage(DynamicDrawUsage);
    const color = new InstancedInterleavedBuffer(this.colors, 3, 1).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("instanceStart", new InterleavedBufferAttribute(segment, 3, 0));
    this.geometry.setAttribute("instanceEnd", new InterleavedBufferAttribute(segment, 3, 3));
    this.geometry.setAttribute("instanceColorStart", new InterleavedBufferAttribute(color, 3, 0));
    this.geometry.setAttribute("instanceColorEnd", new InterleavedBufferAttribute(color, 3, 0));
  }
}

/** Discs with a minimum and a maximum size on the screen, and a light rim that separates them from solids. */
export class Dots {
  readonly object: Points<BufferGeometry, ShaderMaterial>;
  private readonly buffers = new Buffers({ position: 3, size: 1, color: 3 });

  constructor() {
    this.object = new Points(this.buffers.geometry, dotMaterial());
    this.object.frustumCulled = false;
    this.object.renderOrder = ORDER.dots;
  }

  /**
   * Sets the scale: the number of CSS pixels per unit of length, and the number of pixels of the screen per CSS pixel.
   */
  scale(pixels: number, density: number): void {
    const { uniforms } = this.object.material;
    uniforms.pixels!.value = pixels;
    uniforms.density!.value = density;
  }

  /** Copies the points of a frame. */
  update({ points, payload }: Frame): void {
    const bytes = payload.bytes(points.color);
    this.buffers.reserve(points.count);
    this.buffers.array("position").set(payload.floats(points.at));
    this.buffers.array("size").set(payload.floats(points.size));
    const colors = this.buffers.array("color");
    for (let point = 0; point < points.count; point += 1) {
      for (let part = 0; part < 3; part += 1) colors[3 * point + part] = LINEAR[bytes[4 * point + part] ?? 0] ?? 0;
    }
    this.buffers.end(points.count);
    this.object.material.uniforms.least!.value = points.count > CROWD ? MIN_DOT / 2 : MIN_DOT;
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
    this.object.renderOrder = ORDER.areas;
  }

  /**
   * Copies the triangles of a frame: nine numbers per triangle, and one colour, which is repeated for its three
   * corners.
   */
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

  /** Returns the corners of the triangles; `Buffers.end` has set their number as the draw range. */
  points(): Generator<Vector3> {
    return pointsOf(this.buffers.array("position"), this.buffers.geometry.drawRange.count);
  }

  dispose(): void {
    this.buffers.geometry.dispose();
    this.object.material.dispose();
  }
}

/** The lines, points and triangles of a frame. */
export class Strokes {
  readonly group = new Group();
  /** The lines of the layers `IN_DEPTH`. */
  private readonly behind = new Lines(1.5, ORDER.lines);
  /** The lines of all other layers. */
  private readonly above = new Lines(2.25, ORDER.linesAbove);
  private readonly dots = new Dots();
  private readonly faces = new Faces();

  constructor() {
    this.group.add(this.behind.object, this.above.object, this.dots.object, this.faces.object);
  }

  /** Sets the scale of the dots, see `Dots.scale`. */
  scale(pixels: number, density: number): void {
    this.dots.scale(pixels, density);
  }

  /** Returns the ends of all lines and the corners of all triangles, in the stage's frame. */
  *points(): Generator<Vector3> {
    for (const part of [this.behind, this.above, this.faces]) yield* part.points();
  }

  /** Replaces the lines, points and triangles by those of a frame. */
  update(frame: Frame): void {
    const { lines, payload } = frame;
    const inDepth = frame.layers.map((name) => IN_DEPTH.has(name));
    const [ends, color, layer] = [payload.floats(lines.ends), payload.bytes(lines.color), payload.words(lines.layer)];
    for (const batch of [this.behind, this.above]) batch.begin(lines.count);
    for (let index = 0; index < lines.count; index += 1) {
      const batch = inDepth[layer[index] ?? 0] ? this.behind : this.above;
      batch.add(ends, 6 * index, color, 4 * index);
    }
    for (const batch of [this.behind, this.above]) batch.end();
    this.dots.update(frame);
    this.faces.update(frame);
  }

  dispose(): void {
    for (const part of [this.behind, this.above, this.dots, this.faces]) part.dispose();
  }
}

function* pointsOf(numbers: Float32Array, count: number): Generator<Vector3> {
  for (let point = 0; point < count; point += 1) yield new Vector3().fromArray(numbers, 3 * point);
}

/**
 * Returns the material of dots. Their diameter is a length in the world, clamped to the range from `least` to 11 CSS
 * pixels on the screen.
 */
function dotMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: `
      attribute float size;
      attribute vec3 color;
      uniform float pixels;
      uniform float density;
      uniform float least;
      varying vec3 tint;
      void main() {
        tint = color;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_PointSize = clamp(size * pixels, least, 11.0) * density;
      }`,
    fragmentShader: `
      varying vec3 tint;
      void main() {
        float radius = 2.0 * length(gl_PointCoord - 0.5);
        if (radius > 1.0) discard;
        gl_FragColor = vec4(radius > 0.72 ? mix(tint, vec3(1.0), 0.75) : tint, 1.0);
        #include <colorspace_fragment>
      }`,
    uniforms: { pixels: { value: 1 }, density: { value: 1 }, least: { value: MIN_DOT } },
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
}
