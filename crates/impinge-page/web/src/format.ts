// Numbers and vectors as people read them.

import type { Vec3 } from "./protocol";

/** Four significant digits; very large and very small numbers with an exponent. */
export function number(value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return minus(value.toExponential(3));
  return minus(String(Number(value.toPrecision(size >= 1000 ? 6 : 4))));
}

/** As many coordinates as there are dimensions; a dash for none. */
export function vector(value: Vec3 | null | undefined, dimension: number): string {
  if (!value) return "–";
  return value.slice(0, dimension).map(number).join(", ");
}

/** `1 object`, `2 objects`. */
export function counted(count: number, noun: string): string {
  return `${count.toLocaleString("en").replaceAll(",", "\u202f")} ${noun}${count === 1 ? "" : "s"}`;
}

/** The sign of mathematics instead of a hyphen. */
function minus(text: string): string {
  return text.replaceAll("-", "\u2212");
}
