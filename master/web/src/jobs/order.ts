// In which order jobs are worked on and shown, and why one waits.
import { many } from "../app/format";
import type { Job, JobState, Worker } from "../app/types";

export const hasEnded = (job: Job): boolean => ["done", "cancelled", "failed"].includes(job.state);

/// As the master works on them: by priority, then by age.
export function queueOf(jobs: readonly Job[]): Job[] {
  return jobs.filter((job) => !hasEnded(job)).sort((a, b) => b.priority - a.priority || a.id - b.id);
}
/// The ended ones, newest first.
export function historyOf(jobs: readonly Job[]): Job[] {
  return jobs.filter(hasEnded).sort((a, b) => b.id - a.id);
}

export interface Filter {
  state: JobState | "all";
  text: string; // in the name, or the id
}
export function fits(job: Job, filter: Filter): boolean {
  const text = filter.text.trim().toLowerCase();
  return (
    (filter.state === "all" || job.state === filter.state) &&
    (text === "" || job.name.toLowerCase().includes(text) || `#${job.id}`.includes(text))
  );
}

/// The job so many places further in the list; the first when none is chosen.
export function neighbour(list: readonly Job[], id: number | null, steps: number): Job | undefined {
  const place = list.findIndex((job) => job.id === id);
  if (place < 0) return list[0];
  return list[Math.min(list.length - 1, Math.max(0, place + steps))];
}

/// In words, for a job that waits or was paused; nothing for others.
export function whyWaiting(job: Job, jobs: readonly Job[], workers: readonly Worker[]): string | null {
  if (job.state === "paused") return "It is paused; resume it to go on.";
  if (job.state !== "waiting") return null;
  const there = workers.filter((worker) => worker.state !== "dialling" && worker.state !== "banned");
  if (there.length === 0) return "No worker is connected.";
  if (there.every((worker) => worker.state === "drained")) return "All workers are drained; undrain one.";
  const queue = queueOf(jobs).filter((other) => other.state !== "paused");
  const ahead = queue.slice(
    0,
    queue.findIndex((other) => other.id === job.id),
  );
  if (ahead.length === 0) return "It is next: it starts when a worker is free.";
  const first = ahead[0]!;
  return `${many(ahead.length, "job")} ${ahead.length === 1 ? "goes" : "go"} first: #${first.id} ${first.name} (priority ${first.priority})${ahead.length > 1 ? ", ..." : ""}`;
}
