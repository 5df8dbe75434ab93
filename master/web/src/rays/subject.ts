// Whose scene and rays are shown: a frame of the selected job, while the master has that job.
import { computed } from "@preact/signals";
import { shownFrame } from "../app/frames";
import { selectedJob } from "../app/state";

export interface Subject {
  job: number;
  scene: string; // its hash: a master that was started anew may give an old number to another scene
  frame: number | null; // of an animation
}

const job = computed(() => selectedJob.value?.id ?? null);
const scene = computed(() => selectedJob.value?.scene_hash ?? "");

/// The same value until one of its parts changes, however often the job's progress does.
export const subject = computed<Subject | null>(() =>
  job.value === null ? null : { job: job.value, scene: scene.value, frame: shownFrame.value },
);

export const ofOneScene = (a: Subject | null | undefined, b: Subject | null | undefined): boolean =>
  a?.job === b?.job && a?.scene === b?.scene;
