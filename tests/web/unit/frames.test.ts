import { beforeEach, describe, expect, it } from "vitest";
import {
  chosenFrame,
  frameAt,
  frameOf,
  frameQuery,
  placeOf,
  shownFrame,
  stepFrame,
} from "../../../master/web/src/app/frames";
import { jobs, selectedId } from "../../../master/web/src/app/state";
import type { Job, JobFrames } from "../../../master/web/src/app/types";

const frames: JobFrames = { first: 10, last: 30, step: 5, total: 5, sent: 5, done: 2, current: 20 };
const animation = { id: 7, name: "turn", frames } as Job;
const still = { id: 8, name: "still", frames: { ...frames, last: 10, total: 1 } } as Job;

beforeEach(() => {
  jobs.value = [animation, still];
  selectedId.value = 7;
  chosenFrame.value = null;
});

describe("frames and their places", () => {
  it("are each other's inverses", () => {
    for (const place of [0, 1, 2, 3, 4]) expect(placeOf(frames, frameAt(frames, place))).toBe(place);
  });
  it("end with the last", () => {
    expect(frameAt(frames, -1)).toBe(10);
    expect(frameAt(frames, 99)).toBe(30);
  });
});

describe("what is shown", () => {
  it("is the frame at work until one is chosen", () => {
    expect(shownFrame.value).toBe(20);
    chosenFrame.value = 15;
    expect(shownFrame.value).toBe(15);
  });
  it("is the last of a job that is done", () =>
    expect(frameOf({ ...animation, frames: { ...frames, current: null } }, null)).toBe(30));
  it("is no frame that the job has not", () => expect(frameOf(animation, 12)).toBe(20));
  it("has no number in a still", () => expect(frameOf(still, 10)).toBeNull());
  it("goes by frames of the job and stays within them", () => {
    stepFrame(-1);
    expect(shownFrame.value).toBe(15);
    stepFrame(100);
    expect(shownFrame.value).toBe(30);
  });
});

describe("the question", () => {
  it("names the frame of an animation only", () => {
    expect(frameQuery(12, "?")).toBe("?frame=12");
    expect(frameQuery(12, "&")).toBe("&frame=12");
    expect(frameQuery(null, "?")).toBe("");
  });
});
