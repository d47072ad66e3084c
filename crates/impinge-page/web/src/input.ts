// Pointer and keyboard: calls the actions of gestures and of keys.

import { button, make } from "./dom";

/** The meaning of a click or drag. */
export type Mode = "select" | "pair" | "ray" | "move";

/** The modes in the order of their buttons, each with a hint for the reader and a key. */
const MODES: { mode: Mode; label: string; hint: string; key: string }[] = [
  { mode: "select", label: "Select", hint: "Click an object; Shift-click a second one", key: "s" },
  { mode: "pair", label: "Pair", hint: "Click two objects: why do they touch, or not?", key: "p" },
  { mode: "ray", label: "Ray", hint: "Draw a ray: drag in 2D, click in 3D", key: "r" },
  { mode: "move", label: "Move", hint: "Drag an object; also Alt-drag in any mode", key: "m" },
];
/** The tolerance of a pointer's position, in CSS pixels. */
const PRECISION = { mouse: 6, touch: 14 };

/** A point of the window in CSS pixels. */
export interface At {
  x: number;
  y: number;
  /** A press that moves less than this is a click. In 2D a click within this distance of an object selects it. */
  radius: number;
}

/** The calls that gestures make. */
export interface Gestures {
  /** Called for a click. If `second`, the object is added to the selection. */
  click(at: At, second: boolean): void;
  /** Called in 2D while a ray is drawn from one point to another, and when it ends. */
  drawRay(from: At, to: At): void;
  /** Called when a drag may begin. Grabs the object there, and returns whether there is one. */
  grab(at: At): boolean;
  /** Moves the grabbed object. */
  move(to: At): void;
  /** Called when the drag has ended. */
  drop(): void;
  /** Allows or forbids the camera to use the drag. */
  free(camera: boolean): void;
  /** Returns whether rays are drawn by a drag, as in 2D, instead of a click. */
  dragsRays(): boolean;
}

/** The bar of modes, and the pointer on the canvas. */
export class Pointer {
  mode: Mode = "select";
  private readonly buttons = new Map<Mode, HTMLButtonElement>();
  /** The place where the button or the first finger went down; null if none is down. */
  private start: At | null = null;
  /** The gesture to which a movement of the pointer belongs. */
  private action: "click" | "ray" | "move" = "click";
  /** Whether the press moved farther than the tolerance; then it is not a click. */
  private moved = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly hint: HTMLElement,
    private readonly gestures: Gestures,
    signal: AbortSignal,
  ) {
    // A second finger belongs to the camera from its start. So this listener runs before that of the camera. The first
    // finger reaches this class after the camera: the camera tracks it even while disabled, and can take over the
    // pinch.
    canvas.addEventListener("pointerdown", (event) => this.interrupt(event), { signal, capture: true });
    canvas.addEventListener("pointerdown", (event) => this.down(event), { signal });
    canvas.addEventListener("pointermove", (event) => this.drag(event), { signal });
    canvas.addEventListener("pointerup", (event) => this.up(event), { signal });
    canvas.addEventListener("pointercancel", () => this.finish(), { signal });
  }

  /** Returns the buttons of the modes. */
  tools(): HTMLElement {
    const group = make("div", { class: "modes", role: "group", "aria-label": "Mode" });
    for (const { mode, label, hint, key } of MODES) {
      const element = button(label, () => this.choose(mode), { title: `${hint} (${key})` });
      this.buttons.set(mode, element);
      group.append(element);
    }
    this.choose("select");
    return group;
  }

  /** Selects a mode, and shows its hint until the canvas is used. */
  choose(mode: Mode): void {
    this.mode = mode;
    for (const [other, element] of this.buttons) element.setAttribute("aria-pressed", String(other === mode));
    this.canvas.dataset.mode = mode;
    this.hint.hidden = false;
    this.hint.textContent = MODES.find((other) => other.mode === mode)?.hint ?? "";
  }

  /** Ends the gesture of the first finger when a second finger goes down, since two fingers pinch and pan. */
  private interrupt(event: PointerEvent): void {
    if (!event.isPrimary && this.start) this.finish();
  }

  /**
   * Begins a gesture. Only the first finger and the main button draw and move; all other presses belong to the camera.
   */
  private down(event: PointerEvent): void {
    if (event.button !== 0 || !event.isPrimary) return;
    this.hint.hidden = true;
    this.start = pointOf(event);
    this.moved = false;
    this.action = this.actionOf(event);
    this.gestures.free(this.action === "click");
  }

  /** Returns the action of a press. In the mode `move`, a drag that begins beside all objects belongs to the camera. */
  private actionOf(event: PointerEvent): "click" | "ray" | "move" {
    if (this.mode === "ray" && this.gestures.dragsRays() && !event.altKey) return "ray";
    if ((this.mode === "move" || event.altKey) && this.gestures.grab(pointOf(event))) return "move";
    return "click";
  }

  /**
   * Continues a press. Once it has moved by more than the tolerance, it is a drag, which draws a ray or moves an
   * object.
   */
  private drag(event: PointerEvent): void {
    if (!this.start || !event.isPrimary) return;
    const at = pointOf(event);
    this.moved ||= Math.hypot(at.x - this.start.x, at.y - this.start.y) > at.radius;
    if (!this.moved) return;
    if (this.action === "ray") this.gestures.drawRay(this.start, at);
    if (this.action === "move") this.gestures.move(at);
  }

  /** Ends a press. A press that did not move is a click in every mode. */
  private up(event: PointerEvent): void {
    if (!this.start || !event.isPrimary) return;
    if (!this.moved) this.gestures.click(pointOf(event), event.shiftKey || this.mode === "pair");
    this.finish();
  }

  /** Ends the gesture, also if the browser cancelled it. */
  private finish(): void {
    if (this.action === "move") this.gestures.drop();
    this.start = null;
    this.action = "click";
    this.gestures.free(true);
  }
}

/** Returns the position and the precision of a pointer. */
function pointOf({ clientX, clientY, pointerType }: PointerEvent): At {
  return { x: clientX, y: clientY, radius: pointerType === "touch" ? PRECISION.touch : PRECISION.mouse };
}

/** One or more keys with a common action, and the description of the action in the list of keys. */
export interface Key {
  keys: string[];
  text: string;
  act: (event: KeyboardEvent) => void;
}

/** Calls the actions of keys, unless a modifier other than Shift is held or the focused element uses the key. */
export function listen(keys: Key[], signal: AbortSignal): void {
  const acts = new Map(keys.flatMap(({ keys: names, act }) => names.map((name) => [name, act] as const)));
  const press = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey || taken(event)) return;
    const found = acts.get((event.shiftKey && event.key.startsWith("Arrow") ? "Shift+" : "") + event.key);
    if (!found) return;
    event.preventDefault();
    found(event);
  };
  document.addEventListener("keydown", press, { signal });
}

/** Returns whether the focused element uses the key. The time line does not count: the page's keys move it as well. */
function taken({ target, key }: KeyboardEvent): boolean {
  if (!(target instanceof HTMLElement) || target.matches(".timeline input")) return false;
  if (target.closest("dialog[open], select")) return true;
  if (target.matches("input[type=range]")) return /^(Arrow|Page|Home|End)/.test(key);
  if (target.matches("input")) return key === " ";
  return (key === " " || key === "Enter") && target.closest("button, a, summary") !== null;
}

/** Fills the list of keys, a dialog that the browser opens and closes. */
export function fillHelp(dialog: HTMLDialogElement, keys: Key[]): void {
  const rows = keys.map(({ keys: names, text }) => {
    const shown = keyNames(names).map((name) => make("kbd", {}, name));
    return make("tr", {}, make("td", {}, ...shown), make("td", {}, text));
  });
  const hints = MODES.map(({ label, hint, key }) =>
    make("tr", {}, make("td", {}, make("kbd", {}, key)), make("td", {}, `${label}: ${hint}`)),
  );
  const close = button("Close", () => dialog.close(), { autofocus: true });
  dialog.replaceChildren(
    make("div", { class: "title" }, make("h2", { id: "help-title" }, "Keys"), close),
    make("table", {}, make("tbody", {}, ...rows, ...hints)),
    make("p", {}, "Drag to orbit (3D) or pan (2D), wheel or pinch to zoom, right button or two fingers to pan."),
  );
}

/** Returns the names of keys as on a keyboard. A list of more than two keys is shortened. */
function keyNames(keys: string[]): string[] {
  const names = keys.map((key) => (key === " " ? "Space" : key.replace("Arrow", "").replace("Escape", "Esc")));
  if (names.length <= 2) return names;
  return keys.every((key) => key.startsWith("Shift+")) ? ["Shift", "arrows"] : [`${names[0]} … ${names.at(-1)}`];
}

/** Returns the keys of the modes. */
export function modeKeys(choose: (mode: Mode) => void): Key[] {
  return MODES.map(({ mode, key, label }) => ({ keys: [key], text: label, act: () => choose(mode) }));
}
