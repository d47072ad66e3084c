// The camera of a stage: perspective that orbits in 3D, orthographic that pans in 2D.

import { MOUSE, OrthographicCamera, PerspectiveCamera, Plane, Raycaster, TOUCH, Vector2, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Info, Vec3 } from "./protocol";

/** A half-line in the world; in 2D only its origin counts. */
export interface WorldRay {
  from: Vec3;
  direction: Vec3;
}

/** Vertical field of view of the perspective camera, in degrees. */
const FIELD = 38;
/** The part of the view that the bounds may cover in 2D when they are fitted. */
const FILL = 0.86;

/** Lengths are those of the world. Positions inside are relative to the origin of the stage, in which three.js draws. */
export class StageCamera {
  readonly camera: PerspectiveCamera | OrthographicCamera;
  readonly controls: OrbitControls;
  /** The world is 2D. */
  readonly flat: boolean;
  /** The centre and the half diagonal of what is framed, relative to the origin. */
  private readonly center = new Vector3();
  /** Half the diagonal of the bounds. */
  private radius = 1;
  private readonly caster = new Raycaster();
  /** Width over height of the canvas. */
  private aspect = 1;
  /** Half the height of what the orthographic camera sees at zoom 1. */
  private halfHeight = 1;

  constructor(
    info: Info,
    private readonly origin: Vec3,
    private readonly canvas: HTMLCanvasElement,
  ) {
    this.flat = info.dimension === 2;
    this.camera = this.flat ? new OrthographicCamera() : new PerspectiveCamera(FIELD);
    this.camera.up.set(...info.up);
    this.frame(info.bounds);
    this.controls = new OrbitControls(this.camera, canvas);
    this.configure();
    this.fit();
  }

  /** What `fit` frames; NaN and empty bounds count as a unit box. */
  frame([least, greatest]: [Vec3, Vec3]): void {
    const low = new Vector3(...this.relative(least));
    const high = new Vector3(...this.relative(greatest));
    this.center.addVectors(low, high).multiplyScalar(0.5);
    this.radius = low.distanceTo(high) / 2;
    if (!Number.isFinite(this.radius) || !Number.isFinite(this.center.lengthSq())) {
      this.center.set(0, 0, 0);
      this.radius = 1;
    }
    this.radius = Math.max(this.radius, 1e-12);
    this.extent.subVectors(high, low);
  }

  /** The size of the bounds along each axis. */
  private readonly extent = new Vector3();

  /** The point that is looked at, relative to the origin. */
  get target(): Vector3 {
    return this.controls.target;
  }

  /** A length of the scene, to which sizes of lights and grids are proportional. */
  get sceneRadius(): number {
    return this.radius;
  }

  /** Frames the bounds from a direction between the front, the side and above. */
  fit(): void {
    this.controls.target.copy(this.center);
    if (this.camera instanceof PerspectiveCamera) this.fitPerspective(this.camera);
    else this.fitOrthographic(this.camera);
    this.controls.update();
    this.place();
  }

  /** In CSS pixels. */
  resize(width: number, height: number): void {
    this.aspect = width / Math.max(height, 1);
    if (this.camera instanceof PerspectiveCamera) this.camera.aspect = this.aspect;
    else this.spread(this.camera);
    this.camera.updateProjectionMatrix();
  }

  /** Keeps the near and the far plane around the scene; called before each picture. */
  place(): void {
    if (this.camera instanceof PerspectiveCamera) {
      const distance = this.camera.position.distanceTo(this.center);
      const reach = this.radius * 12;
      this.camera.near = Math.max(distance - reach, Math.max(distance, this.radius) * 2e-3);
      this.camera.far = distance + reach * 4;
    }
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /** The world's ray under a point of the canvas, which is given in CSS pixels of the window. */
  rayAt(x: number, y: number): WorldRay {
    this.caster.setFromCamera(this.toDevice(x, y), this.camera);
    const { origin, direction } = this.caster.ray;
    if (this.flat) {
      const [px, py] = this.absolute(origin);
      return { from: [px, py, 0], direction: [0, 0, -1] };
    }
    return { from: this.absolute(origin), direction: direction.toArray() };
  }

  /** The point under a point of the canvas, in the plane through `anchor` that is parallel to the screen. */
  pointAt(x: number, y: number, anchor: Vec3): Vec3 {
    this.caster.setFromCamera(this.toDevice(x, y), this.camera);
    const normal = this.camera.getWorldDirection(new Vector3());
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, new Vector3(...this.relative(anchor)));
    const hit = this.caster.ray.intersectPlane(plane, new Vector3());
    if (!hit) return anchor;
    const [px, py, pz] = this.absolute(hit);
    return [px, py, this.flat ? 0 : pz];
  }

  /** Where a point of the world is on the canvas, in CSS pixels; null behind the camera. */
  project(at: Vec3): { x: number; y: number } | null {
    const device = new Vector3(...this.relative(at)).project(this.camera);
    if (device.z > 1) return null;
    const { clientWidth, clientHeight } = this.canvas;
    return { x: ((device.x + 1) / 2) * clientWidth, y: ((1 - device.y) / 2) * clientHeight };
  }

  /** CSS pixels for a length of 1 at the target: what a world's size is on the screen. */
  pixelsPerUnit(): number {
    const height = this.canvas.clientHeight;
    if (this.camera instanceof PerspectiveCamera) {
      const distance = this.camera.position.distanceTo(this.controls.target);
      return height / (2 * distance * Math.tan((FIELD * Math.PI) / 360));
    }
    return (height / (2 * this.halfHeight)) * this.camera.zoom;
  }

  /** Turns (3D) or shifts (2D) by keys: a step of 1 is an eighth of a right angle or of the view. */
  nudge(right: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const side = new Vector3().crossVectors(this.camera.up, offset).normalize();
    if (this.flat) {
      const length = this.halfHeight / this.camera.zoom / 8;
      const shift = side.multiplyScalar(right * length).addScaledVector(this.camera.up, up * length);
      this.camera.position.add(shift);
      this.controls.target.add(shift);
    } else {
      offset.applyAxisAngle(this.camera.up, (right * Math.PI) / 16);
      offset.applyAxisAngle(side, (-up * Math.PI) / 16);
      this.camera.position.addVectors(this.controls.target, offset);
    }
    this.controls.update();
  }

  /** A factor above 1 comes nearer. */
  zoom(factor: number): void {
    if (this.camera instanceof OrthographicCamera) this.camera.zoom *= factor;
    else {
      const offset = this.camera.position.sub(this.controls.target).divideScalar(factor);
      this.camera.position.copy(offset.add(this.controls.target));
    }
    this.controls.update();
  }

  /** Stops listening to the canvas. */
  dispose(): void {
    this.controls.dispose();
  }

  /** A point of the world as three.js has it. */
  relative(at: Vec3): Vec3 {
    return [at[0] - this.origin[0], at[1] - this.origin[1], at[2] - this.origin[2]];
  }

  /** A point of three.js as the world has it. */
  private absolute(at: Vector3): Vec3 {
    return [at.x + this.origin[0], at.y + this.origin[1], at.z + this.origin[2]];
  }

  /** In 2D a drag shifts the view; nothing turns it. */
  private configure(): void {
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = true;
    if (!this.flat) return;
    this.controls.enableRotate = false;
    this.controls.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.controls.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
  }

  /** The ball around the bounds touches the nearer two edges of the view. */
  private fitPerspective(camera: PerspectiveCamera): void {
    const narrow = Math.min(1, this.aspect);
    const half = Math.atan(Math.tan((FIELD * Math.PI) / 360) * narrow);
    const up = camera.up.clone().normalize();
    // A horizontal direction that does not depend on which axis points up.
    const front = Math.abs(up.z) > 0.5 ? new Vector3(0.55, -1, 0) : new Vector3(0.55, 0, 1);
    const direction = front.normalize().addScaledVector(up, 0.42).normalize();
    const distance = this.radius / Math.sin(half);
    camera.position.copy(this.center).addScaledVector(direction, distance);
  }

  /** Looks down the z axis at the plane z = 0. */
  private fitOrthographic(camera: OrthographicCamera): void {
    camera.zoom = 1;
    camera.position.copy(this.center).setZ(10);
    camera.near = 0;
    camera.far = 20;
    this.spread(camera);
  }

  /** The bounds fit into the view whatever its shape is; bounds without a size are as if they had one. */
  private spread(camera: OrthographicCamera): void {
    const height = Math.max(this.extent.y, this.extent.x / this.aspect, this.radius * 1e-3);
    this.halfHeight = Number.isFinite(height) ? height / 2 / FILL : 1;
    camera.top = this.halfHeight;
    camera.bottom = -this.halfHeight;
    camera.left = -this.halfHeight * this.aspect;
    camera.right = this.halfHeight * this.aspect;
  }

  /** From pixels of the window to the square from -1 to 1 in which cameras think. */
  private toDevice(x: number, y: number): Vector2 {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return new Vector2(((x - left) / width) * 2 - 1, 1 - ((y - top) / height) * 2);
  }
}
