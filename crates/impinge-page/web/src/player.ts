// Time: which step is shown, whether it runs, and how fast.

import type { Engine } from "./engine";
import type { Info, Status } from "./protocol";

/** Those that the reader can choose. */
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
/** A picture that came late is caught up by at most so many steps. */
const MAX_STEPS = 16;
/** The longest time that counts between two pictures, in seconds: a page that slept does not jump. */
const MAX_PAUSE = 0.1;

/** Steps of the world against the reader's clock. */
export class Player {
  playing = false;
  /** How many seconds of the world for one of the reader's. */
  speed = 1;
  /** A live recording follows its end until the reader takes another step. */
  following: boolean;
  /** Steps that are due, a fraction of one included. */
  private owed = 0;
  /** The step that the reader chose last, until it is taken. */
  private wanted: number | null = null;
  /** The step at which a recording stands after it is opened: the world before is empty. */
  private readonly first: number;

  constructor(
    private readonly engine: Engine,
    public info: Info,
    public status: Status,
    private readonly changed: (status: Status) => void,
  ) {
    this.following = info.kind === "stream";
    this.first = info.kind === "stream" ? 1 : info.step;
  }

  /** The step that is shown, or that will be at the next picture. */
  get step(): number {
    return this.wanted ?? this.status.step;
  }

  /** Samples only go on. */
  get canSeek(): boolean {
    return this.info.kind !== "sample";
  }

  /** Nothing follows, as yet. */
  get atEnd(): boolean {
    return this.info.steps !== null && this.step >= this.info.steps;
  }

  /** Begins again at the start where the recording stands at its end. */
  toggle(): void {
    if (!this.playing && this.atEnd) this.reset();
    this.following = false;
    this.playing = !this.playing;
    this.owed = 0;
    this.changed(this.status);
  }

  /** Stops where it is. */
  pause(): void {
    this.playing = false;
    this.changed(this.status);
  }

  /** Single steps stop what runs; backwards only in recordings. */
  move(steps: number): void {
    this.playing = false;
    if (this.canSeek) this.seek(this.step + steps);
    else if (steps > 0) this.take(this.engine.advance(steps));
  }

  /** The step is taken at the next picture: of many wishes within one picture only the last counts. */
  seek(step: number): void {
    if (!this.canSeek) return;
    const last = this.info.steps ?? 0;
    this.wanted = Math.max(Math.min(this.first, last), Math.min(Math.round(step), last));
    this.following = this.info.kind === "stream" && this.wanted === last && step >= last;
  }

  /** Goes to the end and stays there while the recording grows. */
  follow(): void {
    this.playing = false;
    this.seek(Number.MAX_SAFE_INTEGER);
    this.following = this.info.kind === "stream";
  }

  /** Back to the start. */
  reset(): void {
    this.wanted = null;
    this.following = false;
    this.take(this.engine.reset());
  }

  /** So many speeds up or down the list. */
  faster(by: number): void {
    const index = SPEEDS.indexOf(this.speed) + by;
    this.speed = SPEEDS[Math.max(0, Math.min(index, SPEEDS.length - 1))] ?? 1;
    this.changed(this.status);
  }

  /** More of a live recording came. */
  grow(info: Info): void {
    this.info = info;
    if (this.following) this.follow();
  }

  /** Once for each picture, `seconds` after the one before. */
  tick(seconds: number): void {
    if (this.wanted !== null) {
      const step = this.wanted;
      this.wanted = null;
      if (step !== this.status.step) this.take(this.engine.seek(step));
    }
    if (this.playing) this.run(Math.max(0, Math.min(seconds, MAX_PAUSE)));
  }

  /** Takes the whole due steps. */
  private run(seconds: number): void {
    const step = this.info.time_step > 0 ? this.info.time_step : 1 / 60;
    this.owed += (seconds * this.speed) / step;
    const steps = Math.min(Math.floor(this.owed), MAX_STEPS);
    if (steps <= 0) return;
    this.owed = Math.min(this.owed - steps, 1);
    if (this.atEnd) {
      this.playing = false;
      this.changed(this.status);
    } else this.take(this.engine.advance(steps));
  }

  /** The engine's answer to anything that moves time or objects. */
  take(status: Status): void {
    this.status = status;
    this.changed(status);
  }
}
