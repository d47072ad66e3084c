// Texts in the picture: elements above the canvas, so that they are sharp and can be of any script.
//
// Texts give way where they would overlap, or come near to the point of another text. Answers to the reader come first, then what
// is nearer to the camera, then what the engine lists earlier: the same picture always has the same texts.

import type { Vector3 } from "three";
import type { CanvasPoint, StageCamera } from "./camera";
import { make } from "./dom";

/** A text at a point of the stage. */
export interface PlacedText {
  at: Vector3;
  text: string;
  /** A colour of CSS: the bar at the left. */
  color: string;
}

/** Texts that a picture shows at most; each is an element. */
const MAX_TEXTS = 150;
/** Between a point and its text, and between two texts, in CSS pixels. */
const [OFFSET, GAP] = [8, 2];
/** So far from the point of another text, in CSS pixels: what is named there has some size. */
const CLEARANCE = 14;

/** A text whose point is on the canvas. */
interface Candidate extends CanvasPoint {
  text: PlacedText;
}

/** A rectangle of the canvas that a text covers, in CSS pixels. */
interface Rectangle {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

export class Labels {
  /** Elements are made once and used again. */
  private readonly pool: HTMLElement[] = [];
  private answers: PlacedText[] = [];
  private texts: PlacedText[] = [];

  /** `layer` lies above the canvas and is hidden from assistive technology, which reads the panels. */
  constructor(private readonly layer: HTMLElement) {}

  /** Replaces the texts of the engine; they are placed with the next picture. */
  set(texts: PlacedText[]): void {
    this.texts = texts;
  }

  /** Replaces those of the page, which come first. */
  setAnswers(answers: PlacedText[]): void {
    this.answers = answers;
  }

  /** Moves the texts to where the camera has their points. Reading the sizes lays the page out once. */
  place(camera: StageCamera): void {
    const answers = this.visible(this.answers, camera);
    const texts = this.visible(this.texts, camera).sort((one, other) => one.depth - other.depth);
    const candidates = [...answers, ...texts].slice(0, MAX_TEXTS);
    // All are written before the first size is read: in turns, each reading would lay the page out again.
    candidates.forEach(({ text }, index) => write(this.element(index), text));
    const placed = candidates.map((point, index) => ({ point, box: this.beside(point, this.element(index)) }));
    const taken: Rectangle[] = [];
    placed.forEach(({ point, box }, index) => {
      const isCrowded = index >= answers.length && texts.some((other) => comesNear(box, point, other));
      const isShown = !isCrowded && !taken.some((other) => overlap(box, other));
      if (isShown) taken.push(box);
      const { style } = this.element(index);
      style.visibility = isShown ? "visible" : "hidden";
      style.transform = `translate(${box.left.toFixed(1)}px, ${box.top.toFixed(1)}px)`;
    });
    for (const element of this.pool.slice(candidates.length)) element.style.visibility = "hidden";
  }

  /** Those whose points are on the canvas, in their order. */
  private visible(texts: PlacedText[], camera: StageCamera): Candidate[] {
    const { clientWidth, clientHeight } = this.layer;
    return texts.flatMap((text) => {
      const point = camera.project(text.at);
      const isInside = point && point.x >= 0 && point.x <= clientWidth && point.y >= 0 && point.y <= clientHeight;
      return isInside ? [{ ...point, text }] : [];
    });
  }

  /** The element of an index. */
  private element(index: number): HTMLElement {
    const found = this.pool[index];
    if (found) return found;
    const element = make("span");
    this.pool.push(element);
    this.layer.append(element);
    return element;
  }

  /** To the right of the point, or to the left where it would leave the canvas, and at half its height. */
  private beside({ x, y }: CanvasPoint, { offsetWidth: width, offsetHeight: height }: HTMLElement): Rectangle {
    const { clientWidth, clientHeight } = this.layer;
    const isInside = x + OFFSET + width < clientWidth;
    const left = isInside ? x + OFFSET : x - OFFSET - width;
    const top = Math.max(GAP, Math.min(y - height / 2, clientHeight - height - GAP));
    return { left, top, right: left + width, bottom: top + height };
  }
}

/** Writes what differs. */
function write(element: HTMLElement, { text, color }: PlacedText): void {
  if (element.textContent !== text) element.textContent = text;
  if (element.dataset.color === color) return;
  element.dataset.color = color;
  element.style.setProperty("--mark", color);
}

/** The text of a point comes near to another point. Points that are as near to each other need one text only. */
function comesNear({ left, top, right, bottom }: Rectangle, own: CanvasPoint, { x, y }: CanvasPoint): boolean {
  if (Math.hypot(own.x - x, own.y - y) < CLEARANCE) return false;
  return left - x < CLEARANCE && x - right < CLEARANCE && top - y < CLEARANCE && y - bottom < CLEARANCE;
}

/** The rectangles are nearer to each other than the gap. */
function overlap(a: Rectangle, b: Rectangle): boolean {
  return a.left < b.right + GAP && b.left < a.right + GAP && a.top < b.bottom + GAP && b.top < a.bottom + GAP;
}
