// Formats numbers and vectors as texts.

import type { Vec3 } from "./protocol";

/**
 * Formats a number with four significant digits, or six from 1000 on, without trailing zeros. Magnitudes below 1e-4 or
 * from 1e7 on have an exponent. Null and undefined become a dash.
 */
export function number(value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return minus(value.toExponential(3));
  return minus(String(Number(value.toPrecision(size >= 1000 ? 6 : 4))));
}

/** Formats the first `dimension` coordinates. Null and undefined become a dash. */
export function vector(value: Vec3 | null | undefined, dimension: number): string {
  if (!value) return "–";
  return value.slice(0, dimension).map(number).join(", ");
}

/** Returns a count with its noun, such as `1 object` or `2 objects`. Thin spaces separate thousands. */
export function counted(count: number, noun: string): string {
  return `${count.toLocaleString("en").replaceAll(",", "\u202f")} ${noun}${count === 1 ? "" : "s"}`;
}

/** Replaces hyphens by minus signs. */
function minus(text: string): string {
  return text.replaceAll("-", "\u2212");
}
