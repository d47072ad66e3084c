// The time line: a slider over the steps, with marks where something happened.

import { make } from "./dom";
import type { Mark } from "./protocol";

/** Marks closer than this, in CSS pixels, are drawn as one. */
const BIN = 4;
/** Left and right of the track, so that its ends can be taken. */
const PAD = 10;
/** In CSS pixels; the style sheet has the same. */
const HEIGHT = 58;
/** From top to bottom: added, removed and changed; started; the track; stopped; proximities and queries. */
const ROWS = { changed: 9, track: 31, queries: 51 };
/** The length of the longest bar. */
const BAR = 13;

/** In the order of the legend. */
const KINDS = ["started", "stopped", "proximities", "added", "removed", "changed", "queries"] as const;
/** How often each kind of thing happened. */
type Counts = Record<(typeof KINDS)[number], number>;

export class Timeline {
  readonly element: HTMLElement;
  private readonly canvas = make("canvas");
  private readonly tip = make("span", { class: "tip", "aria-hidden": "true", hidden: true });
  /** Sums of marks by their place on the track. */
  private bins = new Map<number, Counts>();
  /** In order of the steps. */
  private marks: Mark[] = [];
  private steps = 0;
  private step = 0;

  constructor(private readonly seek: (step: number) => void) {
    this.element = make("div", { class: "timeline", role: "slider", tabindex: 0, "aria-label": "Step" });
    this.element.append(this.canvas, this.tip);
    this.element.addEventListener("pointerdown", (event) => this.press(event));
    this.element.addEventListener("pointermove", (event) => this.hover(event));
    this.element.addEventListener("pointerleave", () => (this.tip.hidden = true));
    new ResizeObserver(() => this.layout()).observe(this.element);
  }

  /** Sets what is marked, which grows with a live recording. */
  setMarks(steps: number, marks: Mark[]): void {
    this.steps = steps;
    this.marks = marks;
    this.element.setAttribute("aria-valuemin", "0");
    this.element.setAttribute("aria-valuemax", String(steps));
    this.layout();
  }

  /** Moves the head, and says the step to assistive technology. */
  setStep(step: number): void {
    this.step = step;
    this.element.setAttribute("aria-valuenow", String(step));
    this.element.setAttribute("aria-valuetext", `step ${step} of ${this.steps}`);
    this.draw();
  }

  /** The step of the mark after this one, or before it; null where there is none. */
  neighbour(step: number, direction: 1 | -1): number | null {
    const steps = this.marks.map((mark) => mark.step);
    const found = direction > 0 ? steps.find((other) => other > step) : steps.findLast((other) => other < step);
    return found ?? null;
  }

  /** Draws track, marks and head; colours are those of the style sheet. */
  draw(): void {
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const density = window.devicePixelRatio;
    context.setTransform(density, 0, 0, density, 0, 0);
    context.clearRect(0, 0, this.width, HEIGHT);
    const style = getComputedStyle(this.element);
    const color = (name: string): string => style.getPropertyValue(`--${name}`).trim();
    this.drawTrack(context, color);
    for (const [bin, counts] of this.bins) drawMark(context, PAD + (bin + 0.5) * BIN, counts, color);
    this.drawHead(context, color);
  }

  private get width(): number {
    return this.element.clientWidth;
  }

  /** Where a step is, in CSS pixels from the left. */
  private x(step: number): number {
    return PAD + (this.steps === 0 ? 0 : step / this.steps) * (this.width - 2 * PAD);
  }

  /** The step under the pointer, between the first and the last. */
  private stepAt(event: PointerEvent): number {
    const part = (event.clientX - this.element.getBoundingClientRect().left - PAD) / (this.width - 2 * PAD);
    return Math.round(Math.max(0, Math.min(part, 1)) * this.steps);
  }

  /** Sums the marks of each few pixels, so that drawing costs what the width is. */
  private layout(): void {
    const density = window.devicePixelRatio;
    this.canvas.width = Math.round(this.width * density);
    this.canvas.height = Math.round(HEIGHT * density);
    this.bins = new Map();
    for (const mark of this.marks) {
      const bin = Math.floor((this.x(mark.step) - PAD) / BIN);
      const sum = this.bins.get(bin) ?? {
        started: 0,
        stopped: 0,
        proximities: 0,
        added: 0,
        removed: 0,
        changed: 0,
        queries: 0,
      };
      for (const kind of KINDS) sum[kind] += mark[kind];
      this.bins.set(bin, sum);
    }
    this.draw();
  }

  /** The part that was played has the accent's colour. */
  private drawTrack(context: CanvasRenderingContext2D, color: (name: string) => string): void {
    context.lineCap = "round";
    context.lineWidth = 3;
    stroke(context, [PAD, ROWS.track, this.width - PAD, ROWS.track], color("line"));
    stroke(context, [PAD, ROWS.track, this.x(this.step), ROWS.track], color("accent"));
  }

  /** The present step. */
  private drawHead(context: CanvasRenderingContext2D, color: (name: string) => string): void {
    const x = this.x(this.step);
    context.lineWidth = 1.5;
    stroke(context, [x, 2, x, HEIGHT - 2], color("accent"));
    context.beginPath();
    context.arc(x, ROWS.track, 6.5, 0, 2 * Math.PI);
    context.fillStyle = color("accent");
    context.fill();
    context.strokeStyle = color("panel");
    context.lineWidth = 2;
    context.stroke();
  }

  /** Captures the pointer, so that a drag goes on outside of the element. */
  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.element.setPointerCapture(event.pointerId);
    this.seek(this.stepAt(event));
  }

  /** Says what happened under the pointer, and scrubs while it is pressed. */
  private hover(event: PointerEvent): void {
    const step = this.stepAt(event);
    if (event.buttons & 1) this.seek(step);
    this.tip.hidden = false;
    this.tip.textContent = [`step ${step}`, ...this.happened(step)].join(" · ");
    const half = this.tip.offsetWidth / 2;
    const x = Math.max(half, Math.min(this.x(step), this.width - half));
    this.tip.style.left = `${x}px`;
  }

  /** The marks that share their place with a step, in words. */
  private happened(step: number): string[] {
    const bin = Math.floor((this.x(step) - PAD) / BIN);
    const counts = this.bins.get(bin);
    if (!counts) return [];
    return KINDS.filter((kind) => counts[kind] > 0).map((kind) => describe(kind, counts[kind]));
  }
}

/** A count with its noun. */
function describe(kind: (typeof KINDS)[number], count: number): string {
  if (kind === "queries") return count === 1 ? "1 query" : `${count} queries`;
  if (kind === "proximities") return count === 1 ? "1 proximity" : `${count} proximities`;
  return `${count} ${kind}`;
}

/** Signs differ in form and place, not in colour alone. */
function drawMark(context: CanvasRenderingContext2D, x: number, counts: Counts, color: (name: string) => string): void {
  context.lineCap = "butt";
  context.lineWidth = BIN - 1;
  // Twice as many are a fixed bit longer: one and a thousand can both be seen.
  const length = (count: number): number => Math.min(BAR, 4 + 3 * Math.log2(count));
  if (counts.started > 0)
    stroke(context, [x, ROWS.track - 4, x, ROWS.track - 4 - length(counts.started)], color("started"));
  if (counts.stopped > 0)
    stroke(context, [x, ROWS.track + 4, x, ROWS.track + 4 + length(counts.stopped)], color("stopped"));
  context.lineWidth = 1.5;
  if (counts.added > 0) {
    stroke(context, [x - 3, ROWS.changed, x + 3, ROWS.changed], color("added"));
    stroke(context, [x, ROWS.changed - 3, x, ROWS.changed + 3], color("added"));
  }
  if (counts.removed > 0) {
    stroke(context, [x - 3, ROWS.changed - 3, x + 3, ROWS.changed + 3], color("removed"));
    stroke(context, [x - 3, ROWS.changed + 3, x + 3, ROWS.changed - 3], color("removed"));
  }
  if (counts.changed > 0) stroke(context, [x - 2, ROWS.changed, x + 2, ROWS.changed], color("soft"));
  if (counts.queries > 0) disc(context, x, color("queries"));
  if (counts.proximities > 0) ring(context, x, color("proximities"));
}

/** The sign of queries. */
function disc(context: CanvasRenderingContext2D, x: number, color: string): void {
  context.beginPath();
  context.arc(x, ROWS.queries, 2.5, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
}

/** The sign of changed proximities. */
function ring(context: CanvasRenderingContext2D, x: number, color: string): void {
  context.beginPath();
  context.arc(x, ROWS.queries, 3, 0, 2 * Math.PI);
  context.strokeStyle = color;
  context.stroke();
}

function stroke(
  context: CanvasRenderingContext2D,
  [x1, y1, x2, y2]: [number, number, number, number],
  color: string,
): void {
  context.strokeStyle = color;
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

/** What the marks mean, for the foot of the page. */
export function legend(): HTMLElement {
  const signs = { started: "▮", stopped: "▮", proximities: "○", added: "+", removed: "×", changed: "–", queries: "●" };
  const list = make("ul", { class: "legend", "aria-label": "Marks of the time line" });
  for (const kind of KINDS) {
    list.append(make("li", {}, make("i", { class: kind, "aria-hidden": "true" }, signs[kind]), kind));
  }
  return list;
}
