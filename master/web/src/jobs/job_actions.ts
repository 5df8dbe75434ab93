// What is done with the selected job, by buttons, keys and the palette.
import { computed } from "@preact/signals";
import { register, type Action } from "../app/actions";
import { postJson } from "../app/api";
import { confirm } from "../app/confirm";
import { panelsShown, columnShown } from "../app/layout";
import { openJob, openSubmit } from "../app/route";
import { jobs, selectedId, selectedJob, tellError } from "../app/state";
import type { Job } from "../app/types";
import { filter } from "./filter";
import { fits, hasEnded, historyOf, neighbour, queueOf } from "./order";

/// The jobs as listed, top to bottom.
export const listed = computed<{ queue: Job[]; history: Job[] }>(() => {
  const fitting = jobs.value.filter((job) => fits(job, filter.value));
  return { queue: queueOf(fitting), history: historyOf(fitting) };
});

export function step(steps: number): void {
  const next = neighbour([...listed.value.queue, ...listed.value.history], selectedId.value, steps);
  if (next) openJob(next.id);
}

export function setPriority(job: Job, priority: number): void {
  const fitting = Math.min(99, Math.max(0, Math.round(priority)));
  if (Number.isNaN(fitting) || fitting === job.priority) return;
  postJson(`/jobs/${job.id}/priority`, { priority: fitting }).catch(tellError);
}

export const isPaused = (job: Job): boolean => job.state === "paused";

export function pauseOrResume(job: Job): void {
  postJson(`/jobs/${job.id}/${isPaused(job) ? "resume" : "pause"}`).catch(tellError);
}

export function cancel(job: Job): void {
  confirm({
    title: `Cancel job ${job.id}?`,
    text: `${job.name} ends for good; what is rendered of it so far can no longer be mapped or traced.`,
    yes: "Cancel the job",
    run: () => void postJson(`/jobs/${job.id}/cancel`).catch(tellError),
  });
}

export function remove(job: Job): void {
  confirm({
    title: `Remove job ${job.id}?`,
    text: `The farm forgets ${job.name} for good, with its pictures.`,
    yes: "Remove the job",
    run: () => void postJson(`/jobs/${job.id}/remove`).catch(tellError),
  });
}

/// Moves the focus into the job list, which may have to appear first.
function focusList(): void {
  panelsShown.value = columnShown.value = true;
  const list = () => document.getElementById("job-list");
  if (list()) list()!.focus();
  else requestAnimationFrame(() => list()?.focus());
}

const onJob = (run: (job: Job) => void) => () => {
  if (selectedJob.value) run(selectedJob.value);
};
const isActive = (): boolean => selectedJob.value !== null && !hasEnded(selectedJob.value);

const jobActions: Action[] = [
  { id: "job-list", title: "Go to the job list", group: "Jobs", keys: ["Q"], run: focusList },
  { id: "job-next", title: "Next job", group: "Jobs", keys: ["J"], run: () => step(1) },
  { id: "job-previous", title: "Previous job", group: "Jobs", keys: ["Shift+J"], run: () => step(-1) },
  {
    id: "job-pause",
    title: "Pause or resume the job",
    group: "Jobs",
    keys: ["P"],
    scope: "jobs",
    enabled: isActive,
    run: onJob(pauseOrResume),
  },
  {
    id: "job-cancel",
    title: "Cancel the job",
    group: "Jobs",
    keys: ["Delete"],
    scope: "jobs",
    enabled: isActive,
    run: onJob(cancel),
  },
  {
    id: "job-remove",
    title: "Remove the job, which has ended",
    group: "Jobs",
    keys: ["Shift+Delete"],
    scope: "jobs",
    enabled: () => selectedJob.value !== null && hasEnded(selectedJob.value),
    run: onJob(remove),
  },
  {
    id: "job-clone",
    title: "New job from this one, with changed settings",
    group: "Jobs",
    keys: ["C"],
    scope: "jobs",
    enabled: () => selectedJob.value !== null,
    run: onJob((job) => openSubmit(job.id)),
  },
  {
    id: "job-up",
    title: "Raise the priority",
    group: "Jobs",
    keys: ["+"],
    scope: "jobs",
    enabled: isActive,
    run: onJob((job) => setPriority(job, job.priority + 1)),
  },
  {
    id: "job-down",
    title: "Lower the priority",
    group: "Jobs",
    keys: ["-"],
    scope: "jobs",
    enabled: isActive,
    run: onJob((job) => setPriority(job, job.priority - 1)),
  },
];

export const registerJobs = (): (() => void) => register(jobActions);
