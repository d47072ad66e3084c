// The effects of gestures and keys on a stage.

import type { Engine } from "./engine";
import { byId } from "./dom";
import { type At, fillHelp, type Gestures, type Key, listen, modeKeys, Pointer } from "./input";
import type { PickAnswer, Vec3 } from "./protocol";
import type { Viewer } from "./viewer";

/** A dragged object, in the world's frame. */
interface Dragged {
  object: number;
  /** The position of the object when the drag began. */
  translation: Vec3;
  /** The point of the object that the pointer grabbed, which stays under the pointer. */
  anchor: Vec3;
}

/** Connects the canvas and the keyboard to a viewer until it is closed. Returns the bar of modes. */
export function interact(engine: Engine, viewer: Viewer, leave: (() => void) | null): HTMLElement {
  const gestures = new StageGestures(engine, viewer, () => pointer.mode);
  const pointer: Pointer = new Pointer(byId<HTMLCanvasElement>("canvas"), byId("hint"), gestures, viewer.signal);
  const tools = pointer.tools();
  const keys = stageKeys(viewer, leave);
  listen([...keys, ...modeKeys((mode) => pointer.choose(mode))], viewer.signal);
  fillHelp(byId<HTMLDialogElement>("help"), keys);
  return tools;
}

/** Translates the gestures of the pointer to questions and to moves of objects. */
class StageGestures implements Gestures {
  private dragged: Dragged | null = null;

  constructor(
    private readonly engine: Engine,
    private readonly viewer: Viewer,
    private readonly mode: () => string,
  ) {}

  /**
   * Casts a ray from the camera in the mode `ray` in 3D; otherwise selects the object under the pointer. In 2D a ray is
   * a drag, and a click selects in every mode.
   */
  click(at: At, second: boolean): void {
    const { camera } = this.viewer.view;
    const { from, direction } = camera.rayAt(at.x, at.y);
    this.viewer.attempt(() => {
      if (this.mode() === "ray" && !camera.flat) this.viewer.inquiry.shoot(from, direction, null);
      else this.viewer.inquiry.pick(this.pick(at).object, second);
    });
  }

  /** Casts a ray with the length of the drag, which hits the objects between its ends. */
  drawRay(from: At, to: At): void {
    const [a, b] = [this.point(from), this.point(to)];
    const direction: Vec3 = [b[0] - a[0], b[1] - a[1], 0];
    this.viewer.inquiry.shoot(a, direction, Math.hypot(...direction));
  }

  /**
   * Grabs the object under the pointer, and selects it. Stops time, since a running world, or a live recording that is
   * followed, would move the object back. Returns whether there is an object.
   */
  grab(at: At): boolean {
    const { camera } = this.viewer.view;
    this.viewer.attempt(() => {
      const { object, point } = this.pick(at);
      if (object === null) return;
      const { translation } = this.engine.object(object);
      this.dragged = { object, translation, anchor: camera.flat ? this.point(at) : (point ?? translation) };
      this.viewer.player.pause();
      if (!this.viewer.inquiry.selected.includes(object)) this.viewer.inquiry.pick(object, false);
    });
    return this.dragged !== null;
  }

  /**
   * Moves the object so that the grabbed point stays under the pointer, in the plane parallel to the screen where it
   * was grabbed.
   */
  move(to: At): void {
    if (!this.dragged) return;
    const { object, translation, anchor } = this.dragged;
    const point = this.viewer.view.camera.pointAt(to.x, to.y, anchor);
    const moved = translation.map((part, axis) => part + (point[axis] ?? 0) - (anchor[axis] ?? 0)) as Vec3;
    this.viewer.attempt(() => this.viewer.player.take(this.engine.drag(object, moved)));
  }

  /** Ends the drag. The object stays at its position; a recording restores the recorded position at the next step. */
  drop(): void {
    this.dragged = null;
  }

  /** Enables or disables the camera. A disabled camera tracks the fingers but does not move: see `Pointer`. */
  free(camera: boolean): void {
    this.viewer.view.camera.controls.enabled = camera;
  }

  dragsRays(): boolean {
    return this.viewer.view.camera.flat;
  }

  /** Returns the object under a point of the window. */
  private pick({ x, y, radius }: At): PickAnswer {
    const { camera } = this.viewer.view;
    const { from, direction } = camera.rayAt(x, y);
    return this.engine.pick(from, direction, radius / camera.pixelsPerUnit());
  }

  /** Returns the point of a 2D world under a point of the window. */
  private point(at: At): Vec3 {
    return this.viewer.view.camera.rayAt(at.x, at.y).from;
  }
}

/** Returns the keys of a stage with their actions; `leave` goes back to the gallery, and is null without a gallery. */
function stageKeys(viewer: Viewer, leave: (() => void) | null): Key[] {
  const { player, view, inquiry, layers } = viewer;
  const turn = ({ key }: KeyboardEvent): void => {
    const right = Number(key === "ArrowRight") - Number(key === "ArrowLeft");
    view.camera.nudge(right, Number(key === "ArrowUp") - Number(key === "ArrowDown"));
    viewer.redraw();
  };
  const zoom = ({ key }: KeyboardEvent): void => {
    view.camera.zoom(key === "+" ? 1.15 : 1 / 1.15);
    viewer.redraw();
  };
  const seekable = player.canSeek;
  const escape = (): void => {
    if (inquiry.empty && leave) leave();
    else inquiry.clear();
  };
  return [
    { keys: [" "], text: "play or pause", act: () => player.toggle() },
    { keys: ["ArrowRight"], text: "one step on", act: () => player.move(1) },
    { keys: ["ArrowLeft"], text: "one step back (recordings)", act: () => player.move(-1) },
    { keys: ["PageDown"], text: "ten steps on", act: () => player.move(10) },
    { keys: ["PageUp"], text: "ten steps back (recordings)", act: () => player.move(-10) },
    { keys: ["ArrowUp"], text: "faster", act: () => player.faster(1) },
    { keys: ["ArrowDown"], text: "slower", act: () => player.faster(-1) },
    { keys: ["Home"], text: "to the start", act: () => player.reset() },
    { keys: ["End"], text: "to the end (recordings)", act: () => seekable && player.follow() },
    {
      keys: [".", ","],
      text: "next and previous mark of the time line",
      act: (event) => viewer.toMark(event.key === "." ? 1 : -1),
    },
    {
      keys: ["Shift+ArrowLeft", "Shift+ArrowRight", "Shift+ArrowUp", "Shift+ArrowDown"],
      text: "turn or shift the view",
      act: turn,
    },
    {
      keys: ["+", "-"],
      text: "nearer, farther",
      act: zoom,
    },
    { keys: ["f"], text: "fit the world into the view", act: () => viewer.fit() },
    {
      keys: ["1", "2", "3", "4", "5", "6", "7", "8", "9", "0"],
      text: "layers on and off",
      act: (event) => layers.toggle((Number(event.key) + 9) % 10),
    },
    { keys: ["Escape"], text: "clear the selection, then back to the gallery", act: escape },
    { keys: ["?"], text: "this list", act: () => byId<HTMLDialogElement>("help").showModal() },
  ];
}
