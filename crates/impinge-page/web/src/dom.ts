// Functions that create elements. Texts, for example from recordings, are set as text and never parsed as HTML.

type Attributes = Record<string, string | number | boolean | null>;
type Child = Node | string;

/** Returns an element with attributes and children. `true` sets an empty attribute, `false` and `null` none. */
export function make<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === false || value === null) continue;
    element.setAttribute(key, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

/** Returns a button that calls `act` when it is pressed by pointer or key. */
export function button(label: string, act: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const element = make("button", { type: "button", ...attributes }, label);
  element.addEventListener("click", act);
  return element;
}

/** Returns the element of the template with this id. */
export function byId<Kind extends HTMLElement = HTMLElement>(id: string): Kind {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the template has no element #${id}`);
  return element as Kind;
}

/** Sets a text if it differs, so that assistive technology does not announce it again. */
export function setText(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Returns a list of terms and their values. */
export function terms(rows: [string, Child][]): HTMLElement {
  const list = make("dl");
  for (const [term, value] of rows) list.append(make("dt", {}, term), make("dd", {}, value));
  return list;
}
