import { describe, expect, it } from "vitest";
import * as palettes from "../../../master/web/src/picture/palettes";
import { logStep, positionOf, ticksOf, valueAt } from "../../../master/web/src/picture/range";

describe("the original renderer's colours", () => {
  it("of counts go from blue over cyan, green and yellow to red", () => {
    expect([0, 0.25, 0.5, 0.75, 1].map(palettes.rainbow)).toEqual([
      [0, 0, 255],
      [0, 255, 255],
      [0, 255, 0],
      [255, 255, 0],
      [255, 0, 0],
    ]);
  });

  it("of depths are white near and black far, by the logarithm of the distance from the nearest", () => {
    const range = { low: 5, high: 8 };
    const grey = (depth: number): number => palettes.nearWhite(positionOf(depth, range, true, 1, "depth"))[0];
    expect([grey(5), grey(8)]).toEqual([255, 0]);
    for (const depth of [5.2, 6, 7.7])
      expect(grey(depth)).toBe(255 - Math.floor((255 * Math.log(depth - 5 + 1)) / Math.log(8 - 5 + 1)));
  });

  it("of normals are red to the right, green upwards, blue towards the usual camera, black for none", () => {
    expect(palettes.normalColor([1, 0, 0])).toEqual([254, 127, 128]);
    expect(palettes.normalColor([0, 0, -1])).toEqual([127, 127, 255]);
    expect(palettes.normalColor([Infinity, Infinity, Infinity])).toEqual([0, 0, 0]);
  });

  it("are highest when all counts are one, and nearest when all depths are", () => {
    expect(positionOf(3, { low: 3, high: 3 }, false, 1, "count")).toBe(1);
    expect(positionOf(3, { low: 3, high: 3 }, true, 1, "depth")).toBe(0);
  });
});

describe("perceptual colours", () => {
  const lightness = ([r, g, b]: palettes.Rgb): number =>
    0.2126 * r ** 2.2 + 0.7152 * g ** 2.2 + 0.0722 * b ** 2.2;

  it("of viridis begin dark violet, end yellow, and grow lighter all the way", () => {
    const steps = Array.from({ length: 101 }, (_, i) => lightness(palettes.viridis(i / 100)));
    steps.slice(1).forEach((value, i) => expect(value).toBeGreaterThan(steps[i]!));
    // matplotlib's ends are (68, 1, 84) and (253, 231, 37).
    const near = (a: palettes.Rgb, b: palettes.Rgb): void =>
      a.forEach((value, c) => expect(Math.abs(value - b[c]!)).toBeLessThanOrEqual(4));
    near(palettes.viridis(0), [68, 1, 84]);
    near(palettes.viridis(1), [253, 231, 37]);
    near(palettes.viridis(0.5), [33, 145, 140]);
  });

  it("of turbo are green in the middle, blue before and red after", () => {
    const [low, middle, high] = [0.15, 0.5, 0.88].map(palettes.turbo);
    expect(low![2]).toBeGreaterThan(low![0]);
    expect(middle![1]).toBeGreaterThan(Math.max(middle![0], middle![2]));
    expect(high![0]).toBeGreaterThan(Math.max(high![1], high![2]));
  });
});

describe("a table of colours", () => {
  it("has each colour of the rainbow when it is a multiple of its steps long", () => {
    const table = palettes.tableOf(palettes.rainbow, 1021);
    const colors = new Set(Array.from({ length: 1021 }, (_, i) => table.slice(4 * i, 4 * i + 3).join()));
    expect(colors.size).toBe(1021);
    expect([...table.slice(-4)]).toEqual([255, 0, 0, 255]);
  });

  it("of labels has the colours of their numbers", () => {
    const table = palettes.labelTable(8);
    expect([...table.slice(12, 15)]).toEqual(palettes.labelColor(3));
    expect(new Set([0, 1, 2, 3].map((value) => palettes.labelColor(value).join())).size).toBe(4);
  });
});

describe("a position in a range", () => {
  it("is that of the value at it", () => {
    for (const log of [false, true])
      for (const step of [1, 1e-6])
        for (const range of [
          { low: 0, high: 62 },
          { low: -3, high: 1e6 },
          { low: 1e-6, high: 5e-5 },
        ])
          for (const position of [0, 0.1, 0.5, 0.99, 1])
            expect(positionOf(valueAt(position, range, log, step), range, log, step, "count")).toBeCloseTo(
              position,
              6,
            );
  });

  it("spreads short times on a logarithmic scale", () => {
    const range = { low: 1e-6, high: 1e-3 };
    expect(positionOf(3e-5, range, true, logStep({ unit: "seconds" }), "count")).toBeCloseTo(0.49, 2);
  });
});

describe("ticks", () => {
  it("are round and inside the range", () => {
    expect(ticksOf({ low: 0, high: 62 }, false, 1, 5)).toEqual([0, 20, 40, 60]);
    expect(ticksOf({ low: 0.13, high: 0.41 }, false, 1, 5)).toEqual([0.2, 0.3, 0.4]);
    for (const tick of ticksOf({ low: 5, high: 800 }, true, 1, 5)) {
      expect(tick).toBeGreaterThanOrEqual(5);
      expect(tick).toBeLessThanOrEqual(800);
    }
  });
  it("are one for one value", () => {
    expect(ticksOf({ low: 4, high: 4 }, false, 1, 5)).toEqual([4]);
  });
});
