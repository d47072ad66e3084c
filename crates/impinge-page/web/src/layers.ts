// The layers of a frame as check boxes, with their colours as a legend.

import { css } from "./color";
import { make } from "./dom";
import type { Frame } from "./protocol";

/** Something that the engine draws, or not. */
interface Layer {
  name: string;
  /** What it draws, for people. */
  label: string;
  shown: boolean;
}

/** In the order of their keys; boxes and the tree are for those who want them. */
const LAYERS: Layer[] = [
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

export class Layers {
  readonly element = make("ul", { class: "layers" });
  private readonly layers = LAYERS.map((layer) => ({ ...layer }));
  /** The check box of each layer by its name. */
  private readonly boxes = new Map<string, HTMLInputElement>();

  constructor(private readonly changed: () => void) {
    this.layers.forEach((layer, index) => this.element.append(this.row(layer, index)));
  }

  /** The names of the layers that are on, as the engine has them. */
  get shown(): string[] {
    return this.layers.filter((layer) => layer.shown).map((layer) => layer.name);
  }

  /** Turns the layer of a key over: 1 is the first. */
  toggle(index: number): void {
    const layer = this.layers[index];
    if (!layer) return;
    layer.shown = !layer.shown;
    const box = this.boxes.get(layer.name);
    if (box) box.checked = layer.shown;
    this.changed();
  }

  /** Takes the legend's colours from what is drawn. */
  learn({ layers, lines, points, triangles, payload }: Frame): void {
    for (const { count, color, layer } of [triangles, points, lines]) {
      const [colors, indices] = [payload.words(color), payload.words(layer)];
      let last = -1;
      for (let at = 0; at < count; at += 1) {
        const index = indices[at] ?? 0;
        // Layers come in runs: the first of each is enough.
        if (index !== last) this.swatch(layers[index] ?? "", colors[at] ?? 0);
        last = index;
      }
    }
  }

  /** Writes a colour where it differs. */
  private swatch(name: string, color: number): void {
    const swatch = this.boxes.get(name)?.nextElementSibling as HTMLElement | null;
    const text = css(color);
    if (swatch && swatch.dataset.color !== text) {
      swatch.dataset.color = text;
      swatch.style.background = text;
    }
  }

  /** A check box, a colour, words and a key. */
  private row(layer: Layer, index: number): HTMLElement {
    const box = make("input", { type: "checkbox", checked: layer.shown });
    box.addEventListener("change", () => {
      layer.shown = box.checked;
      this.changed();
    });
    this.boxes.set(layer.name, box);
    const swatch = make("i", { class: `swatch ${layer.name.replace(" ", "-")}`, "aria-hidden": "true" });
    const key = make("kbd", { "aria-hidden": "true" }, String((index + 1) % 10));
    return make("li", {}, make("label", {}, box, swatch, layer.label, key));
  }
}
