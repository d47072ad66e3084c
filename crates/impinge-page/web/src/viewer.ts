// One open stage: the engine's world, its picture, its panels, and the loop that updates them.

import type { WebGLRenderer } from "three";
import { ControlForm, type Value } from "./controls";
import { byId, make, setText } from "./dom";
import { type Engine, EngineError } from "./engine";
import { counted } from "./format";
import { Inquiry } from "./inquiry";
import { Layers } from "./layers";
import { sentence } from "./messages";
import { eventList, eventText, readoutList } from "./panels";
import { Player } from "./player";
import type { Info, Status } from "./protocol";
import { Transport } from "./transport";
import { View } from "./view";

/** The minimum time between two updates of the world's panel while time runs, in milliseconds. */
const PANEL_PAUSE = 120;
/** The minimum time between two updates of the summary for assistive technology, in milliseconds. */
const SUMMARY_PAUSE = 1500;
/** The average time per picture, in milliseconds, above which pictures are simplified. */
const SLOW = 60;

/** The parts that are out of date after a change of the world. */
const ALL = { frame: true, picture: true, panels: true };

/** Owns the parts of a stage until `close`. Nothing is drawn while nothing changes. */
export class Viewer {
  /** The player, which controls the shown step. */
  readonly player: Player;
  readonly view: View;
  /** The reader's question: the selected objects, or a ray. */
  readonly inquiry: Inquiry;
  readonly layers: Layers;
  private readonly transport: Transport;
  private readonly form: ControlForm;
  /** A paragraph for each note, about a stand-in or a lost part of the recording. */
  private readonly notes = make("div");
  private readonly counts = make("p", { class: "counts" });
  private readonly readouts = make("div", { class: "readouts" });
  private readonly events = make("div", { class: "events" });
  private readonly controller = new AbortController();
  private readonly watch: ResizeObserver;
  /** The moving average of the time between pictures while the world runs. */
  private pace = 0;
  /** The parts that are out of date. */
  private stale = { ...ALL };
  /** The time of the last picture, in milliseconds; null before the first. */
  private time: number | null = null;
  /** The times at which the panels and the summary were last written, in milliseconds. */
  private last = { panels: -Infinity, summary: -Infinity };

  constructor(
    private readonly engine: Engine,
    renderer: WebGLRenderer,
    readonly info: Info,
    private readonly complain: (text: string) => void,
  ) {
    const selection = make("section", { class: "selection", "aria-label": "Selection", hidden: true });
    this.layers = new Layers(() => this.refresh());
    this.inquiry = new Inquiry(engine, info, selection, () => this.refresh());
    this.player = new Player(engine, info, engine.advance(0), (status) => this.take(status));
    this.form = new ControlForm(info.controls, (name, value) => this.control(name, value));
    const first = engine.frame(this.layers.shown, [], 0);
    this.view = new View(renderer, info, first.origin, byId("labels"));
    this.view.update(first);
    this.view.fit();
    this.transport = new Transport(byId("transport"), this.player);
    this.panels(selection);
    this.view.camera.controls.addEventListener("change", () => (this.stale.picture = true));
    this.watch = new ResizeObserver(() => this.resize());
    this.watch.observe(renderer.domElement);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolor(), {
      signal: this.signal,
    });
    requestAnimationFrame((time) => this.loop(time));
  }

  /** The signal that `close` aborts. Listeners that use it end with the stage. */
  get signal(): AbortSignal {
    return this.controller.signal;
  }

  /** Marks the frame, the picture and the panels as out of date. */
  refresh(): void {
    this.stale = { ...ALL };
    this.last.panels = -Infinity;
  }

  /** Marks the picture as out of date, since the camera moved. */
  redraw(): void {
    this.stale.picture = true;
  }

  /** Moves the camera so that the world is in the view. */
  fit(): void {
    this.view.fit();
    this.redraw();
  }

  /** Goes to the next or previous step that has a mark. */
  toMark(direction: 1 | -1): void {
    const step = this.transport.timeline.neighbour(this.player.step, direction);
    if (step !== null) this.player.seek(step);
  }

  /** Ends the loop and releases the graphics memory. */
  close(): void {
    this.controller.abort();
    this.watch.disconnect();
    this.view.dispose();
  }

  /** Takes over the description of a live recording that has grown. */
  grow(info: Info): void {
    this.player.grow(info);
    this.transport.grow();
    this.note(info.notes);
    this.view.frame(info.bounds);
  }

  /** Shows that the stream of a live recording has ended. */
  ended(): void {
    this.transport.ended();
  }

  /** Calls `act` and reports an error of the engine. Other errors are bugs, and are not caught. */
  attempt(act: () => void): void {
    try {
      act();
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      this.complain(sentence(error));
    }
  }

  /** Sends a changed control of a sample to the engine. */
  private control(name: string, value: Value): void {
    this.attempt(() => this.player.take(this.engine.control(name, value)));
  }

  /** Takes over a changed state of the engine. */
  private take(status: Status): void {
    this.stale = { ...ALL };
    this.form.update(status.controls);
    this.transport.update();
    this.note(status.notes);
    if (status.diverged) this.complain(`The replay differs from its recording (${status.diverged}).`);
  }

  /** Shows the notes if there are more than before. They are never fewer, and a status without new notes lists none. */
  private note(notes: string[]): void {
    if (notes.length > this.notes.childElementCount) this.notes.replaceChildren(...notes.map(aboutText));
  }

  /**
   * Runs before each picture of the screen, until the stage is closed. All times are those that the browser passes for
   * pictures, since its other clocks may be ahead of them.
   */
  private loop(time: number): void {
    if (this.signal.aborted) return;
    const passed = Math.max(0, time - (this.time ?? time));
    this.time = time;
    this.attempt(() => this.player.tick(passed / 1000));
    this.watchPace(passed);
    this.attempt(() => this.bringUpToDate(time));
    requestAnimationFrame((next) => this.loop(next));
  }

  /**
   * Simplifies the picture if pictures take too long on average, as with software rendering. One pause does not
   * suffice.
   */
  private watchPace(passed: number): void {
    if (!this.player.playing || this.pace > SLOW) return;
    this.pace += (Math.min(passed, 4 * SLOW) - this.pace) / 20;
    if (this.pace > SLOW) this.view.simplify();
  }

  /** Updates the parts that are out of date: the frame before the picture, and the panels last, since they may wait. */
  private bringUpToDate(time: number): void {
    if (this.stale.frame) {
      this.stale.frame = false;
      this.view.update(this.engine.frame(this.layers.shown, this.inquiry.selected, this.view.solids.known));
      this.view.answer(this.inquiry.answer());
    }
    if (this.stale.picture) {
      this.stale.picture = false;
      this.view.render();
    }
    if (this.stale.panels && time - this.last.panels > PANEL_PAUSE) this.write(time);
  }

  /** Writes the panel of the world. */
  private write(time: number): void {
    const { status } = this.player;
    this.last.panels = time;
    this.stale.panels = false;
    setText(this.counts, counts(status));
    this.readouts.replaceChildren(readoutList(status.readouts));
    this.events.replaceChildren(eventList(status, this.inquiry.links));
    this.events.hidden = status.events.length === 0;
    this.summarize(time);
  }

  /** Writes a summary in words for assistive technology; while time runs, at most once in `SUMMARY_PAUSE`. */
  private summarize(time: number): void {
    const { player } = this;
    if (player.playing && time - this.last.summary < SUMMARY_PAUSE) {
      this.stale.panels = true;
      return;
    }
    this.last.summary = time;
    const last = player.info.steps;
    const step = last === null ? `step ${player.step}` : `step ${player.step} of ${last}`;
    const events = player.status.events.slice(0, 3).map(eventText);
    setText(byId("summary"), [`${step}: ${counts(player.status)}`, ...events].join("; "));
  }

  /** Arranges the panels. The selection is on top, where it is visible on a narrow screen too. */
  private panels(selection: HTMLElement): void {
    const world = make("section", { class: "world", "aria-label": "World" });
    if (this.info.about) world.append(aboutText(this.info.about));
    world.append(this.notes, this.counts, this.form.element, this.readouts, this.events);
    this.note(this.info.notes);
    const layers = make("details", { open: innerWidth > 720 }, make("summary", {}, "Layers"), this.layers.element);
    byId("panels").replaceChildren(selection, world, layers);
  }

  /** Takes over the size of the canvas and draws at once, so that the canvas is not blank for a moment. */
  private resize(): void {
    this.view.resize();
    this.stale.picture = true;
    this.view.render();
  }

  /** Takes over the reader's colour scheme. */
  private recolor(): void {
    this.view.theme();
    this.transport.timeline.draw();
    this.stale.picture = true;
  }
}

/** Returns a paragraph about the stage. */
function aboutText(text: string): HTMLElement {
  return make("p", { class: "about" }, text);
}

/** Returns the numbers of objects, pairs and contacts in words. */
function counts({ objects, pairs, contacts }: Status): string {
  return [counted(objects, "object"), counted(pairs, "pair"), counted(contacts, "contact")].join(", ");
}
