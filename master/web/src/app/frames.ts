// Frames of an animation: which of the selected job's is looked at, and how the master is asked for one.
import { computed, signal } from "@preact/signals";
import { selectedJob } from "./state";
import type { Job, JobFrames } from "./types";

export const isAnimation = (job: Job): boolean => job.frames.total > 1;

/// The frame at a place, from 0; the nearest that there is.
export const frameAt = ({ first, step, total }: JobFrames, place: number): number =>
  first + step * Math.min(Math.max(Math.round(place), 0), total - 1);
export const placeOf = ({ first, step }: JobFrames, frame: number): number => (frame - first) / step;
const has = (frames: JobFrames, frame: number): boolean => frameAt(frames, placeOf(frames, frame)) === frame;

/// What is shown of a job: the frame that was chosen, if it has that one, else the one at work, at last the last; of a
/// still none need be named.
export function frameOf(job: Job, chosen: number | null): number | null {
  if (!isAnimation(job)) return null;
  if (chosen !== null && has(job.frames, chosen)) return chosen;
  return job.frames.current ?? job.frames.last;
}

/// Null: as the job goes on.
export const chosenFrame = signal<number | null>(null);
export const shownFrame = computed<number | null>(() =>
  selectedJob.value ? frameOf(selectedJob.value, chosenFrame.value) : null,
);

/// By how many of its frames to go.
export function stepFrame(by: number): void {
  const job = selectedJob.peek();
  const frame = shownFrame.peek();
  if (job && frame !== null) chosenFrame.value = frameAt(job.frames, placeOf(job.frames, frame) + by);
}

/// Behind a path of the API: "?frame=12", or nothing of a still.
export const frameQuery = (frame: number | null, joint: "?" | "&"): string =>
  frame === null ? "" : `${joint}frame=${frame}`;
