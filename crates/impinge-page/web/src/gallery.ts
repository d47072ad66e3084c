// The gallery: a card for each sample.

import { button, make, setText } from "./dom";
import type { SampleEntry } from "./protocol";

/** The filters by dimension, in the order of their buttons. */
const FILTERS = [
  { wanted: "all", label: "All" },
  { wanted: "2", label: "2D" },
  { wanted: "3", label: "3D" },
];

/** The introduction above the cards. */
const LEAD =
  "Collision detection in 2D and 3D, computed in this page. Open a sample, click its objects, drag them, and ask why they touch.";

/** Fills the gallery. A card is a link, so it can be opened by mouse, by keyboard and in a new tab. */
export function showGallery(container: HTMLElement, title: string, samples: SampleEntry[]): void {
  const cards = samples.map((sample) => ({ sample, element: card(sample) }));
  const filters = make("div", { class: "modes", role: "group", "aria-label": "Dimension" });
  const search = make("input", { type: "search", placeholder: "Search", "aria-label": "Search the samples" });
  const count = make("p", { role: "status" });
  let wanted = "all";
  const update = (): void => {
    const words = search.value.toLowerCase().split(/\s+/);
    for (const { sample, element } of cards) element.hidden = !matches(sample, wanted, words);
    const shown = cards.filter(({ element }) => !element.hidden).length;
    setText(count, `${shown} of ${cards.length} samples`);
    for (const other of filters.querySelectorAll("button"))
      other.setAttribute("aria-pressed", String(other.dataset.wanted === wanted));
  };
  for (const filter of FILTERS) {
    const choose = (): void => {
      wanted = filter.wanted;
      update();
    };
    filters.append(button(filter.label, choose, { "data-wanted": filter.wanted }));
  }
  search.addEventListener("input", update);
  update();
  container.replaceChildren(
    make("h1", {}, title),
    make("p", { class: "lead" }, LEAD),
    make("div", { class: "filter" }, filters, search, count),
    make("ul", { class: "cards" }, ...cards.map(({ element }) => element)),
  );
}

/** Returns the name of the sample in the address of the page, or null. */
export function sampleInAddress(): string | null {
  return new URLSearchParams(location.hash.slice(1)).get("sample");
}

/** Returns whether the sample has the wanted dimension, and its texts contain all words. */
function matches({ name, title, about, dimension }: SampleEntry, wanted: string, words: string[]): boolean {
  const text = `${name} ${title} ${about}`.toLowerCase();
  return (wanted === "all" || wanted === String(dimension)) && words.every((word) => text.includes(word));
}

/** Returns a card: a picture, a title and a few sentences. The link covers the card. */
function card({ name, title, about, dimension }: SampleEntry): HTMLElement {
  const picture = make("div", { class: "picture", "aria-hidden": "true" });
  const image = make("img", { alt: "", loading: "lazy", src: `thumbnails/${name}.png` });
  // A page without its folder has no thumbnails: then only the badge is shown.
  image.addEventListener("error", () => image.remove());
  picture.append(image, make("span", { class: "badge" }, `${dimension}D`));
  const link = make("a", { href: `#sample=${encodeURIComponent(name)}` }, title);
  return make("li", { class: "card" }, picture, make("h2", {}, link), make("p", {}, about));
}
