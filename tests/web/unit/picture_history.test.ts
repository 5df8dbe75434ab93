import { describe, expect, it } from "vitest";
import type { Job } from "../../../master/web/src/app/types";
import { changesBetween, resultsOf } from "../../../master/web/src/picture/history";
import { hitsByName, titlesOf } from "../../../master/web/src/picture/job_statistics";

const settings = {
  width: 64,
  height: 48,
  spp: 4,
  sampler: "sobol",
  seed: 1,
  frame: 0,
  max_depth: 10,
  min_importance: 0.05,
  shadows: true,
  reflections: true,
  refractions: true,
};
const job = (id: number, change: Partial<Job> = {}): Job =>
  ({ id, name: "circus", settings, parameters: {}, scene_hash: "abc", pixels_done: 1, ...change }) as Job;

describe("the history of a scene", () => {
  const all = [1, 2, 3, 4, 5, 6, 7].map((id) => job(id));

  it("is the last results of its name, newest first", () => {
    const jobs = [...all, job(8, { name: "jar" }), job(9, { pixels_done: 0 })];
    expect(resultsOf(jobs, all[6]!, 5).map((each) => each.id)).toEqual([7, 6, 5, 4, 3]);
  });

  it("has the chosen job, however old or unfinished", () => {
    expect(resultsOf(all, all[0]!, 5).map((each) => each.id)).toEqual([7, 6, 5, 4, 1]);
    const waiting = job(10, { pixels_done: 0 });
    expect(resultsOf([...all, waiting], waiting, 5)[0]).toBe(waiting);
  });
});

describe("the changes between two results", () => {
  it("are the settings and parameters that differ", () => {
    const a = job(1, { parameters: { depth: "6" } });
    const b = job(2, {
      parameters: { depth: "7", light: "point" },
      settings: { ...settings, max_depth: 3 },
      scene_hash: "def",
    });
    expect(changesBetween(a, b)).toEqual([
      { name: "depth", from: "6", to: "7" },
      { name: "light", from: "–", to: "point" },
      { name: "max depth", from: "10", to: "3" },
    ]);
  });

  it("are the scene when no parameter tells why it is another", () => {
    expect(changesBetween(job(1), job(2, { scene_hash: "def" }))).toEqual([
      { name: "scene", from: "abc", to: "def" },
    ]);
  });

  it("are none between equals", () => {
    expect(changesBetween(job(1), job(2))).toEqual([]);
  });
});

describe("hits by name", () => {
  it("are summed over the solids of a name, the most first", () => {
    const hits = [
      { name: "pole", hits: 3 },
      { name: "floor", hits: 5 },
      { name: "pole", hits: 4 },
    ];
    expect(hitsByName(hits)).toEqual([
      { name: "pole", hits: 7, solids: 2 },
      { name: "floor", hits: 5, solids: 1 },
    ]);
  });
});

describe("counters", () => {
  it("are in the order of a ray's life, with what is new last", () => {
    const names = titlesOf({ boxes_tested: 1, bad_samples: 2, misses: 3, primary: 4, rays: 5 }).map(
      ([, title]) => title,
    );
    expect(names).toEqual(["primary", "all rays", "misses", "boxes tested", "NaN samples"]);
  });
});
