import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { answer } from "../../../master/web/src/rays/probe";
import { entries, select } from "../../../master/web/src/rays/selection";
import { followStory, story, storyError } from "../../../master/web/src/rays/story";
import { rayNumberOf, type CsgStory } from "../../../master/web/src/rays/trace";
import { edge, glass } from "./rays_traces";

interface Request {
  path: string;
  answer: (csg: CsgStory) => void;
  refuse: (error: string) => void;
}
let requests: Request[];
let unfollow: () => void;

const told: CsgStory = { leaves: [{ leaf: 0, name: "a", stretches: [{ in: 1, out: 2 }] }], material: [] };
const show = (trace: typeof glass): void => {
  const question = { job: 7, scene: "a", frame: null, pixel: { x: 3, y: 4 }, sample: 0 };
  answer.value = { question, trace, milliseconds: 1 };
};

beforeEach(() => {
  requests = [];
  vi.stubGlobal(
    "fetch",
    (path: string) =>
      new Promise<Response>((resolve) => {
        const respond = (status: number, body: unknown) =>
          resolve(new Response(JSON.stringify(body), { status }));
        requests.push({
          path,
          answer: (csg) => respond(200, { samples: [{ csg }] }),
          refuse: (error) => respond(422, { error }),
        });
      }),
  );
  select(null);
  show(glass);
  unfollow = followStory();
});
afterEach(() => {
  unfollow();
  answer.value = null;
  vi.unstubAllGlobals();
});
const settled = () => new Promise<void>((resolve) => setTimeout(resolve));
const raysBelow = () => entries.value.filter((entry) => entry.what === "ray").slice(1);

describe("the set operations along the chosen ray", () => {
  it("are those of the trace for a primary ray", () => {
    expect(story.value).toMatchObject({ entry: { id: "0" }, csg: glass.samples[0]!.csg });
    show(edge);
    select("2");
    expect(story.value).toMatchObject({ sample: edge.samples[2], csg: edge.samples[2]!.csg });
    expect(requests).toHaveLength(0);
  });

  it("are asked for by the ray's number, parents before children", async () => {
    const rays = raysBelow();
    expect(rays.length).toBeGreaterThan(1);
    for (const [i, ray] of rays.entries()) {
      select(ray.id);
      const request = requests.at(-1)!;
      const sample = glass.samples[0]!.sample;
      expect(request.path).toBe(`/api/v1/jobs/7/trace?x=3&y=4&sample=${sample}&story=${i + 1}`);
      request.answer(told);
      await settled();
      expect(story.value).toMatchObject({ entry: { id: ray.id }, csg: told });
    }
    expect(rayNumberOf(glass.samples[0]!.ray, glass.samples[0]!.ray)).toBe(0);
  });

  it("are asked for one at a time, and of those chosen meanwhile only the newest; till then the last stay", async () => {
    const [first, second, third] = raysBelow();
    for (const ray of [first!, second!, third!]) select(ray.id);
    expect(requests).toHaveLength(1);
    expect(story.value?.entry.id).toBe("0");
    requests[0]!.answer(told);
    await settled();
    expect(story.value?.entry.id).toBe(first!.id);
    requests[1]!.answer(told);
    await settled();
    expect(story.value?.entry.id).toBe(third!.id);
    expect(requests).toHaveLength(2);
  });

  it("are not asked for again when a light at the ray's end is chosen", async () => {
    const ray = raysBelow().find((entry) => entry.ray.lights.length > 0)!;
    select(ray.id);
    requests[0]!.answer(told);
    await settled();
    select(`${ray.id}.l0`);
    expect(requests).toHaveLength(1);
  });

  it("that the master refuses are told in its words, and are no other ray's", async () => {
    select(raysBelow()[0]!.id);
    requests[0]!.refuse("there is no ray 1");
    await settled();
    expect([story.value, storyError.value]).toEqual([null, "there is no ray 1"]);
    select(null);
    expect([story.value?.entry.id, storyError.value]).toEqual(["0", null]);
  });
});
