import { describe, expect, it } from "vitest";
import type { Job, Worker } from "../../../master/web/src/app/types";
import { farmRate, tallyOf, workerRate } from "../../../master/web/src/workers/throughput";

const tally = (time: number, samples: Record<number, number>, pixels: Record<string, number> = {}) =>
  tallyOf(
    time,
    Object.entries(samples).map(([id, primary]) => ({ id: Number(id), counters: { primary } }) as Job),
    Object.entries(pixels).map(([name, count]) => ({ name, pixels: count }) as Worker),
  );

describe("the throughput", () => {
  it("is what all jobs grew by in a second", () =>
    expect(farmRate(tally(10, { 1: 100, 2: 50 }), tally(12, { 1: 300, 2: 90 }))).toBe(120));
  it("counts a job from when it was first seen, and none that is gone", () =>
    expect(farmRate(tally(0, { 1: 100 }), tally(1, { 2: 5000 }))).toBe(0));
  it("is not negative when the master began anew", () => {
    expect(farmRate(tally(0, { 1: 100 }), tally(1, { 1: 20 }))).toBe(0);
    expect(workerRate(tally(0, {}, { lab: 100 }), tally(1, {}, { lab: 20 }), "lab")).toBe(0);
  });
  it("of a worker is its pixels a second", () => {
    expect(workerRate(tally(0, {}, { lab: 100 }), tally(2, {}, { lab: 500 }), "lab")).toBe(200);
    expect(workerRate(tally(0, {}), tally(2, {}, { lab: 500 }), "lab")).toBe(0);
  });
});
