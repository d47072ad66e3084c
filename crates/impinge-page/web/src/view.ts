// The picture of a stage: light, grid, objects, strokes, and the answers to the reader's questions.

import {
  Color,
  DirectionalLight,
  GridHelper,
  HemisphereLight,
  type LineBasicMaterial,
  PCFSoftShadowMap,
  Quaternion,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { StageCamera } from "./camera";
import { ANSWER, css } from "./color";
import { Labels, type PlacedText } from "./labels";
import type { Frame, Info, Vec3 } from "./protocol";
import { Solids } from "./solids";
import { Lines, Strokes } from "./strokes";

/** More texts of a frame than this hide what they name, and none is shown. */
const CROWD = 24;

/** A line that answers a question, and the text at its middle. */
export interface AnswerLine {
  ends: [Vec3, Vec3];
  kind: "distance" | "ray";
  text?: string;
}

/** Draws a stage. Positions of frames are relative to an origin, which the camera knows too. */
export class View {
  readonly camera: StageCamera;
  /** The objects. */
  readonly solids: Solids;
  private readonly scene = new Scene();
  private readonly strokes = new Strokes();
  /** Lines that answer questions lie above all else. */
  private readonly answers = new Lines(3, false);
  private readonly labels: Labels;
  private readonly light = new DirectionalLight(0xffffff, 2.1);
  private readonly grid: GridHelper;
  /** Texts of the engine, and those of the page, which come first where there are too many. */
  private frameTexts: PlacedText[] = [];
  private answerTexts: PlacedText[] = [];
  /** Kept so that another colour scheme can draw them again. */
  private lines: AnswerLine[] = [];
  /** The reader's scheme. */
  private dark = false;
  /** The most pixels for one of CSS. */
  private density = 2;

  constructor(
    private readonly renderer: WebGLRenderer,
    info: Info,
    private readonly origin: Vec3,
    layer: HTMLElement,
  ) {
    this.camera = new StageCamera(info, origin, renderer.domElement);
    this.solids = new Solids(this.camera.flat);
    this.labels = new Labels(layer);
    this.grid = grid(info, this.camera);
    this.scene.add(this.grid, this.solids.group, this.strokes.group, this.answers.object);
    this.lightScene(info.up);
    this.theme();
    this.resize();
    this.camera.fit();
  }

  /** Draws another frame; the picture follows with `render`. */
  update(frame: Frame): void {
    // The camera reads the same three numbers; they settle when the stage has its first object.
    this.origin.splice(0, 3, ...frame.origin);
    this.solids.update(frame);
    this.strokes.update(frame);
    const { origin } = this;
    const labels = frame.labels.length > CROWD ? [] : frame.labels;
    this.frameTexts = labels.map(({ at, text, color }) => ({
      at: [at[0] + origin[0], at[1] + origin[1], at[2] + origin[2]],
      text,
      color: css(color),
    }));
    this.labels.set([...this.answerTexts, ...this.frameTexts]);
  }

  /** Replaces the lines that answer questions. */
  answer(lines: AnswerLine[]): void {
    this.lines = lines;
    this.answers.begin();
    for (const { ends, kind } of lines) {
      const { r, g, b } = new Color(this.answerColor(kind));
      const bytes = new Color(r, g, b)
        .convertLinearToSRGB()
        .toArray()
        .map((part) => Math.round(part * 255));
      this.answers.add(
        ends.flatMap((end) => this.camera.relative(end)),
        0,
        bytes,
        0,
      );
    }
    this.answers.end();
    this.answerTexts = lines.flatMap(({ ends, kind, text }) =>
      text ? [{ at: middle(ends), text, color: this.answerColor(kind) }] : [],
    );
    this.labels.set([...this.answerTexts, ...this.frameTexts]);
  }

  /** Draws the picture once. */
  render(): void {
    this.camera.place();
    this.strokes.scale(this.camera.pixelsPerUnit(), this.renderer.getPixelRatio());
    this.renderer.render(this.scene, this.camera.camera);
    this.labels.place(this.camera);
  }

  /** Takes over the size of the canvas, which the style sheet gives. */
  resize(): void {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, this.density));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.resize(clientWidth, clientHeight);
  }

  /** Reads the colours of the page, which follow the reader's scheme. */
  theme(): void {
    const style = getComputedStyle(document.documentElement);
    this.dark = matchMedia("(prefers-color-scheme: dark)").matches;
    this.scene.background = new Color(style.getPropertyValue("--canvas").trim());
    (this.grid.material as LineBasicMaterial).color.set(style.getPropertyValue("--grid").trim());
    this.answer(this.lines);
  }

  /** Draws without shadows and with a pixel for each of CSS, where drawing takes too long. */
  simplify(): void {
    this.light.castShadow = false;
    this.density = 1;
    this.resize();
  }

  /** Releases what the graphics memory holds; the renderer stays. */
  dispose(): void {
    this.solids.dispose();
    this.strokes.dispose();
    this.answers.dispose();
    this.grid.dispose();
    this.light.dispose();
    this.camera.dispose();
    this.labels.set([]);
    this.labels.place(this.camera);
  }

  /** Dark enough on light ground, light enough on dark ground. */
  private answerColor(kind: AnswerLine["kind"]): string {
    return this.dark ? ANSWER[`${kind}Dark`] : ANSWER[kind];
  }

  /** Light from the sky and one lamp, which casts soft shadows. */
  private lightScene(up: Vec3): void {
    if (this.camera.flat) return;
    const sky = new HemisphereLight(0xffffff, 0xc9cdd6, 2);
    sky.position.set(...up);
    const radius = this.camera.sceneRadius;
    const { light } = this;
    const target = this.camera.target;
    const side = Math.abs(up[2]) > 0.5 ? new Vector3(0.6, -0.35, 0) : new Vector3(0.6, 0, 0.35);
    light.target.position.copy(target);
    light.position.copy(target).addScaledVector(side.addScaledVector(new Vector3(...up), 1), 2 * radius);
    light.castShadow = true;
    light.shadow.mapSize.set(2048, 2048);
    light.shadow.radius = 4;
    light.shadow.intensity = 0.45;
    light.shadow.normalBias = radius * 2e-3;
    const { camera } = light.shadow;
    [camera.left, camera.right, camera.top, camera.bottom] = [-radius, radius, radius, -radius].map((x) => 1.2 * x) as [
      number,
      number,
      number,
      number,
    ];
    camera.near = 0.1 * radius;
    camera.far = 5 * radius;
    this.scene.add(sky, light, light.target);
  }
}

/** The renderer of the page: one for all stages, since browsers allow few. */
export function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: false });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFSoftShadowMap;
  return renderer;
}

/** A faint grid below the bounds in 3D, behind them in 2D; its cells measure a power of ten. */
function grid(info: Info, camera: StageCamera): GridHelper {
  const cell = 10 ** Math.floor(Math.log10(Math.max(camera.sceneRadius, 1e-30)));
  const cells = 60;
  const helper = new GridHelper(cell * cells, cells, 0xffffff, 0xffffff);
  const material = helper.material as LineBasicMaterial;
  material.vertexColors = false;
  material.transparent = true;
  material.opacity = 0.6;
  material.depthWrite = false;
  helper.renderOrder = -1;
  const normal = camera.flat ? new Vector3(0, 0, 1) : new Vector3(...info.up).normalize();
  helper.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), normal));
  const low = new Vector3(...camera.relative(info.bounds[0]));
  const depth = camera.flat ? -1 : low.dot(normal) - camera.sceneRadius * 2e-3;
  const center = camera.target.clone().addScaledVector(normal, -camera.target.dot(normal));
  center.set(...(center.toArray().map((part) => Math.round(part / cell) * cell) as Vec3));
  helper.position.copy(center.addScaledVector(normal, Number.isFinite(depth) ? depth : 0));
  return helper;
}

/** Where the text of a line stands. */
function middle([a, b]: [Vec3, Vec3]): Vec3 {
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];
}
