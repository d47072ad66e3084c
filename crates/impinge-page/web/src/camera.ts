// The camera of a stage: a perspective camera that orbits in 3D, or an orthographic camera that pans in 2D.
//
// There are two frames of coordinates. The world's frame is in f64. The stage's frame, in which three.js draws, is the
// world's frame minus the origin of the stage, so that f32 keeps its precision in scenes far from 0. `Vec3` is a point
// of the world, `Vector3` a point of the stage.

import {
  Box3,
  MathUtils,
  MOUSE,
  OrthographicCamera,
  PerspectiveCamera,
  Plane,
  Raycaster,
  Sphere,
  TOUCH,
  Vector2,
  Vector3,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Info, Vec3 } from "./protocol";

/** A half-line in the world. In 2D only its origin is used. */
export interface WorldRay {
  from: Vec3;
  direction: Vec3;
}

/** A point of the canvas in CSS pixels from its upper left corner. */
export interface CanvasPoint {
  x: number;
  y: number;
  /** From -1 at the near plane to 1 at the far plane; smaller is nearer. */
  depth: number;
}

/** Vertical field of view of the perspective camera, in degrees. */
const FIELD = 38;
/** The tangent of half of `FIELD`: half the height of the visible area at a distance of 1. */
const HALF_HEIGHT = Math.tan(MathUtils.degToRad(FIELD / 2));
/** The maximum fraction of the canvas that a fitted box covers, in height and in width. */
const FILL = 0.9;
/** `fit` ignores points farther from the centre of the bounding sphere than this many radii. */
const FAR = 2.5;

/** The camera of a stage. The unit of length is that of the world. */
export class StageCamera {
  readonly camera: PerspectiveCamera | OrthographicCamera;
  readonly controls: OrbitControls;
  /** Whether the world is 2D. */
  readonly flat: boolean;
  /** The bounds of the world. */
  readonly box = new Box3();
  /** The bounding sphere of the box. Sizes of lights and grids are proportional to its radius. */
  readonly sphere = new Sphere();
  /** The box that the camera frames: the bounds, extended by the drawn points near them. */
  private readonly framed = new Box3();
  /** Whether the camera frames `framed`: true after `aim`, until the reader moves the camera. */
  private isFitted = false;
  private readonly caster = new Raycaster();
  /** The width of the canvas divided by its height. */
  private aspect = 1;
  /** Half the height of the area that the orthographic camera shows at zoom 1. */
  private halfHeight = 1;

  constructor(
    info: Info,
    private origin: Vec3,
    private readonly canvas: HTMLCanvasElement,
  ) {
    this.flat = info.dimension === 2;
    this.camera = this.flat ? new OrthographicCamera() : new PerspectiveCamera(FIELD);
    this.camera.up.set(...info.up).normalize();
    this.controls = new OrbitControls(this.camera, canvas);
    this.configure();
    this.frame(info.bounds, origin);
    this.framed.copy(this.box);
  }

  /**
   * Sets the bounds of the world and the origin of the stage. Empty and non-finite bounds become a cube of half extent
   * 1.
   */
  frame([mins, maxs]: [Vec3, Vec3], origin: Vec3): void {
    this.origin = origin;
    this.box.set(this.relative(mins), this.relative(maxs));
    if (!(this.box.getSize(new Vector3()).length() < Infinity) || this.box.isEmpty()) {
      this.box.setFromCenterAndSize(new Vector3(), new Vector3(2, 2, this.flat ? 0 : 2));
    }
    this.box.getBoundingSphere(this.sphere);
    // A world of one point has the radius 0, by which other code would divide.
    this.sphere.radius = Math.max(this.sphere.radius, 1e-12);
  }

  /**
   * Frames the bounds and the `points` near them. Far points, such as the end of an unbounded ray, are ignored. In 3D
   * the camera looks from the front, the right and above.
   */
  fit(points: Iterable<Vector3>): void {
    const { center, radius } = this.sphere;
    this.framed.copy(this.box);
    for (const point of points) if (point.distanceTo(center) < FAR * radius) this.framed.expandByPoint(point);
    this.aim();
  }

  /**
   * Sets the size of the canvas in CSS pixels, for example when a phone is turned. The view is fitted again unless the
   * reader has moved the camera.
   */
  resize(width: number, height: number): void {
    this.aspect = width / Math.max(height, 1);
    if (this.camera instanceof PerspectiveCamera) this.camera.aspect = this.aspect;
    if (this.isFitted) this.aim();
    else if (this.camera instanceof OrthographicCamera) this.spread(this.camera);
    this.camera.updateProjectionMatrix();
  }

  /** Updates the matrices before each picture. In 3D, also moves the near and the far plane around the scene. */
  place(): void {
    if (this.camera instanceof PerspectiveCamera) {
      const { center, radius } = this.sphere;
      const distance = this.camera.position.distanceTo(center);
      // Terrain and half-spaces extend beyond the bounds. The ratio of far to near stays small enough for 24
      // bits of depth.
      const extent = radius * 12;
      this.camera.near = Math.max(distance - extent, Math.max(distance, radius) * 2e-3);
      this.camera.far = distance + extent * 4;
    }
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /** Returns the ray of the world that a point of the window shows; `x` and `y` are in CSS pixels. */
  rayAt(x: number, y: number): WorldRay {
    this.caster.setFromCamera(this.toDevice(x, y), this.camera);
    const { origin, direction } = this.caster.ray;
    if (this.flat) {
      const [px, py] = this.absolute(origin);
      return { from: [px, py, 0], direction: [0, 0, -1] };
    }
    return { from: this.absolute(origin), direction: direction.toArray() };
  }

  /** Returns the point that a point of the window shows in the plane through `anchor` parallel to the screen. */
  pointAt(x: number, y: number, anchor: Vec3): Vec3 {
    this.caster.setFromCamera(this.toDevice(x, y), this.camera);
    const normal = this.camera.getWorldDirection(new Vector3());
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, this.relative(anchor));
    const hit = this.caster.ray.intersectPlane(plane, new Vector3());
    if (!hit) return anchor;
    const [px, py, pz] = this.absolute(hit);
    return [px, py, this.flat ? 0 : pz];
  }

  /** Returns the position of a point of the stage on the canvas; null behind the camera and beyond the far plane. */
  project(at: Vector3): CanvasPoint | null {
    const device = at.clone().project(this.camera);
    if (!(device.z <= 1)) return null;
    const { clientWidth, clientHeight } = this.canvas;
    return { x: ((device.x + 1) / 2) * clientWidth, y: ((1 - device.y) / 2) * clientHeight, depth: device.z };
  }

  /** Returns the number of CSS pixels that a length of 1 covers at the target of the camera. */
  pixelsPerUnit(): number {
    const height = this.canvas.clientHeight;
    if (this.camera instanceof PerspectiveCamera) {
      return height / (2 * HALF_HEIGHT * this.camera.position.distanceTo(this.controls.target));
    }
    return (height / (2 * this.halfHeight)) * this.camera.zoom;
  }

  /** Rotates (3D) or shifts (2D) the view by keys. A step of 1 is an eighth of a right angle, or of half the height. */
  nudge(right: number, up: number): void {
    const { position, up: above } = this.camera;
    const offset = position.clone().sub(this.controls.target);
    const side = new Vector3().crossVectors(above, offset).normalize();
    if (this.flat) {
      const length = this.halfHeight / this.camera.zoom / 8;
      const shift = side.multiplyScalar(right * length).addScaledVector(above, up * length);
      position.add(shift);
      this.controls.target.add(shift);
    } else {
      offset.applyAxisAngle(above, (right * Math.PI) / 16);
      offset.applyAxisAngle(side, (-up * Math.PI) / 16);
      position.addVectors(this.controls.target, offset);
    }
    this.controls.update();
  }

  /** Zooms by a factor; a factor above 1 enlarges the picture. */
  zoom(factor: number): void {
    if (this.camera instanceof OrthographicCamera) this.camera.zoom *= factor;
    else {
      const offset = this.camera.position.sub(this.controls.target).divideScalar(factor);
      this.camera.position.copy(offset.add(this.controls.target));
    }
    this.controls.update();
  }

  /** Removes the listeners of the canvas. */
  dispose(): void {
    this.controls.dispose();
  }

  /** Converts a point of the world to the stage's frame. */
  relative(at: Vec3): Vector3 {
    return new Vector3(at[0] - this.origin[0], at[1] - this.origin[1], at[2] - this.origin[2]);
  }

  /** Converts a point of the stage to the world's frame. */
  private absolute(at: Vector3): Vec3 {
    return [at.x + this.origin[0], at.y + this.origin[1], at.z + this.origin[2]];
  }

  /** Moves the camera so that the framed box is visible. */
  private aim(): void {
    if (this.camera instanceof PerspectiveCamera) this.fitPerspective(this.camera);
    else this.fitOrthographic(this.camera);
    this.controls.update();
    // The listener of the controls, which `update` calls, resets the flag.
    this.isFitted = true;
    this.place();
  }

  /** Configures the controls. In 2D a drag shifts the view, and nothing rotates it. */
  private configure(): void {
    this.controls.addEventListener("change", () => (this.isFitted = false));
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = true;
    if (!this.flat) return;
    this.controls.enableRotate = false;
    this.controls.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.controls.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
  }

  /**
   * Moves the camera to the nearest position from which the framed box is inside the view and in its middle.
   *
   * Let p be a corner relative to the centre, b the unit vector back to the camera, a an axis of the screen, t the
   * tangent of half the field along a. From a distance d, shifted by s along a, the corner is visible where |p·a - s|
   * <= t (d - p·b). With plus = max(p·a + t p·b) and minus = max(-p·a + t p·b) over the corners, the least d is (plus +
   * minus) / 2t, where s = (plus - minus) / 2 puts a corner at either edge of the view.
   */
  private fitPerspective(camera: PerspectiveCamera): void {
    const back = viewDirection(camera.up);
    const right = new Vector3().crossVectors(camera.up, back).normalize();
    const axes = [
      { axis: right, tangent: FILL * HALF_HEIGHT * this.aspect },
      { axis: new Vector3().crossVectors(back, right), tangent: FILL * HALF_HEIGHT },
    ];
    const corners = cornersOf(this.framed).map((corner) => corner.sub(this.sphere.center));
    const ends = (axis: Vector3, tangent: number): { plus: number; minus: number } => {
      const end = (sign: number): number =>
        Math.max(...corners.map((corner) => sign * corner.dot(axis) + tangent * corner.dot(back)));
      return { plus: end(1), minus: end(-1) };
    };
    const distances = axes.map(({ axis, tangent }) => {
      const { plus, minus } = ends(axis, tangent);
      return (plus + minus) / (2 * tangent);
    });
    // The camera stays outside of the bounds, even if the framed box is a line towards the camera.
    const distance = Math.max(1.2 * this.sphere.radius, ...distances);
    const { target } = this.controls;
    target.copy(this.sphere.center);
    for (const { axis, tangent } of axes) {
      // Along the axis that the box does not fill, the box fits into a narrower view. Its tangent is the fixed point of
      // this iteration.
      let { plus, minus } = ends(axis, tangent);
      for (let round = 0; round < 8; round += 1) ({ plus, minus } = ends(axis, (plus + minus) / (2 * distance)));
      target.addScaledVector(axis, (plus - minus) / 2);
    }
    camera.position.copy(target).addScaledVector(back, distance);
  }

  /** Looks down the z axis at the plane z = 0. */
  private fitOrthographic(camera: OrthographicCamera): void {
    this.framed.getCenter(this.controls.target);
    camera.zoom = 1;
    camera.position.copy(this.controls.target).setZ(10);
    camera.near = 0;
    camera.far = 20;
    this.spread(camera);
  }

  /** Sets the extent of the view so that it contains the framed box. A box without a size is enlarged. */
  private spread(camera: OrthographicCamera): void {
    const { x, y } = this.framed.getSize(new Vector3());
    this.halfHeight = Math.max(y, x / this.aspect, this.sphere.radius * 1e-3) / 2 / FILL;
    camera.top = this.halfHeight;
    camera.bottom = -this.halfHeight;
    camera.left = -this.halfHeight * this.aspect;
    camera.right = this.halfHeight * this.aspect;
  }

  /** Converts pixels of the window to normalized device coordinates: -1 to 1, y up. */
  private toDevice(x: number, y: number): Vector2 {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return new Vector2(((x - left) / width) * 2 - 1, 1 - ((y - top) / height) * 2);
  }
}

/** Returns the unit vector from the target to the camera: 29 degrees to the right of the front, 23 degrees above it. */
function viewDirection(up: Vector3): Vector3 {
  // The front is -y if z points up, as in robotics, and otherwise +z, as in graphics.
  const front = Math.abs(up.z) > 0.5 ? new Vector3(0.55, -1, 0) : new Vector3(0.55, 0, 1);
  return front.normalize().addScaledVector(up, 0.42).normalize();
}

/** Returns the corners of a box. The bits of a corner's index choose between the least and the greatest coordinates. */
function cornersOf({ min, max }: Box3): Vector3[] {
  return Array.from(
    { length: 8 },
    (_, bits) => new Vector3(bits & 1 ? max.x : min.x, bits & 2 ? max.y : min.y, bits & 4 ? max.z : min.z),
  );
}
