// How fast the farm is, second by second: from what was delivered, not from what workers say.
import { signal } from "@preact/signals";
import { jobs, link, workers } from "../app/state";
import type { Job, Worker } from "../app/types";

/// What had been delivered at a time.
export interface Tally {
  time: number; // seconds
  samples: Map<number, number>; // by job
  pixels: Map<string, number>; // by worker
}

export function tallyOf(time: number, allJobs: readonly Job[], allWorkers: readonly Worker[]): Tally {
  return {
    time,
    samples: new Map(allJobs.map((job) => [job.id, job.counters.primary])),
    pixels: new Map(allWorkers.map((worker) => [worker.name, worker.pixels])),
  };
}

/// By how much the counts that are in both grew; who begins anew counts from then on.
function growth<Key>(before: Map<Key, number>, after: Map<Key, number>, key: Key): number {
  const from = before.get(key);
  return from === undefined ? 0 : Math.max(0, (after.get(key) ?? from) - from);
}

/// Samples a second of all jobs.
export function farmRate(before: Tally, after: Tally): number {
  let sum = 0;
  for (const id of after.samples.keys()) sum += growth(before.samples, after.samples, id);
  return sum / (after.time - before.time);
}
/// Pixels a second of one worker.
export function workerRate(before: Tally, after: Tally, name: string): number {
  return growth(before.pixels, after.pixels, name) / (after.time - before.time);
}

const kept = 300; // seconds
const smoothed = 3; // seconds: tiles come in bursts

export interface Rates {
  times: number[]; // seconds
  farm: (number | null)[]; // null: the master was out of reach
  workers: Map<string, number[]>;
}
export const rates = signal<Rates>({ times: [], farm: [], workers: new Map() });

const newest = <T>(list: readonly T[], item: T): T[] => [...list, item].slice(-kept);

let tallies: Tally[] = [];

function sample(): void {
  const old = rates.value;
  const tally = tallyOf(Date.now() / 1000, jobs.value, workers.value);
  const before = tallies[0];
  const reached = link.value === "open";
  tallies = reached ? [...tallies, tally].slice(-smoothed) : [];
  if (!before) return;
  rates.value = {
    times: newest(old.times, tally.time),
    farm: newest(old.farm, reached ? farmRate(before, tally) : null),
    workers: new Map(
      workers.value.map(({ name }) => [
        name,
        newest(old.workers.get(name) ?? [], reached ? workerRate(before, tally, name) : 0),
      ]),
    ),
  };
}

export function startThroughput(): void {
  setInterval(sample, 1000);
}
