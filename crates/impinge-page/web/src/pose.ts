// Poses as matrices, written in place: no object is made for an instance.

import type { Vec3 } from "./protocol";

/** Writes seven numbers, a translation and a unit quaternion x, y, z, w, after a scale, as a matrix in columns. */
export function writePose(from: Float32Array, at: number, [sx, sy, sz]: Vec3, into: Float32Array, to: number): void {
  const x = from[at + 3] ?? 0;
  const y = from[at + 4] ?? 0;
  const z = from[at + 5] ?? 0;
  const w = from[at + 6] ?? 1;
  into[to] = sx * (1 - 2 * (y * y + z * z));
  into[to + 1] = sx * (2 * (x * y + w * z));
  into[to + 2] = sx * (2 * (x * z - w * y));
  into[to + 3] = 0;
  into[to + 4] = sy * (2 * (x * y - w * z));
  into[to + 5] = sy * (1 - 2 * (x * x + z * z));
  into[to + 6] = sy * (2 * (y * z + w * x));
  into[to + 7] = 0;
  into[to + 8] = sz * (2 * (x * z + w * y));
  into[to + 9] = sz * (2 * (y * z - w * x));
  into[to + 10] = sz * (1 - 2 * (x * x + y * y));
  into[to + 11] = 0;
  into[to + 12] = from[at] ?? 0;
  into[to + 13] = from[at + 1] ?? 0;
  into[to + 14] = from[at + 2] ?? 0;
  into[to + 15] = 1;
}
