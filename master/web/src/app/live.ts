// The WebSocket that brings news: jobs, workers, log, and the tiles of the layers that are watched.
import type { LayerMessage, TileMessage, Watch } from "./types";

/// Of a binary message; throws when it is none.
export function decodeTile(buffer: ArrayBuffer): TileMessage {
  const view = new DataView(buffer);
  if (buffer.byteLength < 32 || view.getUint32(0, true) !== 0x31544652) throw new Error("not a tile");
  const channels = view.getUint8(26);
  const half = view.getUint8(27) === 0;
  return {
    id: view.getUint32(4, true),
    x: view.getUint32(8, true),
    y: view.getUint32(12, true),
    width: view.getUint32(16, true),
    height: view.getUint32(20, true),
    stride: view.getUint16(24, true),
    channels,
    values: half ? fromHalves(new Uint16Array(buffer, 32)) : new Float32Array(buffer, 32),
  };
}

function fromHalves(halves: Uint16Array): Float32Array {
  const values = new Float32Array(halves.length);
  for (let i = 0; i < halves.length; ++i) values[i] = fromHalf(halves[i]!);
  return values;
}

export function fromHalf(half: number): number {
  const sign = half & 0x8000 ? -1 : 1;
  const exponent = (half >> 10) & 31;
  const fraction = half & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * (1 + fraction / 1024) * 2 ** (exponent - 15) : sign * fraction * 2 ** -24;
}

export interface LayerListener {
  layer(message: LayerMessage): void;
  tile(message: TileMessage): void;
}

const listeners = new Set<LayerListener>();
let watched: Watch[] = [];

/// Asks for exactly these layers from now on (at most 8), also after the connection was lost and found again.
export function watch(list: Watch[]): void {
  watched = list;
}
export const watches = (): readonly Watch[] => watched;

export function listen(listener: LayerListener): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}
