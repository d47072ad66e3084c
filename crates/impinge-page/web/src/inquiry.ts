// The reader's question: the selected objects or the drawn ray. The answers are shown in the panel and the picture.

import { type Engine, EngineError } from "./engine";
import { number } from "./format";
import { sentence } from "./messages";
import { type Links, objectPanel, pairPanel, rayPanel } from "./panels";
import type { Info, Vec3 } from "./protocol";
import type { AnswerLine } from "./view";

/** A ray in the frame of the world; the direction is a unit vector. */
interface Ray {
  from: Vec3;
  direction: Vec3;
  /** The length of the ray; null if it is unbounded. */
  longest: number | null;
}

/** The number of nearest objects that the panel of an object requests; the object itself is usually one of them. */
const NEIGHBOURS = 4;

/** The current question: one or two selected objects, or a ray. */
export class Inquiry {
  /** The indices of the selected objects, at most two. */
  selected: number[] = [];
  private ray: Ray | null = null;
  /** A text that identifies the content of the panel; it is rewritten only if this text changes. */
  private written = "";

  constructor(
    private readonly engine: Engine,
    private readonly info: Info,
    private readonly panel: HTMLElement,
    private readonly changed: () => void,
  ) {}

  /** The actions of links in panels. */
  readonly links: Links = {
    object: (object) => this.set([object], null),
    pair: (a, b) => this.set([a, b], null),
  };

  /** Whether nothing is selected and no ray is drawn. */
  get empty(): boolean {
    return this.selected.length === 0 && this.ray === null;
  }

  /** Selects an object, or adds it as the second one. Null clears the selection. */
  pick(object: number | null, second: boolean): void {
    const first = this.selected[0];
    if (object === null) this.set([], null);
    else if (second && first !== undefined && first !== object) this.set([first, object], null);
    else this.set([object], null);
  }

  /** Clears the selection and the ray. */
  clear(): void {
    this.set([], null);
  }

  /** Casts a ray of length `longest` from a point; null for an unbounded ray. Does nothing if the direction is zero. */
  shoot(from: Vec3, direction: Vec3, longest: number | null): void {
    const length = Math.hypot(...direction);
    if (!(length > 0)) return;
    this.set([], { from, direction: direction.map((part) => part / length) as Vec3, longest });
  }

  /**
   * Computes the answer to the current question, for instance again after a step. Writes the panel, and returns the
   * lines to draw. If the engine rejects the question because an object is gone, the panel says so.
   */
  answer(): AnswerLine[] {
    try {
      if (this.ray) return this.answerRay(this.ray);
      const [a, b] = this.selected;
      if (a !== undefined && b !== undefined) return this.answerPair(a, b);
      if (a !== undefined) this.answerObject(a);
      else this.write("", () => []);
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      const text = sentence(error);
      this.write(text, () => [document.createTextNode(text)]);
    }
    return [];
  }

  /** Replaces the question. */
  private set(selected: number[], ray: Ray | null): void {
    this.selected = selected;
    this.ray = ray;
    this.changed();
  }

  /** Writes the panel of an object; the engine marks the object in the picture. */
  private answerObject(object: number): void {
    const answer = this.engine.object(object);
    const nearest = this.engine.nearest(answer.translation, NEIGHBOURS);
    const key = JSON.stringify([answer, nearest]);
    this.write(key, () => objectPanel(answer, nearest, this.info.dimension, this.links));
  }

  /**
   * Writes the panel of two objects. Returns a line between their nearest points with the distance, or between the
   * points of the contact with the depth if the objects overlap.
   */
  private answerPair(a: number, b: number): AnswerLine[] {
    const answer = this.engine.pair(a, b);
    this.write(JSON.stringify(answer), () => pairPanel(answer, this.info.dimension, this.links));
    const { points, contact } = answer;
    if (contact && contact.depth > 0) {
      return [{ ends: [contact.a, contact.b], kind: "distance", text: `depth ${number(contact.depth)}` }];
    }
    return points ? [{ ends: points, kind: "distance", text: number(answer.distance) }] : [];
  }

  /** Writes the panel of a ray. Returns the ray and the normals at its first hits as lines. */
  private answerRay({ from, direction, longest }: Ray): AnswerLine[] {
    const hits = this.engine.ray(from, direction, longest);
    this.write(JSON.stringify(hits), () => rayPanel(hits, this.info.dimension, this.links));
    const last = hits.at(-1);
    // An unbounded ray is drawn up to 1.1 times the time of its last hit, or with the length 1.1 without a hit.
    const drawn = longest ?? (last?.time ?? 1) * 1.1;
    const end = from.map((part, index) => part + (direction[index] ?? 0) * drawn) as Vec3;
    const ticks = hits.slice(0, 50).map((hit): AnswerLine => normalTick(hit.point, hit.normal, drawn, hit.object));
    return [{ ends: [from, end], kind: "ray" }, ...ticks];
  }

  /** Replaces the content of the panel if `key` differs from the last one. The focus stays at the same button. */
  private write(key: string, content: () => Node[]): void {
    if (key === this.written) return;
    this.written = key;
    const focus = [...this.panel.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement);
    this.panel.replaceChildren(...content());
    this.panel.hidden = key === "";
    if (focus >= 0) this.panel.querySelectorAll("button")[focus]?.focus({ preventScroll: true });
  }
}

/** Returns the normal of a hit as a short line, with the index of the hit object as its text. */
function normalTick(point: Vec3, normal: Vec3 | null, scale: number, object: number): AnswerLine {
  const length = normal ? scale * 0.04 : 0;
  const tip = point.map((part, index) => part + (normal?.[index] ?? 0) * length) as Vec3;
  return { ends: [point, tip], kind: "distance", text: String(object) };
}
