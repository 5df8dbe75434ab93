import { describe, expect, it } from "vitest";
import { csvOf, numberText } from "../../../master/web/src/picture/csv";
import { comparable, differenceOf, differencesOf, errorsOf, metrics } from "../../../master/web/src/picture/difference";
import { fieldText, fieldUnit, fixed, plain, timeText } from "../../../master/web/src/picture/format";
import { LayerData, whole } from "../../../master/web/src/picture/layer_data";
import { areaBetween, areaIn } from "../../../master/web/src/picture/selection";
import { figuresOf, histogramOf, percentilesOf } from "../../../master/web/src/picture/statistics";

function layerOf(width: number, height: number, channels: number, values: number[], step = 1): LayerData {
  const data = new LayerData(width, height, channels, step);
  data.put({ id: 1, x: 0, y: 0, width, height, stride: 1, channels, values: Float32Array.from(values) });
  return data;
}

describe("figures of an area", () => {
  const data = layerOf(4, 2, 1, [1, 2, NaN, Infinity, 5, -4, 0, 3]);

  it("are of the finite values, and count the others", () => {
    expect(figuresOf(data, 0, whole(data))).toEqual({
      min: -4,
      max: 5,
      mean: 7 / 6,
      sum: 7,
      finite: 6,
      infinite: 1,
      nans: 1,
      absent: 0,
    });
  });

  it("are of the area alone", () => {
    expect(figuresOf(data, 0, { x: 0, y: 1, width: 2, height: 1 })).toMatchObject({
      min: -4,
      max: 5,
      finite: 2,
    });
  });

  it("are none where nothing is there yet", () => {
    const empty = new LayerData(3, 3, 1, 1);
    expect(figuresOf(empty, 0, whole(empty))).toMatchObject({ min: NaN, mean: NaN, finite: 0, absent: 9 });
  });

  it("are of their channel", () => {
    const rgb = layerOf(2, 1, 3, [1, 2, 3, 4, 5, 6]);
    expect([0, 1, 2].map((c) => figuresOf(rgb, c, whole(rgb)).sum)).toEqual([5, 7, 9]);
  });
});

describe("a histogram", () => {
  const values = Array.from({ length: 100 }, (_, i) => i);
  const data = layerOf(10, 10, 1, values);
  const between = (low: number, high: number) => (value: number) => (value - low) / (high - low);

  it("counts each value within its range once", () => {
    const counts = histogramOf(data, 0, whole(data), between(0, 99), 7);
    expect(counts.reduce((a, b) => a + b)).toBe(100);
    expect(histogramOf(data, 0, whole(data), between(9.5, 19.5), 10)).toEqual(Array(10).fill(1));
  });

  it("has parts that are equal on the scale it is given", () => {
    const powers = layerOf(5, 1, 1, [1, 10, 100, 1000, Infinity]);
    expect(histogramOf(powers, 0, whole(powers), (value) => Math.log10(value) / 3, 3)).toEqual([1, 1, 2]);
  });
});

describe("percentiles", () => {
  it("are the values in those places of the order", () => {
    const data = layerOf(
      101,
      1,
      1,
      Array.from({ length: 101 }, (_, i) => (i * 37) % 101),
    );
    expect(percentilesOf(data, 0, 0.01, 0.99)).toEqual([1, 99]);
    expect(percentilesOf(new LayerData(3, 3, 1, 1), 0, 0, 1)).toBeNull();
  });
});

describe("a difference", () => {
  const a = layerOf(4, 1, 1, [1, 2, Infinity, 4]);
  const b = layerOf(4, 1, 1, [1, 5, Infinity, Infinity]);

  it("has the errors of the values that are numbers in both", () => {
    const errors = errorsOf(a, b, whole(a));
    expect(errors).toEqual({ rmse: Math.sqrt(9 / 2), mae: 1.5, max: 3, compared: 2, apart: 1 });
  });

  it("is nothing between equals, infinite ones too", () => {
    for (const metric of ["absolute", "signed", "relative"] as const)
      for (const value of [0, 3, Infinity]) expect(differenceOf(value, value, metric)).toBe(0);
  });

  it("is turned round with its sides when it has a sign, else not", () => {
    expect(differenceOf(1, 4, "signed")).toBe(-differenceOf(4, 1, "signed"));
    expect(differenceOf(1, 4, "absolute")).toBe(differenceOf(4, 1, "absolute"));
    expect(differenceOf(3, 2, "relative")).toBeCloseTo(1 / 2.01);
  });

  it("is a layer with figures of its own, there where both are", () => {
    const part = new LayerData(4, 1, 1, 1);
    part.put({ id: 1, x: 1, y: 0, width: 3, height: 1, stride: 1, channels: 1, values: Float32Array.of(5, 1, 6) });
    for (const metric of metrics) {
      if (metric === "flip") continue;
      const made = differencesOf(a, part, metric);
      expect(made.at(0, 0)).toBeNull();
      expect(figuresOf(made, 0, whole(made))).toMatchObject({ absent: 1, infinite: 1, finite: 2 });
      expect(made.at(1, 0)![0]).toBe(Math.fround(differenceOf(2, 5, metric)));
    }
    const { max } = figuresOf(differencesOf(a, b, "absolute"), 0, whole(a));
    expect(max).toBe(errorsOf(a, b, whole(a)).max);
  });

  it("needs two of one shape", () => {
    expect(comparable(a, b)).toBe(true);
    expect(comparable(a, layerOf(2, 2, 1, [0, 0, 0, 0]))).toBe(false);
    expect(comparable(a, layerOf(4, 1, 1, [0, 0, 0, 0], 2))).toBe(false);
  });
});

describe("a selection", () => {
  it("has all pixels that it touches, within the picture", () => {
    const picture = { width: 100, height: 50 };
    expect(areaBetween({ x: 10.9, y: 20 }, { x: 5.1, y: 22.5 }, picture)).toEqual({
      x: 5,
      y: 20,
      width: 6,
      height: 3,
    });
    expect(areaBetween({ x: -8, y: -8 }, { x: 500, y: 500 }, picture)).toEqual({
      x: 0,
      y: 0,
      width: 100,
      height: 50,
    });
    expect(areaBetween({ x: -8, y: -8 }, { x: -1, y: -1 }, picture)).toBeNull();
  });

  it("has those of them that a large picture sends", () => {
    const data = new LayerData(50, 25, 1, 2);
    expect(areaIn(data, { x: 5, y: 20, width: 6, height: 3 })).toEqual({ x: 3, y: 10, width: 3, height: 2 });
    expect(areaIn(data, null)).toEqual(whole(data));
    expect(areaIn(data, { x: 5, y: 21, width: 1, height: 1 })).toBeNull();
  });
});

describe("a table of values", () => {
  it("has a line for each row, vectors as columns, and reads back to the same floats", () => {
    const values = [0.1, 1 / 3, 1e-20, 16777216, -0.5, 3e38];
    const data = layerOf(1, 2, 3, values);
    const [title, ...lines] = csvOf(data, whole(data), "normal of job 7").trimEnd().split("\n");
    expect(title).toBe("# normal of job 7");
    expect(lines.map((line) => line.split(";").length)).toEqual([3, 3]);
    const read = lines.flatMap((line) => line.split(";").map((cell) => Math.fround(Number(cell))));
    expect(read).toEqual(values.map(Math.fround));
  });

  it("says inf, and nothing for what is not there", () => {
    expect([Infinity, -Infinity, NaN].map(numberText)).toEqual(["inf", "-inf", "nan"]);
    const empty = new LayerData(2, 1, 1, 1);
    expect(csvOf(empty, whole(empty), "depth")).toBe("# depth\n;\n");
  });
});

describe("numbers for people", () => {
  it("are as short as their digits allow", () => {
    expect([0, 12, 0.25, 1 / 3, 123456, 1.5e-7, -2.5].map((value) => plain(value))).toEqual([
      "0",
      "12",
      "0.25",
      "0.3333",
      "123456",
      "1.5e−7",
      "−2.5",
    ]);
    expect([NaN, Infinity, -Infinity].map((value) => plain(value))).toEqual(["NaN", "∞", "−∞"]);
    expect(fixed(-1.25, 1)).toBe("−1.3");
  });
  it("fit into a field, and read back to five digits", () => {
    const values = [0, 3.0749, 1087700.4, 1.6e-6, -0.00012345678, 1e-12, 123456789];
    for (const value of values) {
      expect(Number(fieldText(value))).toBe(Number(value.toPrecision(5)));
      expect(fieldText(value).length).toBeLessThan(12);
    }
  });
  it("are typed in a unit of their size when they are times", () => {
    expect([2e-6, 0.0125, 3].map((seconds) => fieldUnit("seconds", seconds).name)).toEqual(["µs", "ms", "s"]);
    expect(fieldUnit("rays", 1e-6)).toEqual({ name: "", size: 1 });
  });
  it("are times also when these are short", () => {
    expect([0, 2.5e-6, 0.0125, 3].map(timeText)).toEqual(["0 s", "2.5 µs", "12.5 ms", "3.0 s"]);
  });
});
