// What the master counted of a job.
export interface JobStatistics {
  counters: Record<string, number>;
  mean_per_pixel: Record<string, number>;
  samples_per_pixel: number;
  seconds: Record<string, number>;
  rays_wasted?: number; // not known of a single frame
  detail: {
    state: "making" | "done" | "unavailable";
    progress?: number;
    message?: string;
    counters?: Record<string, number>;
    hits?: { leaf: number; name: string; hits: number }[];
    tests?: Record<string, Record<string, number>>; // by kind of ray
  };
}

const titles: Record<string, string> = {
  rays: "all rays",
  bad_samples: "NaN samples",
};
const order = [
  "primary",
  "reflected",
  "refracted",
  "shadow",
  "rays",
  "primary_hits",
  "secondary_hits",
  "misses",
  "lost",
];

/// Names and titles of what was counted, in the order of a ray's life; what is new to us is last.
export function titlesOf(counters: object): [string, string][] {
  const place = (name: string): number => (order.includes(name) ? order.indexOf(name) : order.length);
  const names = Object.keys(counters).sort((a, b) => place(a) - place(b));
  return names.map((name) => [name, titles[name] ?? name.replaceAll("_", " ")]);
}

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
