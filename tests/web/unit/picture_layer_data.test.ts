import { describe, expect, it } from "vitest";
import type { TileMessage } from "../../../master/web/src/app/types";
import { LayerData, missing, outdated, overlap } from "../../../master/web/src/picture/layer_data";

const width = 21;
const height = 13;
const valueAt = (x: number, y: number, c: number): number => x + 100 * y + 10_000 * c;

function tile(x: number, y: number, w: number, h: number, stride: number, channels: number): TileMessage {
  const values: number[] = [];
  for (let row = 0; row < h; row += stride)
    for (let column = 0; column < w; column += stride)
      for (let c = 0; c < channels; ++c) values.push(valueAt(x + column, y + row, c));
  return { id: 1, x, y, width: w, height: h, stride, channels, values: Float32Array.from(values) };
}

/// Two tiles side by side, each in all strides, coarse to fine.
const tiles = (channels: number): TileMessage[] =>
  [8, 4, 2, 1].flatMap((stride) => [
    tile(0, 0, 16, height, stride, channels),
    tile(16, 0, 5, height, stride, channels),
  ]);

/// All orders of few things are many; these are some of each kind, the same each time.
function shuffled<T>(list: readonly T[], seed: number): T[] {
  const result = [...list];
  let state = seed;
  for (let i = result.length - 1; i > 0; --i) {
    state = (state * 1103515245 + 12345) % 2147483648;
    const j = state % (i + 1);
    [result[i], result[j]] = [result[j]!, result[i]!];
  }
  return result;
}

describe("a layer's data", () => {
  it("is the same in whatever order its tiles come", () => {
    for (const channels of [1, 3]) {
      for (let seed = 1; seed <= 50; ++seed) {
        const data = new LayerData(width, height, channels, 1);
        for (const each of shuffled(tiles(channels), seed)) expect(data.put(each)).toBe(true);
        expect(data.complete).toBe(true);
        for (let y = 0; y < height; ++y)
          for (let x = 0; x < width; ++x)
            expect([...data.at(x, y)!]).toEqual([...Array(channels).keys()].map((c) => valueAt(x, y, c)));
      }
    }
  });

  it("has the finest value that came, in whatever order", () => {
    const some = tiles(1).filter((each) => each.stride >= 2);
    const expected = new LayerData(width, height, 1, 1);
    some.forEach((each) => expected.put(each));
    for (let seed = 1; seed <= 20; ++seed) {
      const data = new LayerData(width, height, 1, 1);
      shuffled(some, seed).forEach((each) => data.put(each));
      expect(data.values).toEqual(expected.values);
      expect(data.there).toEqual(expected.there);
    }
    expect(expected.complete).toBe(false);
  });

  it("fills each square with its upper left value, which is a preview until the last pass", () => {
    const data = new LayerData(width, height, 1, 1);
    data.put(tile(0, 0, 16, height, 4, 1));
    expect(data.at(6, 5)![0]).toBe(valueAt(4, 4, 0));
    expect(data.isExact(4, 4)).toBe(false);
    expect(data.isExact(6, 5)).toBe(false);
    data.put(tile(0, 0, 16, height, 1, 1));
    expect(data.isExact(6, 5)).toBe(true);
    expect(data.at(16, 0)).toBeNull();
  });

  it("tells a value that is not a number from one that is not there", () => {
    const data = new LayerData(2, 1, 1, 1);
    data.put({
      id: 1,
      x: 0,
      y: 0,
      width: 1,
      height: 1,
      stride: 1,
      channels: 1,
      values: Float32Array.of(NaN),
    });
    expect(data.at(0, 0)![0]).toBeNaN();
    expect(data.at(1, 0)).toBeNull();
    expect(data.begun).toBe(true);
  });

  it("gives way to anything new once it is outdated, and is seen until then", () => {
    const data = new LayerData(width, height, 1, 1);
    tiles(1).forEach((each) => data.put(each));
    data.outdate();
    expect(data.complete).toBe(false);
    expect(data.at(3, 3)![0]).toBe(valueAt(3, 3, 0));
    expect(data.there[3]).toBe(outdated);
    const coarse = { ...tile(0, 0, 16, height, 8, 1) };
    coarse.values.fill(-1);
    data.put(coarse);
    expect(data.at(3, 3)![0]).toBe(-1);
    expect(data.at(17, 0)![0]).toBe(valueAt(17, 0, 0));
    tiles(1).forEach((each) => data.put(each));
    expect(data.complete).toBe(true);
  });

  it("refuses tiles of another shape and is as it was", () => {
    const data = new LayerData(width, height, 1, 1);
    expect(data.put(tile(16, 0, 6, 4, 1, 1))).toBe(false);
    expect(data.put(tile(0, 10, 4, 4, 1, 1))).toBe(false);
    expect(data.put(tile(0, 0, 4, 4, 1, 3))).toBe(false);
    expect(data.put({ ...tile(0, 0, 4, 4, 1, 1), values: new Float32Array(15) })).toBe(false);
    expect(data.there.every((quality) => quality === missing)).toBe(true);
    expect(data.takeChanges()).toEqual([]);
  });

  it("tells what changed once, and all of it when that is much", () => {
    const data = new LayerData(width, height, 1, 1);
    data.put(tile(16, 0, 5, 4, 1, 1));
    expect(data.takeChanges()).toEqual([{ x: 16, y: 0, width: 5, height: 4 }]);
    expect(data.takeChanges()).toEqual([]);
    for (let i = 0; i < 1025; ++i) data.put(tile(0, 0, 1, 1, 1, 1));
    expect(data.takeChanges()).toEqual([{ x: 0, y: 0, width, height }]);
  });
});

describe("the overlap of two areas", () => {
  const a = { x: 0, y: 0, width: 10, height: 10 };
  it("is what both have", () => {
    expect(overlap(a, { x: 5, y: -5, width: 10, height: 10 })).toEqual({ x: 5, y: 0, width: 5, height: 5 });
  });
  it("is nothing for neighbours", () => {
    expect(overlap(a, { x: 10, y: 0, width: 5, height: 5 })).toBeNull();
  });
});
