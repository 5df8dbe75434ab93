// The parts of layers as they come over the WebSocket: a header of 32 bytes, then numbers, little endian.
import type { TileMessage } from "./types";

/// Of a binary message; throws when it is none.
export function decodeTile(buffer: ArrayBuffer): TileMessage {
  const view = new DataView(buffer);
  if (buffer.byteLength < 32 || view.getUint32(0, true) !== 0x31544652) throw new Error("not a tile");
  const tile = {
    id: view.getUint32(4, true),
    x: view.getUint32(8, true),
    y: view.getUint32(12, true),
    width: view.getUint32(16, true),
    height: view.getUint32(20, true),
    stride: view.getUint16(24, true),
    channels: view.getUint8(26),
  };
  const half = view.getUint8(27) === 0;
  const count = Math.ceil(tile.width / tile.stride) * Math.ceil(tile.height / tile.stride) * tile.channels;
  if (buffer.byteLength - 32 !== count * (half ? 2 : 4))
    throw new Error("a tile of another size than it says");
  return { ...tile, values: half ? fromHalves(new Uint16Array(buffer, 32)) : new Float32Array(buffer, 32) };
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
