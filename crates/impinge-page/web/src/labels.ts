// Texts in the picture: elements above the canvas, so that they are sharp and can be of any script.

import type { StageCamera } from "./camera";
import { make } from "./dom";
import type { Vec3 } from "./protocol";

/** A text at a point of the world. */
export interface PlacedText {
  at: Vec3;
  text: string;
  color: string;
}

/** More texts than this at once could not be read. */
const MOST = 150;

export class Labels {
  /** Elements are made once and used again. */
  private readonly pool: HTMLElement[] = [];
  private texts: PlacedText[] = [];

  /** `layer` lies above the canvas and is hidden from assistive technology, which reads the panels. */
  constructor(private readonly layer: HTMLElement) {
    layer.replaceChildren();
  }

  /** Replaces the texts; they are placed with the next picture. */
  set(texts: PlacedText[]): void {
    this.texts = texts.slice(0, MOST);
    while (this.pool.length < this.texts.length) {
      const element = make("span");
      this.pool.push(element);
      this.layer.append(element);
    }
  }

  /** Moves the texts to where the camera has their points. */
  place(camera: StageCamera): void {
    this.pool.forEach((element, index) => {
      const text = this.texts[index];
      const at = text && camera.project(text.at);
      element.hidden = !at;
      if (!text || !at) return;
      if (element.textContent !== text.text) element.textContent = text.text;
      element.style.color = text.color;
      element.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px) translate(8px, -50%)`;
    });
  }
}
