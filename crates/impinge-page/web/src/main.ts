// The page: opens the content of the file, and follows the page's address.

import type { WebGLRenderer } from "three";
import { button, byId, setText } from "./dom";
import { readModule, readRecording, readScene, type Scene } from "./embedded";
import { type Engine, loadEngine } from "./engine";
import { sampleInAddress, showGallery } from "./gallery";
import { interact } from "./interaction";
import { follow } from "./live";
import { sentence } from "./messages";
import type { Info } from "./protocol";
import { makeRenderer } from "./view";
import { Viewer } from "./viewer";

/** The open stage. The engine has one stage, so there is at most one viewer. */
class Page {
  private viewer: Viewer | null = null;
  /** The renderer. It is created when the first stage opens, since the gallery needs no graphics. */
  private renderer: WebGLRenderer | null = null;

  constructor(
    private readonly scene: Scene,
    private readonly engine: Engine,
  ) {}

  /** Opens the content of the file. Throws if the embedded recording cannot be opened. */
  open(): void {
    switch (this.scene.open) {
      case "recording":
        this.show(this.engine.open({ kind: "recording", bytes: readRecording() }), null);
        break;
      case "live":
        this.watch(this.scene.log ?? "/log");
        break;
      case "samples":
        addEventListener("hashchange", () => this.route());
        this.route();
    }
  }

  /** Shows the gallery, or the sample that the address names. */
  private route(): void {
    const name = sampleInAddress();
    this.viewer?.close();
    this.viewer = null;
    dismiss();
    byId("viewer").hidden = name === null;
    byId("gallery").hidden = name !== null;
    document.title = this.scene.title;
    if (name === null) showGallery(byId("gallery"), this.scene.title, this.engine.samples());
    else attempt(() => this.show(this.engine.open({ kind: "sample", name }), () => (location.hash = "")));
  }

  /** Shows the stage that the engine has opened. Samples start to run, unless the reader prefers reduced motion. */
  private show(info: Info, leave: (() => void) | null): Viewer {
    const title = info.title || this.scene.title;
    byId("viewer").hidden = false;
    byId("back").hidden = leave === null;
    setText(byId("title"), title);
    setText(byId("facts"), facts(info));
    document.title = title;
    this.renderer ??= makeRenderer(byId<HTMLCanvasElement>("canvas"));
    const viewer = new Viewer(this.engine, this.renderer, info, complain);
    this.viewer = viewer;
    const fit = button("Fit", () => viewer.fit(), { title: "Fit the world into the view (f)" });
    const help = button("?", () => byId<HTMLDialogElement>("help").showModal(), {
      "aria-label": "Keys",
      title: "Keys (?)",
    });
    byId("tools").replaceChildren(interact(this.engine, viewer, leave), fit, help);
    if (info.kind === "sample" && !matchMedia("(prefers-reduced-motion: reduce)").matches) viewer.player.toggle();
    return viewer;
  }

  /**
   * Reads a live recording. The stage is shown when the first step has arrived, because before that its dimension is
   * unknown.
   */
  private watch(address: string): void {
    this.engine.open({ kind: "stream" });
    const take = (bytes: Uint8Array): void =>
      attempt(() => {
        const info = this.engine.push(bytes);
        if (this.viewer) this.viewer.grow(info);
        else if (info.steps) this.show(info, null);
      });
    follow(address, take).then(
      () => this.viewer?.ended(),
      (error: unknown) => complain(sentence(error)),
    );
  }
}

/**
 * Returns a line with the dimension and the scalar of a stage, the number of steps of a recording that does not grow,
 * and the program that wrote the recording.
 */
function facts(info: Info): string {
  const steps = info.steps === null || info.kind === "stream" ? [] : [`${info.steps} steps`];
  return [`${info.dimension}D`, info.scalar, ...steps, info.written_by].filter(Boolean).join(" · ");
}

/** Shows a text, such as an error, until it is dismissed. */
function complain(message: string): void {
  const notice = byId("notice");
  setText(notice.querySelector("p") ?? notice, message);
  notice.hidden = false;
}

/** Hides the notice. */
function dismiss(): void {
  byId("notice").hidden = true;
}

/** Calls `act`, and shows its error if it throws one. */
function attempt(act: () => void): void {
  try {
    act();
  } catch (error) {
    complain(sentence(error));
  }
}

/** Opens the page. If that fails, the page shows the error instead of staying blank. */
async function main(): Promise<void> {
  byId("notice").querySelector("button")?.addEventListener("click", dismiss);
  const page = new Page(readScene(), await loadEngine(await readModule()));
  page.open();
}

main().catch((error: unknown) => complain(`This page cannot be shown. ${sentence(error)}`));
