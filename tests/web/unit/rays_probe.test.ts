import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { jobs, link, probe, probed, selectedId } from "../../../master/web/src/app/state";
import type { Job } from "../../../master/web/src/app/types";
import { answer, asking, followProbe, probeError, sampleChoice } from "../../../master/web/src/rays/probe";

interface Request {
  path: string;
  signal: AbortSignal;
  answer: () => void;
  refuse: (status: number, error: string) => void;
}
let requests: Request[];
let unfollow: () => void;

const jobOf = (id: number, scene = "a", width = 640): Job =>
  ({ id, scene_hash: scene, settings: { width, height: 480 }, frames: { total: 1 } }) as Job;

beforeEach(() => {
  requests = [];
  jobs.value = [jobOf(7), jobOf(8), jobOf(9, "a", 320)];
  probe(null);
  vi.stubGlobal("fetch", (path: string, { signal }: { signal: AbortSignal }) => {
    return new Promise<Response>((resolve) => {
      const respond = (status: number, body: unknown) =>
        resolve(new Response(JSON.stringify(body), { status }));
      const [x, y] = [...path.matchAll(/[xy]=(\d+)/g)].map((match) => Number(match[1]));
      requests.push({
        path,
        signal,
        answer: () => respond(200, { pixel: [x, y], samples: [] }),
        refuse: (status, error) => respond(status, { error }),
      });
    });
  });
  [selectedId.value, sampleChoice.value, link.value] = [null, 0, "open"];
  unfollow = followProbe();
});
afterEach(() => {
  unfollow();
  answer.value = probeError.value = null;
  vi.unstubAllGlobals();
});
const settled = () => new Promise<void>((resolve) => setTimeout(resolve));
const choose = (job: number, x: number, y: number) => {
  selectedId.value = job;
  probe({ x, y });
};

describe("the probed pixel", () => {
  it("is asked for once a job and a pixel are chosen", async () => {
    selectedId.value = 7;
    expect(requests).toHaveLength(0);
    probe({ x: 3, y: 4 });
    expect(requests.map((request) => request.path)).toEqual(["/api/v1/jobs/7/trace?x=3&y=4&sample=0"]);
    expect(asking.value).toBe(true);
    requests[0]!.answer();
    await settled();
    expect(answer.value).toMatchObject({ question: { job: 7 }, trace: { pixel: [3, 4] } });
    expect(asking.value).toBe(false);
    sampleChoice.value = "all";
    expect(requests[1]!.path).toContain("sample=all");
  });

  it("that is dragged is asked for one at a time, and its answer is seen while the next is under way", async () => {
    selectedId.value = 7;
    for (let x = 0; x < 50; ++x) probe({ x, y: 0 });
    expect(requests).toHaveLength(1);
    requests[0]!.answer();
    await settled();
    expect(answer.value?.trace.pixel).toEqual([0, 0]);
    expect(asking.value).toBe(true);
    expect(requests).toHaveLength(2);
    requests[1]!.answer();
    await settled();
    expect(answer.value?.trace.pixel).toEqual([49, 0]);
    expect(asking.value).toBe(false);
    expect(requests).toHaveLength(2);
  });

  it("of another job replaces what is known and under way", async () => {
    choose(7, 1, 1);
    requests[0]!.answer();
    await settled();
    probe({ x: 2, y: 2 });
    selectedId.value = 8;
    expect(answer.value).toBeNull();
    expect(requests[1]!.signal.aborted).toBe(true);
    requests[1]!.answer();
    requests[2]!.answer();
    await settled();
    expect(answer.value?.question.job).toBe(8);
  });

  it("that the master refuses is told in its words, and the next may be right", async () => {
    choose(7, 1, 9);
    requests[0]!.refuse(409, "the job was cancelled");
    await settled();
    expect(probeError.value).toBe("the job was cancelled");
    probe({ x: 1, y: 1 });
    requests[1]!.answer();
    await settled();
    expect(probeError.value).toBeNull();
  });

  it("that failed is not paired with the rays of the one before", async () => {
    choose(7, 1, 1);
    requests[0]!.answer();
    await settled();
    probe({ x: 2, y: 2 });
    expect(answer.value?.trace.pixel).toEqual([1, 1]);
    requests[1]!.refuse(503, "no");
    await settled();
    expect(answer.value).toBeNull();
    expect(probeError.value).toBe("no");
  });

  it("has no rays any more when the master has the job no more, or another of its number", async () => {
    choose(7, 1, 1);
    requests[0]!.answer();
    await settled();
    jobs.value = jobs.value.map((job) => ({ ...job, pixels_done: 5 }));
    expect(requests).toHaveLength(1); // progress changes nothing
    jobs.value = [jobOf(7, "b")];
    expect(answer.value).toBeNull();
    requests[1]!.answer();
    await settled();
    expect(answer.value?.question.scene).toBe("b");
    jobs.value = [];
    expect(answer.value).toBeNull();
    expect(asking.value).toBe(false);
  });

  it("is none where a smaller picture does not reach so far, and is there again in a larger one", () => {
    choose(7, 400, 1);
    selectedId.value = 9;
    expect(probed.value).toBeNull();
    expect(asking.value).toBe(false);
    expect(requests).toHaveLength(1);
    selectedId.value = 8;
    expect(probed.value).toEqual({ x: 400, y: 1 });
    expect(requests).toHaveLength(2);
  });

  it("is asked for again when a lost master is found again", async () => {
    choose(7, 1, 1);
    requests[0]!.refuse(503, "no");
    await settled();
    link.value = "lost";
    expect(requests).toHaveLength(1);
    link.value = "open";
    expect(requests).toHaveLength(2);
  });

  it("is not asked for when nobody looks", () => {
    unfollow();
    choose(7, 1, 1);
    expect(requests).toHaveLength(0);
  });
});
