// The grid: a plane whose shader draws lines where a coordinate is a multiple of the cell.
//
// Lines of a shader stay thin and smooth at any distance, and fade where they would be nearer to each other than pixels.

import { Color, DoubleSide, Mesh, PlaneGeometry, ShaderMaterial, Vector3 } from "three";
import { ORDER } from "./order";
import type { StageCamera } from "./camera";

/** The plane goes so many times the radius of the world in each direction. */
const EXTENT = 6;

/** Below the world in 3D, behind it in 2D. */
export class Grid extends Mesh<PlaneGeometry, ShaderMaterial> {
  constructor() {
    const uniforms = { tint: { value: new Color() }, extent: { value: 1 } };
    const shaders = { vertexShader: VERTEX, fragmentShader: FRAGMENT };
    // Pulled forward, as faces of solids are pushed back: on a floor at its height the grid is above it, everywhere.
    const offset = { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 };
    const options = { transparent: true, depthWrite: false, side: DoubleSide };
    super(new PlaneGeometry(2, 2), new ShaderMaterial({ ...shaders, ...options, ...offset, uniforms }));
    this.renderOrder = ORDER.grid;
  }

  /** Any colour of CSS. */
  set tint(color: string) {
    this.material.uniforms.tint!.value.set(color);
  }

  /**
   * Lays the grid out for the bounds that the camera frames. A cell is the power of ten below their radius, and lines
   * are where coordinates are multiples of it, as long as the origin of the stage is.
   */
  fit({ box, sphere, flat }: StageCamera, up: Vector3): void {
    const cell = 10 ** Math.floor(Math.log10(sphere.radius));
    const normal = flat ? new Vector3(0, 0, 1) : up;
    this.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal);
    this.scale.setScalar(cell);
    this.material.uniforms.extent!.value = (EXTENT * sphere.radius) / cell;
    this.position.copy(sphere.center).divideScalar(cell).round().multiplyScalar(cell);
    const height = flat ? -1 : Math.min(box.min.dot(normal), box.max.dot(normal));
    this.position.addScaledVector(normal, height - this.position.dot(normal));
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }
}

const VERTEX = `
  uniform float extent;
  varying vec2 cells;
  void main() {
    cells = position.xy * extent;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(cells, 0.0, 1.0);
  }`;

// `lines` is 1 on a line and 0 half a pixel beside it; lines of a tenth of a cell are fainter.
const FRAGMENT = `
  uniform vec3 tint;
  uniform float extent;
  varying vec2 cells;
  float lines(vec2 at) {
    vec2 pixel = fwidth(at);
    vec2 near = 1.0 - min(abs(fract(at - 0.5) - 0.5) / pixel, 1.0);
    vec2 apart = 1.0 - smoothstep(0.05, 0.3, pixel);
    return max(near.x * apart.x, near.y * apart.y);
  }
  void main() {
    float faded = 1.0 - smoothstep(0.2, 1.0, length(cells) / extent);
    gl_FragColor = vec4(tint, faded * max(lines(cells), 0.3 * lines(10.0 * cells)));
    #include <colorspace_fragment>
  }`;
