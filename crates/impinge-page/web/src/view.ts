// The picture of a stage: light, grid, objects, strokes, and the answers to the reader's questions.

import { Color, DirectionalLight, HemisphereLight, PCFSoftShadowMap, Scene, Vector3, WebGLRenderer } from "three";
import { Axes } from "./axes";
import { StageCamera } from "./camera";
import { bytesOf, css } from "./color";
import { Labels } from "./labels";
import { Grid } from "./grid";
import { ORDER } from "./order";
import type { Frame, Info, Vec3 } from "./protocol";
import { Solids } from "./solids";
import { Lines, Strokes } from "./strokes";

/** A line that answers a question, with a text at its middle. The style sheet has a colour for each kind. */
export interface AnswerLine {
  ends: [Vec3, Vec3];
  kind: "distance" | "ray";
  text?: string;
}

/**
 * Draws a stage. Frames have positions in the stage's frame of coordinates, answers have positions in the world's; see
 * `camera.ts`.
 *
 * The picture is drawn only after changes: call `update` after a frame, `answer` after a question, then `render`.
 */
export class View {
  readonly camera: StageCamera;
  /** The objects. */
  readonly solids: Solids;
  private readonly scene = new Scene();
  private readonly strokes = new Strokes();
  private readonly answers = new Lines(3, ORDER.answers);
  private readonly labels: Labels;
  private readonly axes: Axes | null;
  private readonly light = new DirectionalLight(0xffffff, 2);
  private readonly grid = new Grid();
  /** The lines of the current answer, kept so that they can be drawn again in another colour scheme. */
  private lines: AnswerLine[] = [];
  /** The maximum number of pixels of the screen per CSS pixel. */
  private density = 2;
  private readonly up: Vector3;
  /** The bounds for which camera, light and grid were placed. */
  private bounds: Info["bounds"];

  constructor(
    private readonly renderer: WebGLRenderer,
    info: Info,
    private origin: Vec3,
    layer: HTMLElement,
  ) {
    layer.replaceChildren();
    this.camera = new StageCamera(info, origin, renderer.domElement);
    this.solids = new Solids(this.camera.flat);
    this.labels = new Labels(layer);
    this.axes = this.camera.flat ? null : new Axes(layer);
    this.up = new Vector3(...info.up).normalize();
    this.bounds = info.bounds;
    this.scene.add(this.grid, this.solids.group, this.strokes.group, this.answers.object);
    if (!this.camera.flat) this.addLights();
    this.frame(this.bounds);
    this.theme();
    this.resize();
  }

  /** Places camera, light and grid for these bounds of the world. The view stays the same until `fit`. */
  frame(bounds: Info["bounds"]): void {
    this.bounds = bounds;
    this.camera.frame(bounds, this.origin);
    this.grid.fit(this.camera, this.up);
    this.placeLight();
  }

  /** Moves the camera so that the world and the lines, triangles and shapes drawn near it are in the view. */
  fit(): void {
    this.camera.fit([...this.solids.points(), ...this.strokes.points()]);
  }

  /** Replaces the drawn frame; `render` draws the new one. */
  update(frame: Frame): void {
    const hasMoved = frame.origin.some((part, axis) => part !== this.origin[axis]);
    this.origin = frame.origin;
    this.solids.update(frame);
    this.strokes.update(frame);
    this.labels.set(frame.labels.map(({ at, text, color }) => ({ at: new Vector3(...at), text, color: css(color) })));
    this.light.shadow.needsUpdate = true;
    // The origin is final once the stage has an object. So if it changes, no object was drawn before that could jump.
    if (!hasMoved) return;
    this.frame(this.bounds);
    this.fit();
  }

  /** Replaces the lines that answer questions. */
  answer(lines: AnswerLine[]): void {
    this.lines = lines;
    const placed = lines.map(({ ends, kind, text }) => {
      const [start, end] = ends.map((at) => this.camera.relative(at)) as [Vector3, Vector3];
      return { start, end, color: styleOf(`--${kind}`), text };
    });
    this.answers.begin(lines.length);
    for (const { start, end, color } of placed) this.answers.add([...start, ...end], 0, bytesOf(color), 0);
    this.answers.end();
    this.labels.setAnswers(
      placed.flatMap(({ start, end, color, text }) =>
        text ? [{ at: start.clone().lerp(end, 0.5), text, color }] : [],
      ),
    );
  }

  /** Draws the picture. */
  render(): void {
    this.camera.place();
    this.strokes.scale(this.camera.pixelsPerUnit(), this.renderer.getPixelRatio());
    this.renderer.render(this.scene, this.camera.camera);
    this.labels.place(this.camera);
    this.axes?.place(this.camera);
  }

  /** Takes over the size of the canvas from the style sheet. */
  resize(): void {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, this.density));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.resize(clientWidth, clientHeight);
  }

  /** Reads the colours of the style sheet, which depend on the reader's colour scheme. */
  theme(): void {
    this.scene.background = new Color(styleOf("--canvas"));
    this.grid.tint = styleOf("--grid");
    this.answer(this.lines);
  }

  /**
   * Switches to a faster drawing without shadows and grid, and with one pixel per CSS pixel. Called if drawing takes
   * too long.
   */
  simplify(): void {
    this.light.castShadow = false;
    this.grid.visible = false;
    this.density = 1;
    this.resize();
  }

  /** Releases the graphics memory; the renderer stays. */
  dispose(): void {
    this.solids.dispose();
    this.strokes.dispose();
    this.answers.dispose();
    this.grid.dispose();
    this.light.dispose();
    this.camera.dispose();
  }

  /** Adds light from the sky and one lamp, which casts soft shadows. */
  private addLights(): void {
    const sky = new HemisphereLight(0xffffff, 0xb8bec9, 1.7);
    sky.position.copy(this.up);
    const { light } = this;
    light.castShadow = true;
    light.shadow.mapSize.set(2048, 2048);
    light.shadow.radius = 4;
    // Contacts below a solid must be legible in its shadow.
    light.shadow.intensity = 0.45;
    // Shadows change with the frame, not with the camera: moving the camera draws the objects once per picture, not
    // twice.
    light.shadow.autoUpdate = false;
    this.scene.add(sky, light, light.target);
  }

  /** Places the lamp above the right front of the world, and the box of its shadows around the world. */
  private placeLight(): void {
    const { center, radius } = this.camera.sphere;
    const side = Math.abs(this.up.z) > 0.5 ? new Vector3(0.6, -0.35, 0) : new Vector3(0.6, 0, 0.35);
    this.light.target.position.copy(center);
    this.light.position.copy(center).addScaledVector(side.add(this.up), 2 * radius);
    const { shadow } = this.light;
    // About two texels of the shadow map, as a length in the world. Without this bias surfaces cast stripes of shadow
    // on themselves.
    shadow.normalBias = radius * 2e-3;
    // The box is aligned with the light and contains the bounding sphere of the world. It extends from near the lamp to
    // behind the world.
    const half = 1.2 * radius;
    Object.assign(shadow.camera, { left: -half, right: half, top: half, bottom: -half });
    Object.assign(shadow.camera, { near: 0.1 * radius, far: 5 * radius });
    shadow.camera.updateProjectionMatrix();
    shadow.needsUpdate = true;
  }
}

/** Creates the renderer of the page. All stages share it, since browsers limit the number of WebGL contexts. */
export function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFSoftShadowMap;
  return renderer;
}

/** Returns a colour of the style sheet by its name. */
function styleOf(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
