// The foot of the page: play, single steps, speed, and the time line.

import { button, make, setText } from "./dom";
import { type Player, SPEEDS } from "./player";
import { legend, Timeline } from "./timeline";

export class Transport {
  /** The time line; hidden for samples, which have no length. */
  readonly timeline: Timeline;
  private readonly play: HTMLButtonElement;
  /** The button that is pressed while the end of a live recording is followed. */
  private readonly live: HTMLButtonElement;
  /** The current step, and the last step of a recording. */
  private readonly counter = make("output", { class: "counter" });
  private readonly speed = make("select", { "aria-label": "Speed" });

  constructor(
    private readonly foot: HTMLElement,
    private readonly player: Player,
  ) {
    this.timeline = new Timeline((step) => player.seek(step));
    this.play = button("", () => player.toggle(), { class: "play" });
    this.live = button("Live", () => player.follow(), { class: "live", title: "Follow the end of the recording" });
    for (const speed of SPEEDS) this.speed.append(make("option", { value: speed }, `${speed}×`));
    this.speed.addEventListener("change", () => {
      player.speed = Number(this.speed.value);
    });
    this.layout();
    this.grow();
  }

  /** Shows the player's state. */
  update(): void {
    const { player } = this;
    setText(this.play, player.playing ? "❚❚" : "▶");
    this.play.setAttribute("aria-label", player.playing ? "Pause" : "Play");
    this.play.title = `${player.playing ? "Pause" : "Play"} (space)`;
    this.speed.value = String(player.speed);
    this.live.setAttribute("aria-pressed", String(player.following));
    const last = player.info.steps;
    setText(this.counter, last === null ? String(player.step) : `${player.step} / ${last}`);
    if (player.canSeek) this.timeline.setStep(player.step);
  }

  /** Takes over the length and the marks of a recording that has grown. */
  grow(): void {
    const { steps, marks } = this.player.info;
    if (steps !== null) this.timeline.setMarks(steps, marks);
    this.update();
  }

  /** Shows that the stream of a live recording has ended. */
  ended(): void {
    setText(this.live, "Ended");
    this.live.title = "The recording has ended; show its last step";
  }

  /** Arranges the elements. Samples have no time line and cannot go back. */
  private layout(): void {
    const { player } = this;
    const back = button("|◀", () => player.reset(), { "aria-label": "To the start", title: "To the start (Home)" });
    const less = button("−1", () => player.move(-1), { "aria-label": "One step back", title: "One step back (←)" });
    const more = button("+1", () => player.move(1), { "aria-label": "One step on", title: "One step on (→)" });
    const buttons = make("div", { class: "buttons" }, back);
    if (player.canSeek) buttons.append(less);
    buttons.append(this.play, more);
    if (player.info.kind === "stream") buttons.append(this.live);
    const parts = [buttons, make("label", { class: "time" }, make("span", {}, "Step "), this.counter), this.speed];
    this.foot.replaceChildren(...parts, ...(player.canSeek ? [this.timeline.element, legend()] : []));
    this.foot.classList.toggle("short", !player.canSeek);
  }
}
