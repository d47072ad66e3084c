// The player: the shown step, whether time runs, and its speed.

import type { Engine } from "./engine";
import type { Info, Status } from "./protocol";

/** The speeds that the reader can choose. */
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
/** The maximum number of steps before one picture, with which a late picture catches up. */
const MAX_STEPS = 16;
/** The maximum time between two pictures that counts, in seconds: after a pause of the page the world does not jump. */
const MAX_PAUSE = 0.1;

/** Converts the reader's time to steps of the world. */
export class Player {
  playing = false;
  /** The speed: seconds of the world per second of the reader. */
  speed = 1;
  /**
   * Whether the player follows the end of a live recording. It stops following when the reader chooses another step.
   */
  following: boolean;
  /** The number of steps that are due, including a fraction. */
  private owed = 0;
  /** The step that the reader chose last, until it is shown. */
  private wanted: number | null = null;
  /** The first step that can be shown: 1 for a recording, whose world is empty before; 0 for a sample. */
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

  /** The step of the next picture: the step that the reader has chosen, else the shown step. */
  get step(): number {
    return this.wanted ?? this.status.step;
  }

  /** Whether time can go back: only in recordings, complete or growing. */
  get canSeek(): boolean {
    return this.info.kind !== "sample";
  }

  /** Whether the shown step is the last one that is known. */
  get atEnd(): boolean {
    return this.info.steps !== null && this.step >= this.info.steps;
  }

  /** Starts or stops time. If a recording is at its end, starts again from its first step. */
  toggle(): void {
    if (!this.playing && this.atEnd) this.reset();
    this.following = false;
    this.playing = !this.playing;
    this.owed = 0;
    this.changed(this.status);
  }

  /** Stops time at the shown step. A live recording that grows is no longer followed, and a chosen step is dropped. */
  pause(): void {
    this.playing = false;
    this.following = false;
    this.wanted = null;
    this.changed(this.status);
  }

  /** Stops time and goes by `steps` steps. A negative number goes back in recordings, and does nothing in samples. */
  move(steps: number): void {
    this.playing = false;
    if (this.canSeek) this.seek(this.step + steps);
    else if (steps > 0) this.take(this.engine.advance(steps));
  }

  /**
   * Chooses the step of the next picture; does nothing in samples. Of several calls before that picture, only the last
   * counts.
   */
  seek(step: number): void {
    if (!this.canSeek) return;
    const last = this.info.steps ?? 0;
    this.wanted = Math.max(Math.min(this.first, last), Math.min(Math.round(step), last));
    this.following = this.info.kind === "stream" && this.wanted === last && step >= last;
  }

  /** Goes to the end of a recording. If it grows, follows its end from now on. */
  follow(): void {
    this.playing = false;
    this.seek(Number.MAX_SAFE_INTEGER);
    this.following = this.info.kind === "stream";
  }

  /** Goes back to the start. */
  reset(): void {
    this.wanted = null;
    this.following = false;
    this.take(this.engine.reset());
  }

  /** Moves by `by` places in the list of speeds. */
  faster(by: number): void {
    const index = SPEEDS.indexOf(this.speed) + by;
    this.speed = SPEEDS[Math.max(0, Math.min(index, SPEEDS.length - 1))] ?? 1;
    this.changed(this.status);
  }

  /** Takes over the description of a live recording that has grown. */
  grow(info: Info): void {
    this.info = info;
    if (this.following) this.follow();
  }

  /**
   * Goes to the chosen step and advances time, before each picture. `seconds` is the time since the previous picture.
   */
  tick(seconds: number): void {
    if (this.wanted !== null) {
      const step = this.wanted;
      this.wanted = null;
      if (step !== this.status.step) this.take(this.engine.seek(step));
    }
    if (this.playing) this.run(Math.max(0, Math.min(seconds, MAX_PAUSE)));
  }

  /** Advances by the whole steps that are due after `seconds`. At the end of a recording, stops time. */
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

  /** Takes over the engine's answer to any message that moves time or objects. */
  take(status: Status): void {
    this.status = status;
    this.changed(status);
  }
}
