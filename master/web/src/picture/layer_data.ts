// The numbers of a layer as far as they have come, one float a channel and pixel.
import type { TileMessage } from "../app/types";
import type { Size } from "./view";

/// How a pixel's value came to be there.
export const missing = 0; // not there yet
export const exact = 1; // its own, final; from 2 on: rounded, and perhaps that of a pixel less than so many away
export const outdated = 255; // of an earlier stand of the layer, until the new one comes

export interface Rect {
  x: number;
  y: number;
  width: number;
  height: number;
}

export class LayerData implements Size {
  readonly values: Float32Array;
  /// missing, the stride of the pass that the value is from (1: exact), or outdated: smaller is better, 0 aside.
  readonly there: Uint8Array;
  private exactPixels = 0;
  private hasBegun = false;
  private changed: Rect[] = [];

  constructor(
    readonly width: number,
    readonly height: number,
    readonly channels: number,
    readonly step: number, // a pixel of this layer is every step-th of the picture
  ) {
    this.values = new Float32Array(width * height * channels).fill(NaN);
    this.there = new Uint8Array(width * height);
  }

  get bytes(): number {
    return this.values.byteLength + this.there.byteLength;
  }
  /// Something is there.
  get begun(): boolean {
    return this.hasBegun;
  }
  get complete(): boolean {
    return this.exactPixels === this.there.length;
  }

  /// The areas that have changed since they were last taken.
  takeChanges(): Rect[] {
    const taken = this.changed;
    this.changed = [];
    return taken;
  }

  private change(area: Rect): void {
    if (this.changed.length < 1024) this.changed.push(area);
    else this.changed = [whole(this)];
  }

  /// What is there gives way to whatever comes.
  outdate(): void {
    for (let i = 0; i < this.there.length; ++i) if (this.there[i] !== missing) this.there[i] = outdated;
    this.exactPixels = 0;
    this.change(whole(this));
  }

  /// Fills the squares of the tile's values, but not where there are better ones: the order of tiles does not
  /// matter. False when the tile is not of this layer's shape.
  put(tile: TileMessage): boolean {
    const columns = Math.ceil(tile.width / tile.stride);
    const rows = Math.ceil(tile.height / tile.stride);
    const inside = tile.x + tile.width <= this.width && tile.y + tile.height <= this.height;
    const whole = tile.values.length >= columns * rows * tile.channels;
    if (!inside || !whole || tile.channels !== this.channels || tile.stride < 1) return false;
    for (let y = 0; y < tile.height; ++y) this.putRow(tile, y, columns);
    this.hasBegun = true;
    this.change({ x: tile.x, y: tile.y, width: tile.width, height: tile.height });
    return true;
  }

  private putRow(tile: TileMessage, y: number, columns: number): void {
    const { stride, channels } = tile;
    const quality = Math.min(stride, outdated - 1);
    const row = Math.floor(y / stride) * columns;
    for (let x = 0; x < tile.width; ++x) {
      const at = (tile.y + y) * this.width + tile.x + x;
      const now = this.there[at]!;
      if (now !== missing && now < quality) continue;
      const from = (row + Math.floor(x / stride)) * channels;
      for (let c = 0; c < channels; ++c) this.values[at * channels + c] = tile.values[from + c]!;
      if (quality === exact && now !== exact) ++this.exactPixels;
      this.there[at] = quality;
    }
  }

  /// The pixel's numbers; null when it is not there yet.
  at(x: number, y: number): Float32Array | null {
    const i = y * this.width + x;
    if (this.there[i] === missing) return null;
    return this.values.subarray(i * this.channels, (i + 1) * this.channels);
  }

  /// Is the value the pixel's own, and final?
  isExact(x: number, y: number): boolean {
    return this.there[y * this.width + x] === exact;
  }
}

export const whole = (data: LayerData): Rect => ({ x: 0, y: 0, width: data.width, height: data.height });

/// What of an area lies in another; null: nothing.
export function overlap(a: Rect, b: Rect): Rect | null {
  const x = Math.max(a.x, b.x);
  const y = Math.max(a.y, b.y);
  const width = Math.min(a.x + a.width, b.x + b.width) - x;
  const height = Math.min(a.y + a.height, b.y + b.height) - y;
  return width > 0 && height > 0 ? { x, y, width, height } : null;
}
