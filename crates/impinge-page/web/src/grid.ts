// The grid: a plane whose shader draws lines where a coordinate is a multiple of the cell.
//
// The lines are smooth, and about a pixel wide at any distance. They fade out where a cell is smaller than 20 pixels,
// and are invisible below about 3 pixels.

import { Color, DoubleSide, Mesh, PlaneGeometry, ShaderMaterial, Vector3 } from "three";
import { ORDER } from "./order";
import type { StageCamera } from "./camera";

/** The plane extends by this multiple of the world's radius in each direction. */
const EXTENT = 6;

/** The grid, below the world in 3D and behind it in 2D. */
export class Grid extends Mesh<PlaneGeometry, ShaderMaterial> {
  constructor() {
    const uniforms = { tint: { value: new Color() }, extent: { value: 1 } };
    const shaders = { vertexShader: VERTEX, fragmentShader: FRAGMENT };
    // The grid is offset towards the camera, so that it is visible on a floor at its height. Faces of solids are offset
    // in the opposite direction.
    const offset = { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 };
    const options = { transparent: true, depthWrite: false, side: DoubleSide };
    super(new PlaneGeometry(2, 2), new ShaderMaterial({ ...shaders, ...options, ...offset, uniforms }));
    this.renderOrder = ORDER.grid;
  }

  /** Sets the colour, any colour of CSS. */
  set tint(color: string) {
    this.material.uniforms.tint!.value.set(color);
  }

  /**
   * Places the grid for the bounds that the camera frames. The size of a cell is the largest power of ten that does not
   * exceed the radius of the bounding sphere. The lines are at multiples of the cell size in the frame of the stage.
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

// The function `lines` is 1 on a line and decreases to 0 at a distance of one pixel. Lines at tenths of a cell are
// fainter.
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
