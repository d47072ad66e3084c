// Poses as matrices, written in place: no object is made for an instance.

/** Sections of a frame: seven numbers an instance, translation and unit quaternion x, y, z, w; and three, the scale. */
export interface Poses {
  pose: Float32Array;
  scale: Float32Array;
}

/** Writes the pose of an instance after its scale as a matrix in columns, from the index `to` on. */
export function writePose({ pose, scale }: Poses, instance: number, into: Float32Array, to: number): void {
  const at = 7 * instance;
  const x = pose[at + 3] ?? 0;
  const y = pose[at + 4] ?? 0;
  const z = pose[at + 5] ?? 0;
  const w = pose[at + 6] ?? 1;
  const sx = scale[3 * instance] ?? 1;
  const sy = scale[3 * instance + 1] ?? 1;
  const sz = scale[3 * instance + 2] ?? 1;
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
  into[to + 12] = pose[at] ?? 0;
  into[to + 13] = pose[at + 1] ?? 0;
  into[to + 14] = pose[at + 2] ?? 0;
  into[to + 15] = 1;
}
