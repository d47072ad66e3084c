// Colours: bytes as the engine gives them, and the linear light in which is shaded.

/** The linear light of each byte of an sRGB colour. */
export const LINEAR = Float32Array.from({ length: 256 }, (_, byte) => {
  const part = byte / 255;
  return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
});

/** A colour of the engine, red in the lowest byte, as CSS writes it. */
export function css(color: number): string {
  const [red, green, blue] = [color & 255, (color >>> 8) & 255, (color >>> 16) & 255];
  return `rgb(${red} ${green} ${blue})`;
}

/** What the page itself draws: answers to the reader's questions. */
export const ANSWER = { distance: "#0b7285", distanceDark: "#66d9e8", ray: "#1864ab", rayDark: "#74c0fc" };
