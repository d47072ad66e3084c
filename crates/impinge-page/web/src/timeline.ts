// The time line: a slider over the steps, in front of marks at the steps that have changes.
//
// The slider is an input element, so the browser supports pointer, touch and assistive technology. Its thumb is as wide
// as both margins of the marks together, so the middle of the thumb is at the mark of its step.

import { make } from "./dom";
import type { Mark } from "./protocol";

/** The width of a bin in CSS pixels; the marks in a bin are drawn as one. */
const BIN = 4;
/** The margin at the left and right of the marks: half the width of the thumb, which is in the style sheet. */
const PAD = 10;
/** The height in CSS pixels; the style sheet has the same value. */
const HEIGHT = 58;
/**
 * The distances of the rows from the top in CSS pixels: `changed` has added, removed and changed objects, `queries` has
 * queries and proximities. Started and stopped contacts are bars above and below `track`.
 */
const ROWS = { changed: 8, track: HEIGHT / 2, queries: 50 };
/** The length of the longest bar in CSS pixels. */
const BAR = 13;

/** The kinds of marks in the order of the legend. */
const KINDS = ["started", "stopped", "proximities", "added", "removed", "changed", "queries"] as const;
/** The number of changes of each kind. */
type Counts = Record<(typeof KINDS)[number], number>;
const NOTHING = Object.fromEntries(KINDS.map((kind) => [kind, 0])) as Counts;

export class Timeline {
  readonly element = make("div", { class: "timeline" });
  private readonly canvas = make("canvas", { "aria-hidden": "true" });
  private readonly slider = make("input", { type: "range", min: 0, step: 1, value: 0, "aria-label": "Step" });
  private readonly tip = make("span", { class: "tip", "aria-hidden": "true", hidden: true });
  /** The sum of the marks in each bin of the track. */
  private bins = new Map<number, Counts>();
  /** The marks in order of the steps. */
  private marks: Mark[] = [];
  private steps = 0;

  constructor(seek: (step: number) => void) {
    this.element.append(this.canvas, this.slider, this.tip);
    this.slider.addEventListener("input", () => seek(this.slider.valueAsNumber));
    this.element.addEventListener("pointermove", (event) => this.hover(event));
    this.element.addEventListener("pointerleave", () => (this.tip.hidden = true));
    new ResizeObserver(() => this.layout()).observe(this.element);
  }

  /** Sets the number of steps and the marks; called again when a live recording has grown. */
  setMarks(steps: number, marks: Mark[]): void {
    this.steps = steps;
    this.marks = marks;
    this.slider.max = String(steps);
    this.layout();
  }

  /** Moves the thumb to a step. */
  setStep(step: number): void {
    this.slider.valueAsNumber = step;
    this.slider.setAttribute("aria-valuetext", `step ${step} of ${this.steps}`);
    this.slider.style.setProperty("--played", String(this.part(step)));
  }

  /** Returns the step of the next (1) or previous (-1) mark; null if there is none. */
  neighbour(step: number, direction: 1 | -1): number | null {
    const found =
      direction > 0 ? this.marks.find((mark) => mark.step > step) : this.marks.findLast((mark) => mark.step < step);
    return found?.step ?? null;
  }

  /** Draws the marks in the colours of the style sheet. */
  draw(): void {
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const density = window.devicePixelRatio;
    context.setTransform(density, 0, 0, density, 0, 0);
    context.clearRect(0, 0, this.width, HEIGHT);
    const style = getComputedStyle(this.element);
    const color = (name: string): string => style.getPropertyValue(`--${name}`).trim();
    for (const [bin, counts] of this.bins) drawMark(context, PAD + (bin + 0.5) * BIN, counts, color);
  }

  private get width(): number {
    return this.element.clientWidth;
  }

  /** Returns the position of a step on the track, from 0 at step 0 to 1 at the last step. */
  private part(step: number): number {
    return this.steps === 0 ? 0 : step / this.steps;
  }

  /** Returns the distance of a step from the left end of the track, in CSS pixels. */
  private x(step: number): number {
    return this.part(step) * (this.width - 2 * PAD);
  }

  private binOf(step: number): number {
    return Math.floor(this.x(step) / BIN);
  }

  /** Adds up the marks in each bin, so that the cost of drawing depends only on the width. */
  private layout(): void {
    const density = window.devicePixelRatio;
    this.canvas.width = Math.round(this.width * density);
    this.canvas.height = Math.round(HEIGHT * density);
    this.bins = new Map();
    for (const mark of this.marks) {
      const bin = this.binOf(mark.step);
      const sum = this.bins.get(bin) ?? { ...NOTHING };
      for (const kind of KINDS) sum[kind] += mark[kind];
      this.bins.set(bin, sum);
    }
    this.draw();
  }

  /** Shows the step under the pointer, and the marks in its bin. */
  private hover(event: PointerEvent): void {
    const part = (event.clientX - this.element.getBoundingClientRect().left - PAD) / (this.width - 2 * PAD);
    const step = Math.round(Math.max(0, Math.min(part, 1)) * this.steps);
    this.tip.hidden = false;
    this.tip.textContent = [`step ${step}`, ...this.happened(step)].join(" · ");
    const half = this.tip.offsetWidth / 2;
    this.tip.style.left = `${Math.max(half, Math.min(PAD + this.x(step), this.width - half))}px`;
  }

  /** Returns the marks in the bin of a step, in words. */
  private happened(step: number): string[] {
    const counts = this.bins.get(this.binOf(step));
    if (!counts) return [];
    return KINDS.filter((kind) => counts[kind] > 0).map((kind) => describe(kind, counts[kind]));
  }
}

/** Returns the count of a kind in words. */
function describe(kind: (typeof KINDS)[number], count: number): string {
  if (kind === "queries") return count === 1 ? "1 query" : `${count} queries`;
  if (kind === "proximities") return count === 1 ? "1 proximity" : `${count} proximities`;
  return `${count} ${kind}`;
}

/** Draws the signs of a bin. They differ in form and place, not only in colour. */
function drawMark(context: CanvasRenderingContext2D, x: number, counts: Counts, color: (name: string) => string): void {
  context.lineCap = "butt";
  context.lineWidth = BIN - 1;
  // The length is 4 for a count of one, and grows with the logarithm of the count up to a count of eight.
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

/** Draws the sign of queries. */
function disc(context: CanvasRenderingContext2D, x: number, color: string): void {
  context.beginPath();
  context.arc(x, ROWS.queries, 2.5, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
}

/** Draws the sign of changed proximities. */
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

/** Returns the list of the signs with their meanings, for the foot of the page. */
export function legend(): HTMLElement {
  const signs = { started: "▮", stopped: "▮", proximities: "○", added: "+", removed: "×", changed: "–", queries: "●" };
  const list = make("ul", { class: "legend", "aria-label": "Marks of the time line" });
  for (const kind of KINDS) {
    list.append(make("li", {}, make("i", { class: kind, "aria-hidden": "true" }, signs[kind]), kind));
  }
  return list;
}
