import { describe, expect, it } from "vitest";
import { fits, historyOf, neighbour, queueOf, whyWaiting } from "../../../master/web/src/jobs/order";
import type { Job, Worker } from "../../../master/web/src/app/types";

const job = (id: number, state: Job["state"], priority = 50): Job =>
  ({ id, name: `job${id}`, state, priority }) as Job;
const worker = (state: Worker["state"]): Worker => ({ name: state, state }) as Worker;
const ids = (list: Job[]) => list.map(({ id }) => id);

describe("the list of jobs", () => {
  const jobs = [
    job(1, "done"),
    job(2, "running"),
    job(3, "waiting", 80),
    job(4, "failed"),
    job(5, "paused"),
    job(6, "cancelled"),
  ];
  it("has the queue as the master works on it: by priority, then by age", () =>
    expect(ids(queueOf(jobs))).toEqual([3, 2, 5]));
  it("has the ended ones with the newest first", () => expect(ids(historyOf(jobs))).toEqual([6, 4, 1]));
  it("holds each job once", () =>
    expect(ids([...queueOf(jobs), ...historyOf(jobs)]).sort()).toEqual(ids(jobs)));
  it("is filtered by state, name and number", () => {
    const by = (state: Job["state"] | "all", text: string) =>
      ids(jobs.filter((one) => fits(one, { state, text })));
    expect(by("all", "")).toEqual([1, 2, 3, 4, 5, 6]);
    expect(by("running", "")).toEqual([2]);
    expect(by("all", " JOB4 ")).toEqual([4]);
    expect(by("all", "#6")).toEqual([6]);
  });
  it("is gone through without falling off its ends", () => {
    expect(neighbour(jobs, 2, 1)?.id).toBe(3);
    expect(neighbour(jobs, 6, 10)?.id).toBe(6);
    expect(neighbour(jobs, 2, -10)?.id).toBe(1);
    expect(neighbour(jobs, null, -1)?.id).toBe(1);
    expect(neighbour([], 1, 1)).toBeUndefined();
  });
});

describe("why a job waits", () => {
  const waiting = job(7, "waiting", 20);
  const why = (jobs: Job[], workers: Worker[]) => whyWaiting(waiting, [...jobs, waiting], workers);
  it("is told of waiting and paused ones only", () => {
    expect(whyWaiting(job(1, "running"), [], [])).toBeNull();
    expect(whyWaiting(job(1, "paused"), [], [])).toContain("resume");
  });
  it("is that nobody can work", () => {
    expect(why([], [])).toBe("No worker is connected.");
    expect(why([], [worker("dialling"), worker("banned")])).toBe("No worker is connected.");
    expect(why([], [worker("drained")])).toContain("drained");
  });
  it("is who goes first; paused and ended ones do not", () => {
    const busy = [worker("busy")];
    expect(why([job(1, "done"), job(2, "paused", 90), job(8, "waiting", 20)], busy)).toContain("next");
    expect(why([job(2, "running", 20)], busy)).toBe("1 job goes first: #2 job2 (priority 20)");
    expect(why([job(2, "running", 20), job(9, "waiting", 30)], busy)).toBe(
      "2 jobs go first: #9 job9 (priority 30), ...",
    );
  });
});
