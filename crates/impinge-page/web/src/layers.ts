// The layers of a frame as check boxes, with their colours as a legend. The style sheet repeats the colours of the
// engine, since a frame contains only the colours of visible layers.

import { make } from "./dom";

/**
 * The layers in the order of their keys: the engine's name, the description, and whether the layer is visible at first.
 */
const LAYERS = [
  { name: "object", label: "objects", shown: true },
  { name: "tight box", label: "tight boxes", shown: false },
  { name: "loosened box", label: "loosened boxes", shown: false },
  { name: "tree", label: "broad-phase tree", shown: false },
  { name: "contact", label: "contact points", shown: true },
  { name: "normal", label: "contact normals", shown: true },
  { name: "manifold", label: "manifolds", shown: true },
  { name: "proximity", label: "proximities", shown: true },
  { name: "query", label: "queries", shown: true },
  { name: "query hit", label: "hits of queries", shown: true },
];
/** The engine's names of all layers. */
export const LAYER_NAMES = LAYERS.map(({ name }) => name);

/** The check boxes of the layers. They hold the state: a layer is visible if its box is checked. */
export class Layers {
  readonly element = make("ul", { class: "layers" });
  private readonly boxes = LAYERS.map(({ shown }) => make("input", { type: "checkbox", checked: shown }));

  constructor(changed: () => void) {
    this.element.append(...this.boxes.map((box, index) => row(box, index)));
    this.element.addEventListener("change", changed);
  }

  /** Returns the names of the visible layers. */
  get shown(): string[] {
    return LAYER_NAMES.filter((_, index) => this.boxes[index]?.checked);
  }

  /** Turns a layer on or off, as a click on its check box does. */
  toggle(index: number): void {
    this.boxes[index]?.click();
  }
}

/** Returns the row of a layer: its check box, its colour, its description and its key. */
function row(box: HTMLInputElement, index: number): HTMLElement {
  const { name, label } = LAYERS[index]!;
  const swatch = make("i", { class: `swatch ${name.replace(" ", "-")}`, "aria-hidden": "true" });
  const key = make("kbd", { "aria-hidden": "true" }, String((index + 1) % 10));
  return make("li", {}, make("label", {}, box, swatch, label, key));
}
