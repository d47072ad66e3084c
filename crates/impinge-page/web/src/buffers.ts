// Buffers of the graphics memory that are refilled for each frame: they grow by doubling and never shrink, and only the
// part in use is uploaded.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, type InterleavedBuffer } from "three";

/** Uploads the first so many numbers with the next picture. */
export function upload(buffer: BufferAttribute | InterleavedBuffer, numbers: number): void {
  buffer.clearUpdateRanges();
  buffer.addUpdateRange(0, numbers);
  buffer.needsUpdate = true;
}

/** The capacity that holds `count`: as it is, or at least twice as much, so that growing is rare. */
export function grown(capacity: number, count: number): number {
  return count <= capacity ? capacity : Math.max(count, 2 * capacity, 64);
}

/** The attributes of a geometry without indices. */
export class Buffers {
  readonly geometry = new BufferGeometry();
  /** In vertices. */
  private capacity = 0;

  /** `sizes`: the numbers of a vertex in each attribute. */
  constructor(private readonly sizes: Record<string, number>) {
    this.reserve(1);
  }

  /** Reserves so many vertices; what was written is lost, since each frame writes all. */
  reserve(count: number): void {
    const capacity = grown(this.capacity, count);
    if (capacity === this.capacity) return;
    this.capacity = capacity;
    // An attribute cannot grow in the graphics memory: the old ones are freed there with the geometry.
    this.geometry.dispose();
    for (const [name, size] of Object.entries(this.sizes)) {
      const attribute = new BufferAttribute(new Float32Array(size * capacity), size);
      this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
  }

  /** The numbers of an attribute, to be written in place. */
  array(name: string): Float32Array {
    return this.geometry.getAttribute(name).array as Float32Array;
  }

  /** Draws and uploads so many vertices. */
  end(count: number): void {
    this.geometry.setDrawRange(0, count);
    for (const [name, size] of Object.entries(this.sizes)) {
      upload(this.geometry.getAttribute(name) as BufferAttribute, size * count);
    }
  }
}
