// Texts in the picture: elements above the canvas, so that they are sharp and can be in any script.
//
// A text is hidden if it would overlap a text of higher precedence, or if a text of the engine would come near the
// point of another such text. Answers to the reader have the highest precedence, then texts nearer to the camera, then
// earlier texts of the engine. So the same picture always shows the same texts.

import type { Vector3 } from "three";
import type { CanvasPoint, StageCamera } from "./camera";
import { make } from "./dom";

/** A text at a point of the stage. */
export interface PlacedText {
  at: Vector3;
  text: string;
  /** The colour of the bar at the left, any colour of CSS. */
  color: string;
}

/** The maximum number of texts in a picture; each of them is an element. */
const MAX_TEXTS = 150;
/** The distances between a point and its text, and between two texts, in CSS pixels. */
const [OFFSET, GAP] = [8, 2];
/**
 * The minimum distance of a text from the point of another text, in CSS pixels. It leaves space for the labelled
 * object.
 */
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
  /** The elements, which are created once and reused. */
  private readonly pool: HTMLElement[] = [];
  private answers: PlacedText[] = [];
  private texts: PlacedText[] = [];

  /** `layer` is above the canvas and hidden from assistive technology, which reads the panels. */
  constructor(private readonly layer: HTMLElement) {}

  /** Replaces the texts of the engine; they are placed with the next picture. */
  set(texts: PlacedText[]): void {
    this.texts = texts;
  }

  /** Replaces the texts of answers to the reader, which have precedence. */
  setAnswers(answers: PlacedText[]): void {
    this.answers = answers;
  }

  /**
   * Moves the texts to the positions of their points on the canvas. Reading the sizes causes one layout of the page.
   */
  place(camera: StageCamera): void {
    const answers = this.visible(this.answers, camera);
    const texts = this.visible(this.texts, camera).sort((one, other) => one.depth - other.depth);
    const candidates = [...answers, ...texts].slice(0, MAX_TEXTS);
    // All texts are written before the first size is read; alternating would cause a layout for each size.
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

  /** Returns the texts whose points are on the canvas, in their order. */
  private visible(texts: PlacedText[], camera: StageCamera): Candidate[] {
    const { clientWidth, clientHeight } = this.layer;
    return texts.flatMap((text) => {
      const point = camera.project(text.at);
      const isInside = point && point.x >= 0 && point.x <= clientWidth && point.y >= 0 && point.y <= clientHeight;
      return isInside ? [{ ...point, text }] : [];
    });
  }

  /** Returns the element with an index. Creates it if the pool is not large enough; indices are used in order. */
  private element(index: number): HTMLElement {
    const found = this.pool[index];
    if (found) return found;
    const element = make("span");
    this.pool.push(element);
    this.layer.append(element);
    return element;
  }

  /**
   * Returns the rectangle of a text at the height of its point: to the right of the point, or to the left if the text
   * would not fit into the canvas on the right.
   */
  private beside({ x, y }: CanvasPoint, { offsetWidth: width, offsetHeight: height }: HTMLElement): Rectangle {
    const { clientWidth, clientHeight } = this.layer;
    const isInside = x + OFFSET + width < clientWidth;
    const left = isInside ? x + OFFSET : x - OFFSET - width;
    const top = Math.max(GAP, Math.min(y - height / 2, clientHeight - height - GAP));
    return { left, top, right: left + width, bottom: top + height };
  }
}

/** Writes the text and the colour if they differ. */
function write(element: HTMLElement, { text, color }: PlacedText): void {
  if (element.textContent !== text) element.textContent = text;
  if (element.dataset.color === color) return;
  element.dataset.color = color;
  element.style.setProperty("--mark", color);
}

/**
 * Returns whether a text, with its own point `own`, comes nearer than `CLEARANCE` to another point. False if both
 * points are nearer to each other than that: such points share one text.
 */
function comesNear({ left, top, right, bottom }: Rectangle, own: CanvasPoint, { x, y }: CanvasPoint): boolean {
  if (Math.hypot(own.x - x, own.y - y) < CLEARANCE) return false;
  return left - x < CLEARANCE && x - right < CLEARANCE && top - y < CLEARANCE && y - bottom < CLEARANCE;
}

/** Returns whether two rectangles overlap or are nearer to each other than `GAP`. */
function overlap(a: Rectangle, b: Rectangle): boolean {
  return a.left < b.right + GAP && b.left < a.right + GAP && a.top < b.bottom + GAP && b.top < a.bottom + GAP;
}
