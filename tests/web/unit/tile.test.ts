import { describe, expect, it } from "vitest";
import { decodeTile, fromHalf } from "../../../master/web/src/app/tile";

describe("half floats", () => {
  it("are what IEEE 754 says", () => {
    expect(fromHalf(0x3c00)).toBe(1);
    expect(fromHalf(0xc000)).toBe(-2);
    expect(fromHalf(0x7bff)).toBe(65504);
    expect(fromHalf(0x0001)).toBe(2 ** -24);
    expect(fromHalf(0xfc00)).toBe(-Infinity);
    expect(fromHalf(0x7e00)).toBeNaN();
    expect(Object.is(fromHalf(0x8000), -0)).toBe(true);
  });
});

describe("a tile message", () => {
  const message = (format: number, bytes: number): ArrayBuffer => {
    const buffer = new ArrayBuffer(32 + bytes);
    const view = new DataView(buffer);
    view.setUint32(0, 0x31544652, true);
    [12, 64, 128, 2, 1].forEach((value, i) => view.setUint32(4 + 4 * i, value, true));
    view.setUint16(24, 1, true);
    view.setUint8(26, 1);
    view.setUint8(27, format);
    return buffer;
  };

  it("of floats is decoded bit for bit", () => {
    const buffer = message(1, 8);
    new Float32Array(buffer, 32).set([0.1, Infinity]);
    const tile = decodeTile(buffer);
    expect(tile).toMatchObject({ id: 12, x: 64, y: 128, width: 2, height: 1, stride: 1, channels: 1 });
    expect([...tile.values]).toEqual([Math.fround(0.1), Infinity]);
  });

  it("of halves is decoded", () => {
    const buffer = message(0, 4);
    new Uint16Array(buffer, 32).set([0x3c00, 0x3800]);
    expect([...decodeTile(buffer).values]).toEqual([1, 0.5]);
  });

  it("that is none is refused", () => {
    expect(() => decodeTile(new ArrayBuffer(31))).toThrow("not a tile");
    expect(() => decodeTile(new ArrayBuffer(64))).toThrow("not a tile");
  });

  it("of another size than it says is refused", () => {
    expect(() => decodeTile(message(1, 4))).toThrow("another size");
    expect(() => decodeTile(message(0, 8))).toThrow("another size");
    const endless = message(1, 8);
    new DataView(endless).setUint16(24, 0, true);
    expect(() => decodeTile(endless)).toThrow("another size");
  });
});
