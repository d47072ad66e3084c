// The axes of the world in a corner of the picture, as the camera sees them. They show the directions of the
// coordinates that the panels list.

import { Vector3 } from "three";
import type { StageCamera } from "./camera";

/** Half the width of the element, and the length of an axis that is parallel to the screen, in CSS pixels. */
const [HALF, LENGTH] = [34, 22];
const NAMES = ["x", "y", "z"] as const;

/** An axis: its line, and its name at the end. */
interface Axis {
  line: SVGLineElement;
  name: SVGTextElement;
}

/** The axes of a 3D world. In 2D x points right and y up, so nothing is drawn. */
export class Axes {
  private readonly element = part("svg", { class: "axes", viewBox: `${-HALF} ${-HALF} ${2 * HALF} ${2 * HALF}` });
  private readonly axes: Axis[] = NAMES.map((name) => ({
    line: part("line", { class: name }),
    name: part("text", { class: name }),
  }));

  constructor(layer: HTMLElement) {
    NAMES.forEach((name, index) => (this.axes[index]!.name.textContent = name));
    layer.append(this.element);
  }

  /**
   * Draws the axes for the rotation of the camera, in order of their depth: axes that point towards the reader last.
   */
  place({ camera }: StageCamera): void {
    const turned = this.axes.map((axis, index) => {
      // In the frame of the camera x is right, y up, and z points to the reader.
      const end = new Vector3().setComponent(index, LENGTH).applyQuaternion(camera.quaternion.clone().invert());
      return { axis, end };
    });
    turned.sort((one, other) => one.end.z - other.end.z);
    for (const { axis, end } of turned) {
      set(axis.line, { x2: end.x, y2: -end.y });
      set(axis.name, { x: end.x * 1.4, y: -end.y * 1.4 });
      this.element.append(axis.line, axis.name);
    }
  }
}

function part<Name extends "svg" | "line" | "text">(
  name: Name,
  attributes: Record<string, string>,
): SVGElementTagNameMap[Name] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  set(element, attributes);
  return element;
}

function set(element: SVGElement, attributes: Record<string, string | number>): void {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
}
