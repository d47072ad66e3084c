// Formats numbers and vectors as texts.

import type { Vec3 } from "./protocol";

/** Formats a number with at least four significant digits; very large and very small numbers have an exponent. */
export function number(value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return minus(value.toExponential(3));
  return minus(String(Number(value.toPrecision(size >= 1000 ? 6 : 4))));
}

/** Formats the first `dimension` coordinates; a dash for null. */
export function vector(value: Vec3 | null | undefined, dimension: number): string {
  if (!value) return "–";
  return value.slice(0, dimension).map(number).join(", ");
}

/** Returns a count with its noun: `1 object`, `2 objects`. */
export function counted(count: number, noun: string): string {
  return `${count.toLocaleString("en").replaceAll(",", "\u202f")} ${noun}${count === 1 ? "" : "s"}`;
}

/** Replaces hyphens by minus signs. */
function minus(text: string): string {
  return text.replaceAll("-", "\u2212");
}
