import { describe, expect, it } from "vitest";
import { spreadOf } from "../../../master/web/src/rays/outliers";
import { cutBox, endOf, segmentsOf } from "../../../master/web/src/rays/segments";
import { entriesOf, type TracedRay } from "../../../master/web/src/rays/trace";
import { lengthOf, minus } from "../../../master/web/src/rays/vec";
import { edge, glass } from "./rays_traces";

const raysIn = (ray: TracedRay): number => 1 + ray.rays.reduce((sum, next) => sum + raysIn(next), 0);
const entries = entriesOf(glass);
const box = cutBox(null, glass);
const segments = segmentsOf(entries, box);
const of = (id: string) => segments.filter((segment) => segment.entry === id);

describe("the lines of a trace's tree", () => {
  it("are all its rays, lights and rays not traced, each once", () => {
    expect(entries.filter((entry) => entry.what === "ray")).toHaveLength(raysIn(glass.samples[0]!.ray));
    expect(new Set(entries.map((entry) => entry.id)).size).toBe(entries.length);
    expect(entriesOf(edge).filter((entry) => entry.level === 0)).toHaveLength(16);
  });

  it("come after their parents, a level deeper", () => {
    const level = new Map<string, number>();
    for (const entry of entries) {
      if (entry.parent !== null) expect(entry.level).toBe(level.get(entry.parent)! + 1);
      level.set(entry.id, entry.level);
    }
  });
});

describe("the segments of a trace", () => {
  it("start where the ray before them ended", () => {
    for (const entry of entries) {
      if (entry.what !== "ray" || entry.parent === null) continue;
      const parent = of(entry.parent)[0]!;
      expect(lengthOf(minus(of(entry.id)[0]!.from, parent.to))).toBeLessThan(1e-9);
    }
  });

  it("run to the light, in two parts where something stands between", () => {
    for (const entry of entries) {
      if (entry.what !== "light") continue;
      const parts = of(entry.id);
      const { fate, at, blocker } = entry.light;
      if (fate === "reached") expect(parts.map((part) => [part.stroke, part.to])).toEqual([["shadow", at]]);
      else if (fate === "blocked") {
        expect(parts.map((part) => part.stroke)).toEqual(["shadow", "blocked"]);
        expect([parts[0]!.from, parts[0]!.to, parts[1]!.from, parts[1]!.to]).toEqual([
          entry.ray.hit!.point,
          blocker!.point,
          blocker!.point,
          at,
        ]);
      } else expect(parts).toEqual([]);
    }
    expect(new Set(segments.map((segment) => segment.stroke)).size).toBe(5);
  });

  it("that miss end on the box around the scene", () => {
    const missed = segments.filter((segment) => segment.missed);
    expect(missed.length).toBeGreaterThan(0);
    for (const { to } of missed) {
      const onFace = [0, 1, 2].map((i) =>
        Math.min(Math.abs(to[i]! - box.min[i]!), Math.abs(to[i]! - box.max[i]!)),
      );
      expect(Math.min(...onFace)).toBeLessThan(1e-9);
    }
  });

  it("that miss and never come near have a length all the same", () => {
    const away = {
      ...glass.samples[0]!.ray,
      hit: null,
      origin: [0, 0, 0],
      direction: [0, 0, -3],
    } as TracedRay;
    const end = endOf(away, { min: [1, 1, 1], max: [3, 1, 1] });
    expect(end).toEqual([0, 0, -0.5]);
  });
});

describe("outliers", () => {
  it("are the samples of an edge that missed what the others hit", () => {
    const { outliers, mean, deviation } = spreadOf(edge.samples.map((sample) => sample.color));
    expect(outliers.flatMap((is, i) => (is ? [i] : []))).toEqual([6, 12]);
    expect(mean).toBeGreaterThan(0);
    expect(deviation).toBeGreaterThan(0.01);
  });

  it("are none among few samples, nor where the difference cannot be seen", () => {
    const withOne = (count: number, odd: number) =>
      Array.from({ length: count }, (_, i): [number, number, number] => (i === 1 ? [odd, odd, odd] : [0.1, 0.1, 0.1]));
    expect(spreadOf(withOne(3, 9)).outliers).not.toContain(true);
    expect(spreadOf(withOne(16, 0.1008)).outliers).not.toContain(true);
    expect(spreadOf(withOne(16, 0.103)).outliers.indexOf(true)).toBe(1);
    expect(spreadOf([]).mean).toBe(0);
  });
});
