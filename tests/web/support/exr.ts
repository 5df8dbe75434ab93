// Reads the floats of an EXR as the master writes it: one part, scanlines, ZIP, 32-bit float channels.
import { inflateSync } from "node:zlib";

export interface Floats {
  width: number;
  height: number;
  /// Of a pixel: its channels in the order of their names, which for a picture is B, G, R.
  at(x: number, y: number): number[];
}

const magic = 20000630;
const zip = 3;
const float = 2;
const rowsABlock = 16;

interface Header {
  channels: string[];
  width: number;
  height: number;
  end: number; // where the table of blocks begins
}

function readHeader(bytes: Buffer): Header {
  if (bytes.readUInt32LE(0) !== magic) throw new Error("this is no EXR");
  let at = 8;
  const text = (): string => {
    const end = bytes.indexOf(0, at);
    const read = bytes.toString("latin1", at, end);
    at = end + 1;
    return read;
  };
  const header: Header = { channels: [], width: 0, height: 0, end: 0 };
  for (let name = text(); name !== ""; name = text()) {
    text(); // its type
    const size = bytes.readUInt32LE(at);
    at += 4;
    const end = at + size;
    if (name === "compression" && bytes[at] !== zip) throw new Error("only ZIP is read");
    if (name === "dataWindow") {
      header.width = bytes.readInt32LE(at + 8) - bytes.readInt32LE(at) + 1;
      header.height = bytes.readInt32LE(at + 12) - bytes.readInt32LE(at + 4) + 1;
    }
    if (name === "channels")
      for (let channel = text(); channel !== ""; channel = text()) {
        if (bytes.readInt32LE(at) !== float) throw new Error("only floats are read");
        header.channels.push(channel);
        at += 16;
      }
    at = end;
  }
  return { ...header, end: at };
}

/// Undoes the deltas and the split into even and odd bytes.
function unpredicted(packed: Buffer): Buffer {
  for (let i = 1; i < packed.length; ++i) packed[i] = (packed[i - 1]! + packed[i]! - 128) & 255;
  const half = (packed.length + 1) >> 1;
  const whole = Buffer.alloc(packed.length);
  for (let i = 0; i < whole.length; ++i) whole[i] = packed[(i >> 1) + (i & 1 ? half : 0)]!;
  return whole;
}

export function readExr(bytes: Buffer): Floats {
  const { channels, width, height, end } = readHeader(bytes);
  const rowBytes = channels.length * width * 4;
  const blocks: Buffer[] = [];
  for (let block = 0; block < Math.ceil(height / rowsABlock); ++block) {
    const start = Number(bytes.readBigUInt64LE(end + 8 * block));
    const size = bytes.readUInt32LE(start + 4);
    const data = bytes.subarray(start + 8, start + 8 + size);
    const rows = Math.min(rowsABlock, height - block * rowsABlock);
    blocks.push(size === rows * rowBytes ? data : unpredicted(inflateSync(data)));
  }
  return {
    width,
    height,
    at(x, y) {
      const row = blocks[Math.floor(y / rowsABlock)]!;
      const from = (y % rowsABlock) * rowBytes;
      return channels.map((_, c) => row.readFloatLE(from + 4 * (c * width + x)));
    },
  };
}
