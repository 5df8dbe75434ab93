// The last results of a scene.
import { computed, signal } from "@preact/signals";
import { jobs, selectedId, selectedJob } from "../app/state";
import { stored } from "../app/stored";
import type { Job } from "../app/types";

export const historyLength = stored(
  "history",
  8,
  (n) => Number.isInteger(n) && (n as number) >= 5 && (n as number) <= 50,
);

/// Jobs of the same name that have something to show, newest first; the job itself is always among them.
export function resultsOf(all: readonly Job[], job: Job, most: number): Job[] {
  const others = all.filter(
    (other) => other.id !== job.id && other.name === job.name && other.pixels_done > 0,
  );
  const newest = [...others, job].sort((a, b) => b.id - a.id).slice(0, most);
  return newest.includes(job) ? newest : [...newest.slice(0, most - 1), job];
}

export const results = computed<Job[]>(() => {
  const job = selectedJob.value;
  return job ? resultsOf(jobs.value, job, historyLength.value) : [];
});

export interface Change {
  name: string;
  from: string;
  to: string;
}

/// What of settings and parameters is another in `to`; the scene itself when that does not tell why it differs.
export function changesBetween(from: Job, to: Job): Change[] {
  const of = (a: object, b: object): Change[] => {
    const [before, after] = [
      new Map<string, unknown>(Object.entries(a)),
      new Map<string, unknown>(Object.entries(b)),
    ];
    const text = (value: unknown): string =>
      value === undefined ? "–" : String(value as string | number | boolean);
    return [...new Set([...before.keys(), ...after.keys()])]
      .map((name) => ({
        name: name.replaceAll("_", " "),
        from: text(before.get(name)),
        to: text(after.get(name)),
      }))
      .filter((change) => change.from !== change.to);
  };
  const parameters = of(from.parameters, to.parameters);
  const unexplained = from.scene_hash !== to.scene_hash && parameters.length === 0;
  const scene = { name: "scene", from: from.scene_hash.slice(0, 8), to: to.scene_hash.slice(0, 8) };
  return [...(unexplained ? [scene] : []), ...parameters, ...of(from.settings, to.settings)];
}

/// By how many results to go, older is positive.
export function step(by: number): void {
  const list = results.peek();
  const at = list.findIndex((job) => job.id === selectedId.peek()) + by;
  const next = list[at];
  if (next) selectedId.value = next.id;
}

/// The first is the newest.
export function choose(slot: number): void {
  const job = results.peek()[slot - 1];
  if (job) selectedId.value = job.id;
}

/// Kept up to date although not shown, so that going there takes no time.
export const pinned = signal<readonly number[]>([]);
export function togglePin(id: number): void {
  pinned.value = pinned.peek().includes(id)
    ? pinned.peek().filter((other) => other !== id)
    : [...pinned.peek(), id];
}
