// Buffers of the graphics memory that are refilled for each frame. They grow by doubling and never shrink. Only the
// part in use is uploaded.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, type InterleavedBuffer } from "three";

/** Marks the first `numbers` numbers of a buffer for upload before the next picture. */
export function upload(buffer: BufferAttribute | InterleavedBuffer, numbers: number): void {
  buffer.clearUpdateRanges();
  buffer.addUpdateRange(0, numbers);
  buffer.needsUpdate = true;
}

/**
 * Returns a capacity for `count` elements: `capacity` if it suffices, else at least twice as much, so that buffers
 * seldom grow.
 */
export function grown(capacity: number, count: number): number {
  return count <= capacity ? capacity : Math.max(count, 2 * capacity, 64);
}

/** The attributes of a geometry without indices. */
export class Buffers {
  readonly geometry = new BufferGeometry();
  /** The number of vertices for which the buffers have space. */
  private capacity = 0;

  /** `sizes` has the number of components of each attribute. */
  constructor(private readonly sizes: Record<string, number>) {
    this.reserve(1);
  }

  /**
   * Reserves space for `count` vertices. If the buffers grow, their content is lost; each frame writes all vertices.
   */
  reserve(count: number): void {
    const capacity = grown(this.capacity, count);
    if (capacity === this.capacity) return;
    this.capacity = capacity;
    // An attribute cannot grow in the graphics memory. Disposing of the geometry frees the old attributes there.
    this.geometry.dispose();
    for (const [name, size] of Object.entries(this.sizes)) {
      const attribute = new BufferAttribute(new Float32Array(size * capacity), size);
      this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
  }

  /** Returns the numbers of an attribute, to be written in place. */
  array(name: string): Float32Array {
    return this.geometry.getAttribute(name).array as Float32Array;
  }

  /** Limits drawing and upload to the first `count` vertices. */
  end(count: number): void {
    this.geometry.setDrawRange(0, count);
    for (const [name, size] of Object.entries(this.sizes)) {
      upload(this.geometry.getAttribute(name) as BufferAttribute, size * count);
    }
  }
}
