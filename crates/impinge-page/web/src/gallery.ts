// The gallery: a card for each sample.

import { button, make } from "./dom";
import type { SampleEntry } from "./protocol";

/** In the order of the buttons. */
const FILTERS = [
  { wanted: "all", label: "All" },
  { wanted: "2", label: "2D" },
  { wanted: "3", label: "3D" },
];

/** Fills the gallery; a card is a link, so that it opens by mouse, keyboard and in a new tab. */
export function showGallery(room: HTMLElement, title: string, samples: SampleEntry[]): void {
  const cards = samples.map((sample) => ({ sample, element: card(sample) }));
  const grid = make("ul", { class: "cards" }, ...cards.map(({ element }) => element));
  const filters = make("div", { class: "modes", role: "group", "aria-label": "Dimension" });
  const count = make("p", { role: "status" });
  const choose = (wanted: string): void => {
    for (const { sample, element } of cards) element.hidden = wanted !== "all" && wanted !== String(sample.dimension);
    for (const other of filters.children)
      other.setAttribute("aria-pressed", String((other as HTMLElement).dataset.wanted === wanted));
    count.textContent = `${cards.filter(({ element }) => !element.hidden).length} of ${cards.length} samples`;
  };
  for (const { wanted, label } of FILTERS) {
    filters.append(button(label, () => choose(wanted), { "data-wanted": wanted }));
  }
  choose("all");
  const head = make(
    "div",
    { class: "head" },
    make("h1", {}, title),
    make("p", {}, LEAD),
    make("div", { class: "filter" }, filters, count),
  );
  room.replaceChildren(head, grid);
}

/** What a newcomer should know. */
const LEAD =
  "Collision detection in 2D and 3D, computed in this page. Open a sample, click its objects, drag them, and ask why they touch.";

/** The name of a sample in the address of the page, or null. */
export function sampleInAddress(): string | null {
  return new URLSearchParams(location.hash.slice(1)).get("sample");
}

/** Title, two sentences and a picture. The link covers the card. */
function card(sample: SampleEntry): HTMLElement {
  const picture = make("div", { class: "picture", "aria-hidden": "true" });
  const image = make("img", { alt: "", loading: "lazy", src: `thumbnails/${sample.name}.png` });
  // Where there is no thumbnail the dimension stands in its place.
  image.addEventListener("error", () => picture.replaceChildren(make("span", {}, `${sample.dimension}D`)));
  picture.append(image);
  const link = make("a", { href: `#sample=${encodeURIComponent(sample.name)}` }, sample.title);
  const badge = make("span", { class: "badge" }, `${sample.dimension}D`);
  return make("li", { class: "card" }, picture, make("h2", {}, link), badge, make("p", {}, sample.about));
}
