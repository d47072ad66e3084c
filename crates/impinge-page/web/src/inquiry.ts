// The reader's questions: what is selected, which ray is drawn, and the answers in panel and picture.

import { type Engine, EngineError } from "./engine";
import { number } from "./format";
import { sentence } from "./messages";
import { type Links, objectPanel, pairPanel, rayPanel } from "./panels";
import type { Info, Vec3 } from "./protocol";
import type { AnswerLine } from "./view";

/** In the world's coordinates; the direction is a unit vector. */
interface Ray {
  from: Vec3;
  direction: Vec3;
  /** A length; null for a ray without an end. */
  longest: number | null;
}

/** Neighbours that the panel of an object lists, with the object itself. */
const NEIGHBOURS = 4;

/** Either objects are selected or a ray is drawn. */
export class Inquiry {
  /** At most two objects. */
  selected: number[] = [];
  private ray: Ray | null = null;
  /** What the panel was written from. */
  private written = "";

  constructor(
    private readonly engine: Engine,
    private readonly info: Info,
    private readonly panel: HTMLElement,
    private readonly changed: () => void,
  ) {}

  /** What links of panels do. */
  readonly links: Links = {
    object: (object) => this.set([object], null),
    pair: (a, b) => this.set([a, b], null),
  };

  /** Nothing is asked. */
  get empty(): boolean {
    return this.selected.length === 0 && this.ray === null;
  }

  /** Selects an object, or adds it as the second one; nothing clears the selection. */
  pick(object: number | null, second: boolean): void {
    const first = this.selected[0];
    if (object === null) this.set([], null);
    else if (second && first !== undefined && first !== object) this.set([first, object], null);
    else this.set([object], null);
  }

  /** Ends the question. */
  clear(): void {
    this.set([], null);
  }

  /** A ray from a point; `longest` is a length, since the direction is made a unit vector. */
  shoot(from: Vec3, direction: Vec3, longest: number | null): void {
    const length = Math.hypot(...direction);
    if (!(length > 0)) return;
    this.set([], { from, direction: direction.map((part) => part / length) as Vec3, longest });
  }

  /** Asks again, since time or objects moved. Returns the lines that answer; objects that are gone end the question. */
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

  /** Another question. */
  private set(selected: number[], ray: Ray | null): void {
    this.selected = selected;
    this.ray = ray;
    this.changed();
  }

  /** The panel alone: the engine marks the object in the picture. */
  private answerObject(object: number): void {
    const answer = this.engine.object(object);
    const nearest = this.engine.nearest(answer.translation, NEIGHBOURS);
    const key = JSON.stringify([answer, nearest]);
    this.write(key, () => objectPanel(answer, nearest, this.info.dimension, this.links));
  }

  /** A line from point to point with its length; of objects that overlap, with the depth. */
  private answerPair(a: number, b: number): AnswerLine[] {
    const answer = this.engine.pair(a, b);
    this.write(JSON.stringify(answer), () => pairPanel(answer, this.info.dimension, this.links));
    const { points, contact } = answer;
    if (contact && contact.depth > 0) {
      return [{ ends: [contact.a, contact.b], kind: "distance", text: `depth ${number(contact.depth)}` }];
    }
    return points ? [{ ends: points, kind: "distance", text: number(answer.distance) }] : [];
  }

  /** The ray, and at each hit its normal. */
  private answerRay({ from, direction, longest }: Ray): AnswerLine[] {
    const hits = this.engine.ray(from, direction, longest);
    this.write(JSON.stringify(hits), () => rayPanel(hits, this.info.dimension, this.links));
    const last = hits.at(-1);
    // A ray without an end is drawn up to its last hit, and a little beyond.
    const drawn = longest ?? (last?.time ?? 1) * 1.1;
    const end = from.map((part, index) => part + (direction[index] ?? 0) * drawn) as Vec3;
    const ticks = hits.slice(0, 50).map((hit): AnswerLine => normalTick(hit.point, hit.normal, drawn, hit.object));
    return [{ ends: [from, end], kind: "ray" }, ...ticks];
  }

  /** Writes the panel where it differs, so that what has the focus stays as long as it can. */
  private write(key: string, content: () => Node[]): void {
    if (key === this.written) return;
    this.written = key;
    const focus = [...this.panel.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement);
    this.panel.replaceChildren(...content());
    this.panel.hidden = key === "";
    if (focus >= 0) this.panel.querySelectorAll("button")[focus]?.focus({ preventScroll: true });
  }
}

/** The normal of a hit as a short line, named by the object. */
function normalTick(point: Vec3, normal: Vec3 | null, scale: number, object: number): AnswerLine {
  const length = normal ? scale * 0.04 : 0;
  const tip = point.map((part, index) => part + (normal?.[index] ?? 0) * length) as Vec3;
  return { ends: [point, tip], kind: "distance", text: String(object) };
}
