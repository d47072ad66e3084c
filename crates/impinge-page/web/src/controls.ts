// The controls of a sample as elements of a form.

import { button, make, setText } from "./dom";
import { number } from "./format";
import type { Control } from "./protocol";

/** The value that a control sends; null for a button. */
export type Value = number | string | boolean | null;
/** A function that sends a control's new value to the engine, which may reject it. */
type Send = (name: string, value: Value) => void;

/** The form with the controls of a sample. */
export class ControlForm {
  readonly element = make("form", { class: "controls" });
  /** For each control, by its name, a function that shows a value. */
  private readonly writers = new Map<string, (control: Control) => void>();

  constructor(controls: Control[], send: Send) {
    this.element.addEventListener("submit", (event) => event.preventDefault());
    for (const control of controls) this.element.append(this.row(control, send));
  }

  /** Shows values that the sample has changed. Buttons, and controls that the form lacks, are skipped. */
  update(controls: Control[]): void {
    for (const control of controls) this.writers.get(control.name)?.(control);
  }

  /** Returns the element of a control, labelled with the name of the control. */
  private row(control: Control, send: Send): HTMLElement {
    switch (control.kind) {
      case "number":
        return this.slider(control, send);
      case "choice":
        return this.choice(control, send);
      case "flag":
        return this.flag(control, send);
      case "button":
        return button(control.label, () => send(control.name, null), { class: "wide" });
    }
  }

  /** Returns a slider. A step of 0 allows any number between the bounds. */
  private slider(control: Control & { kind: "number" }, send: Send): HTMLElement {
    const { name, label, value, min, max, step } = control;
    const input = make("input", { type: "range", min, max, step: step > 0 ? step : "any", value });
    const shown = make("output", {}, number(value));
    input.addEventListener("input", () => {
      setText(shown, number(input.valueAsNumber));
      send(name, input.valueAsNumber);
    });
    this.writers.set(name, (changed) => {
      if (changed.kind !== "number") return;
      input.valueAsNumber = changed.value;
      setText(shown, number(changed.value));
    });
    return make("label", { class: "slider" }, make("span", {}, label), shown, input);
  }

  /** Returns a selection. Its words come from the engine and are shown unchanged. */
  private choice(control: Control & { kind: "choice" }, send: Send): HTMLElement {
    const select = make("select");
    for (const choice of control.choices) select.append(make("option", { value: choice }, choice));
    select.value = control.value;
    select.addEventListener("change", () => send(control.name, select.value));
    this.writers.set(control.name, (changed) => {
      if (changed.kind === "choice") select.value = changed.value;
    });
    return make("label", { class: "choice" }, make("span", {}, control.label), select);
  }

  /** Returns a check box. */
  private flag(control: Control & { kind: "flag" }, send: Send): HTMLElement {
    const box = make("input", { type: "checkbox", checked: control.value });
    box.addEventListener("change", () => send(control.name, box.checked));
    this.writers.set(control.name, (changed) => {
      if (changed.kind === "flag") box.checked = changed.value;
    });
    return make("label", { class: "flag" }, box, make("span", {}, control.label));
  }
}
