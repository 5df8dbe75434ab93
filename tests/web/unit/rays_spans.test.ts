import { describe, expect, it } from "vitest";
import { chartOf, ticksOf } from "../../../master/web/src/rays/spans";
import { glass } from "./rays_traces";

const { csg, ray } = glass.samples[0]!;

describe("the chart of the set operations", () => {
  const chart = chartOf(csg, ray.hit!.distance);
  const at = (distance: number) => (distance - chart.from) / (chart.to - chart.from);

  it("has a row for each leaf in the order of the ray, the material last", () => {
    expect(chart.rows.map((row) => row.name)).toEqual([
      "bitten/bite #1",
      "bitten/ball #0",
      "ring #2",
      "floor #4",
      "material",
    ]);
  });

  it("puts bars where the distances are", () => {
    for (const bar of chart.rows.flatMap((row) => row.bars)) {
      expect(bar.from).toBeCloseTo(at(bar.in), 12);
      expect(bar.to).toBeCloseTo(bar.out === null ? 1 : at(bar.out), 12);
      expect(bar.endless).toBe(bar.out === null);
      expect(bar.to).toBeLessThanOrEqual(1);
    }
  });

  it("shows the ball without the bite as material, from the hit on", () => {
    const [ball, bite, material] = ["bitten/ball #0", "bitten/bite #1", "material"].map(
      (name) => chart.rows.find((row) => row.name === name)!.bars[0]!,
    );
    expect(material!.in).toBeCloseTo(bite!.out!, 9);
    expect(material!.in).toBeCloseTo(ray.hit!.distance, 9);
    expect(material!.out).toBeCloseTo(ball!.out!, 9);
  });

  it("begins at the eye unless all is far away", () => {
    const far = { leaves: [{ leaf: 0, name: "a", stretches: [{ in: 1000, out: 1001 }] }], material: [] };
    expect(chartOf(far, null).from).toBeGreaterThan(999);
    const inside = { leaves: [{ leaf: 0, name: "a", stretches: [{ in: 0, out: 1001 }] }], material: [] };
    expect(chartOf(inside, null)).toMatchObject({
      from: 0,
      rows: [{ bars: [{ from: 0, startsInside: true }] }, {}],
    });
  });

  it("of a single crossing begins at the eye", () => {
    const floor = {
      leaves: [{ leaf: 1, name: "floor", stretches: [{ in: 7, out: null }] }],
      material: [{ in: 7, out: null }],
    };
    const alone = chartOf(floor, 7);
    expect(alone.from).toBe(0);
    expect(alone.rows.map((row) => row.bars[0]!.from)).toEqual([7 / alone.to, 7 / alone.to]);
  });

  it("of crossings that differ by rounding alone has a width", () => {
    const floor = { leaves: [{ leaf: 0, name: "floor", stretches: [{ in: 8.4, out: null }] }], material: [] };
    const single = chartOf(floor, 8.4 * (1 + 1e-15));
    expect(single.from).toBe(0);
    expect(single.rows[0]!.bars[0]!.from).toBeGreaterThan(0.9);
    expect(single.ticks.length).toBeGreaterThan(2);
  });

  it("of a ray that is inside for ever is one bar", () => {
    const always = {
      leaves: [{ leaf: 3, name: "a", stretches: [{ in: 0, out: null }] }],
      material: [{ in: 0, out: null }],
    };
    expect(chartOf(always, null).rows.map((row) => row.bars[0])).toMatchObject([
      { from: 0, to: 1, endless: true },
      { from: 0, to: 1, endless: true },
    ]);
  });
});

describe("ticks", () => {
  it("are round numbers within the chart, three to eight", () => {
    for (const [from, to] of [
      [0, 1],
      [0, 9.4],
      [3.97, 9],
      [999.9, 1001.1],
      [0, 1e-7],
      [0, 7e12],
    ] as const) {
      const ticks = ticksOf(from, to);
      expect(ticks.length, `${from} to ${to}`).toBeGreaterThanOrEqual(3);
      expect(ticks.length, `${from} to ${to}`).toBeLessThanOrEqual(8);
      for (const tick of ticks) expect(tick >= from && tick <= to).toBe(true);
    }
    expect(ticksOf(0, 1)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
  });
});
