// The answers as text: the description of an object, the state of a pair with its reasons, the hits of a ray.

import { button, make, terms } from "./dom";
import { counted, number, vector } from "./format";
import type {
  Groups,
  NearAnswer,
  ObjectAnswer,
  ObjectPair,
  PairAnswer,
  PairEvent,
  RayHit,
  Readout,
  Status,
} from "./protocol";

/** The maximum number of events in a panel. */
const MAX_EVENTS = 60;

/** The actions of links in the panels. */
export interface Links {
  object(object: number): void;
  pair(a: number, b: number): void;
}

/** Returns the panel of an object, with its pairs and the nearest other objects. */
export function objectPanel(
  answer: ObjectAnswer,
  nearest: NearAnswer["nearest"],
  dimension: number,
  links: Links,
): Node[] {
  const { object, label, shape, groups, query } = answer;
  const rows: [string, Node | string][] = [
    ["handle", String(object)],
    ["shape", shape.text],
    ["position", vector(answer.translation, dimension)],
    ["rotation", rotation(answer, dimension)],
    ["query", queryText(query)],
    ...groupRows(groups),
  ];
  if (label) rows.unshift(["label", label]);
  return [
    heading(`Object ${object}`),
    terms(rows),
    subheading(counted(answer.pairs.length, "pair")),
    list(answer.pairs.map((pair) => pairLink(object, pair, links))),
    ...near(object, nearest, links),
  ];
}

/** Returns the panel of two objects. */
export function pairPanel(answer: PairAnswer, dimension: number, links: Links): Node[] {
  const { a, b, contact, why } = answer;
  const rows: [string, string][] = [
    ["distance", number(answer.distance)],
    ["proximity", answer.proximity ?? "not asked for"],
    ["contact", contact ? `depth ${number(contact.depth)}` : "none within the prediction"],
  ];
  if (contact) rows.push(["normal", vector(contact.normal, dimension)]);
  if (answer.points) {
    rows.push([`point on ${a}`, vector(answer.points[0], dimension)]);
    rows.push([`point on ${b}`, vector(answer.points[1], dimension)]);
  }
  const title = make(
    "h2",
    {},
    "Pair of ",
    link(String(a), () => links.object(a)),
    " and ",
    link(String(b), () => links.object(b)),
  );
  const count = answer.manifolds.reduce((sum, { contacts }) => sum + contacts.length, 0);
  return [
    title,
    make("p", { class: why.touch ? "result touch" : "result apart" }, why.text),
    tests(answer),
    terms(rows),
    ...(count > 0 ? [subheading(`${counted(answer.manifolds.length, "manifold")}, ${counted(count, "contact")}`)] : []),
    ...(count > 0 ? [manifolds(answer, dimension)] : []),
  ];
}

/** Returns the panel of a ray; hits are in order of time. */
export function rayPanel(hits: RayHit[], dimension: number, links: Links): Node[] {
  const rows = hits.map((hit) => {
    const text = `at ${number(hit.time)} · ${vector(hit.point, dimension)}`;
    const feature = hit.feature ? ` · ${hit.feature}` : "";
    return make(
      "li",
      {},
      link(`object ${hit.object}`, () => links.object(hit.object)),
      ` ${text}${feature}`,
    );
  });
  return [
    heading("Ray"),
    make("p", { class: "result" }, hits.length === 0 ? "It hits nothing." : counted(hits.length, "hit")),
    list(rows),
  ];
}

/** Returns the list of the events of the shown step. */
export function eventList({ events, event_count: count }: Status, links: Links): HTMLElement {
  const shown = events.slice(0, MAX_EVENTS);
  const rows = list(
    shown.map((event) => {
      const open = link(eventText(event), () => links.pair(event.a, event.b));
      return make("li", { class: sign(event) }, open);
    }),
  );
  if (count > shown.length) rows.append(make("li", {}, `${count - shown.length} more`));
  return rows;
}

/** Returns an event in words, for the panel and the summary. */
export function eventText(event: PairEvent): string {
  if (event.kind === "contact") {
    return `contact of ${event.a} and ${event.b} ${event.started ? "started" : "stopped"}`;
  }
  return `proximity of ${event.a} and ${event.b}: ${event.before} to ${event.after}`;
}

/** Returns the list of numbers and words that a sample computes. */
export function readoutList(readouts: Readout[]): HTMLElement {
  return terms(readouts.map(({ label, value }) => [label, value]));
}

/** Returns a button that looks like a link: it changes the selection, not the address. */
export function link(text: string, act: () => void): HTMLButtonElement {
  return button(text, act, { class: "link" });
}

/** Returns the class of an event, which gives it a sign and a colour. */
function sign(event: PairEvent): string {
  if (event.kind === "contact") return event.started ? "started" : "stopped";
  return "proximity";
}

/**
 * Returns a list of the nearest other objects, with their distances from the origin of this object. Empty if there are
 * no other objects.
 */
function near(object: number, nearest: NearAnswer["nearest"], links: Links): Node[] {
  const others = nearest.filter((other) => other.object !== object);
  if (others.length === 0) return [];
  const rows = others.map((other) => {
    const open = link(`${object} and ${other.object}`, () => links.pair(object, other.object));
    return make("li", {}, open, ` ${number(other.distance)} from its origin`);
  });
  return [subheading("Nearest objects"), list(rows)];
}

/** Returns all tests with their results, including those after a test that fails. */
function tests({ why }: PairAnswer): HTMLElement {
  const rows = why.tests.map(({ name, passes, text }) => {
    const mark = make("b", { role: "img", "aria-label": passes ? "passes" : "fails" }, passes ? "✓" : "✗");
    return make("li", { class: passes ? "pass" : "fail" }, mark, make("strong", {}, name), make("span", {}, text));
  });
  return make("ul", { class: "tests", "aria-label": "Why" }, ...rows);
}

/** Returns the contacts of all manifolds in their order. */
function manifolds({ manifolds }: PairAnswer, dimension: number): HTMLElement {
  const contacts = manifolds.flatMap((manifold) => manifold.contacts);
  return list(
    contacts.map((contact) => {
      const features = contact.features ? ` · ${contact.features}` : "";
      return make("li", {}, `depth ${number(contact.depth)} at ${vector(contact.a, dimension)}${features}`);
    }),
  );
}

/** Returns a list item with the state of a pair and a link to it; touching pairs are marked. */
function pairLink(object: number, pair: ObjectPair, links: Links): HTMLElement {
  const open = link(`${object} and ${pair.object}`, () => links.pair(object, pair.object));
  return make("li", { class: pair.touching ? "touch" : "" }, open, ` ${pairText(pair)}`);
}

/** Returns the state of a pair in a line. */
function pairText(pair: ObjectPair): string {
  if (pair.status !== undefined) return `${pair.kind}: ${pair.status}`;
  const contacts = counted(pair.contacts ?? 0, "contact");
  return pair.depth === null || pair.depth === undefined ? contacts : `${contacts}, depth ${number(pair.depth)}`;
}

/** Formats the rotation of an object as an angle in degrees: counterclockwise in 2D, with the axis in 3D. */
function rotation({ rotation: [x, y, z, w] }: ObjectAnswer, dimension: number): string {
  if (dimension === 2) return `${number((2 * Math.atan2(z, w) * 180) / Math.PI)}°`;
  const sine = Math.hypot(x, y, z);
  const angle = `${number((2 * Math.atan2(sine, Math.abs(w)) * 180) / Math.PI)}°`;
  if (sine < 1e-9) return angle;
  const turn = Math.sign(w || 1) / sine;
  return `${angle} about ${vector([x * turn, y * turn, z * turn], 3)}`;
}

/** Returns the query type of an object with its limits. */
function queryText(query: ObjectAnswer["query"]): string {
  const numbers = Object.entries(query).filter(([name]) => name !== "kind");
  return [query.kind, ...numbers.map(([name, value]) => `${name} ${number(value as number)}`)].join(", ");
}

/** Returns rows with the numbers of the groups in each list, and a row about self-collision if it is enabled. */
function groupRows(groups: Groups): [string, string][] {
  const text = (value: number[] | "all"): string => {
    if (value === "all") return "all";
    return value.length === 0 ? "none" : value.join(", ");
  };
  const rows: [string, string][] = [
    ["membership", text(groups.membership)],
    ["whitelist", text(groups.whitelist)],
    ["blacklist", text(groups.blacklist)],
  ];
  return groups.self_collision ? [...rows, ["self-collision", "yes"]] : rows;
}

function heading(text: string): HTMLElement {
  return make("h2", {}, text);
}

function subheading(text: string): HTMLElement {
  return make("h3", {}, text);
}

function list(rows: HTMLElement[]): HTMLElement {
  return make("ul", { class: "rows" }, ...rows);
}
