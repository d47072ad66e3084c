// One open stage: the engine's world, its picture, its panels, and the loop that keeps them together.

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

/** Panels are written at most so often while time runs, in milliseconds. */
const PANEL_PAUSE = 120;
/** The summary for assistive technology, likewise. */
const SUMMARY_PAUSE = 1500;
/** Pictures that take longer than this, in milliseconds, on the average are drawn more simply. */
const SLOW = 60;

/** What is out of date once the world has changed. */
const ALL = { frame: true, picture: true, panels: true };

/** Owns what belongs to a stage until `close`. Nothing is drawn while nothing changes. */
export class Viewer {
  /** Time. */
  readonly player: Player;
  readonly view: View;
  /** What is selected. */
  readonly inquiry: Inquiry;
  readonly layers: Layers;
  private readonly transport: Transport;
  private readonly form: ControlForm;
  private readonly counts = make("p", { class: "counts" });
  private readonly readouts = make("div", { class: "readouts" });
  private readonly events = make("div", { class: "events" });
  private readonly controller = new AbortController();
  private readonly watch: ResizeObserver;
  /** Running average of the time between pictures while the world moves. */
  private pace = 0;
  /** What differs from the engine's state or from the camera. */
  private stale = { ...ALL };
  /** The time of the last picture, in milliseconds; none was drawn yet. */
  private time: number | null = null;
  /** When panels and the summary were written last; they are out of date. */
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

  /** Aborted by `close`: listeners end with it. */
  get signal(): AbortSignal {
    return this.controller.signal;
  }

  /** The frame, the picture and the panels are made anew. */
  refresh(): void {
    this.stale = { ...ALL };
    this.last.panels = -Infinity;
  }

  /** Only the camera moved. */
  redraw(): void {
    this.stale.picture = true;
  }

  /** Brings the world into the view. */
  fit(): void {
    this.view.fit();
    this.redraw();
  }

  /** The next step at which something happened, or the one before. */
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

  /** More of a live recording came. */
  grow(info: Info): void {
    this.player.grow(info);
    this.transport.grow();
    this.view.frame(info.bounds);
  }

  /** The live recording's stream ended. */
  ended(): void {
    this.transport.ended();
  }

  /** Reports a refusal of the engine; other errors are bugs, and are not caught. */
  attempt(act: () => void): void {
    try {
      act();
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      this.complain(sentence(error));
    }
  }

  /** The reader operated a control of a sample. */
  private control(name: string, value: Value): void {
    this.attempt(() => this.player.take(this.engine.control(name, value)));
  }

  /** The engine's state changed. */
  private take(status: Status): void {
    this.stale = { ...ALL };
    this.form.update(status.controls);
    this.transport.update();
    if (status.diverged) this.complain(`The replay differs from its recording (${status.diverged}).`);
  }

  /** Once for each picture of the screen, until the stage is closed. All times are those of pictures: other clocks
   * may be ahead of them. */
  private loop(time: number): void {
    if (this.signal.aborted) return;
    const passed = Math.max(0, time - (this.time ?? time));
    this.time = time;
    this.attempt(() => this.player.tick(passed / 1000));
    this.watchPace(passed);
    this.attempt(() => this.bringUpToDate(time));
    requestAnimationFrame((next) => this.loop(next));
  }

  /** Software rendering is slow: shadows go first. One long pause does not count as slow. */
  private watchPace(passed: number): void {
    if (!this.player.playing || this.pace > SLOW) return;
    this.pace += (Math.min(passed, 4 * SLOW) - this.pace) / 20;
    if (this.pace > SLOW) this.view.simplify();
  }

  /** Frame before picture, panels last, since they may wait. */
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

  /** In words what is shown, for assistive technology. */
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

  /** Lays the panels out: the selection stands on top, where it is seen on a narrow screen too. */
  private panels(selection: HTMLElement): void {
    const about = [this.info.about, ...this.info.notes]
      .filter(Boolean)
      .map((text) => make("p", { class: "about" }, text));
    const world = make("section", { class: "world", "aria-label": "World" }, ...about, this.counts, this.form.element);
    world.append(this.readouts, this.events);
    const layers = make("details", { open: innerWidth > 720 }, make("summary", {}, "Layers"), this.layers.element);
    byId("panels").replaceChildren(selection, world, layers);
  }

  /** Draws at once, so that the canvas is not blank for a moment. */
  private resize(): void {
    this.view.resize();
    this.stale.picture = true;
    this.view.render();
  }

  /** The reader's colour scheme changed. */
  private recolor(): void {
    this.view.theme();
    this.transport.timeline.draw();
    this.stale.picture = true;
  }
}

/** What there is, in words. */
function counts({ objects, pairs, contacts }: Status): string {
  return [counted(objects, "object"), counted(pairs, "pair"), counted(contacts, "contact")].join(", ");
}
