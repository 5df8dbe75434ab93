// What the master counted of a job.
import type { Counters } from "../app/types";

export interface JobStatistics {
  counters: Counters;
  mean_per_pixel: Partial<Record<keyof Counters, number>>;
  samples_per_pixel: number;
  seconds: Record<string, number>;
  detail: {
    state: "making" | "done" | "unavailable";
    progress?: number;
    message?: string;
    hits?: { leaf: number; name: string; hits: number }[];
    tests?: Record<string, number>;
  };
}

/// In the order of a ray's life.
export const counterTitles: [keyof Counters, string][] = [
  ["primary", "primary"],
  ["reflected", "reflected"],
  ["refracted", "refracted"],
  ["shadow", "shadow"],
  ["rays", "all rays"],
  ["primary_hits", "primary hits"],
  ["secondary_hits", "secondary hits"],
  ["misses", "misses"],
  ["lost", "lost"],
  ["bad_samples", "NaN samples"],
];

export interface Hits {
  name: string;
  hits: number;
  solids: number; // of this name
}

/// The most hit first; solids of one name together.
export function hitsByName(hits: readonly { name: string; hits: number }[]): Hits[] {
  const byName = new Map<string, Hits>();
  for (const each of hits) {
    const sum = byName.get(each.name) ?? { name: each.name, hits: 0, solids: 0 };
    byName.set(each.name, { name: each.name, hits: sum.hits + each.hits, solids: sum.solids + 1 });
  }
  return [...byName.values()].sort((a, b) => b.hits - a.hits);
}
