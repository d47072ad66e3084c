// Colours. The engine writes sRGB bytes; three.js shades in linear light and converts back when it writes a pixel.

import { Color, SRGBColorSpace } from "three";

const scratch = new Color();

/** The linear light of each byte of an sRGB colour, as a table: a frame converts three bytes per instance. */
export const LINEAR = Float32Array.from(
  { length: 256 },
  (_, byte) => scratch.setRGB(byte / 255, 0, 0, SRGBColorSpace).r,
);

/** Converts a colour of the engine, with red in the lowest byte, to an opaque colour of CSS. */
export function css(color: number): string {
  const [red, green, blue] = [color & 255, (color >>> 8) & 255, (color >>> 16) & 255];
  return `rgb(${red} ${green} ${blue})`;
}

/** Returns the sRGB bytes red, green, blue of a colour of the style sheet. */
export function bytesOf(text: string): number[] {
  const hex = scratch.set(text).getHex();
  return [hex >>> 16, (hex >>> 8) & 255, hex & 255];
}
