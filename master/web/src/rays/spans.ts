// The chart of where a ray is inside each leaf and inside the material: rows of bars over the distance.
import type { CsgStory, Stretch } from "./trace";

export interface Bar {
  from: number; // share of the chart's width, 0 to 1
  to: number;
  in: number; // distances along the ray
  out: number | null;
  startsInside: boolean;
  endless: boolean; // cut at the chart's end
}

export interface Row {
  leaf: number | null; // null: the material, what the set operations make of the leaves
  name: string;
  bars: Bar[];
}

export interface Chart {
  from: number; // distance at the left edge
  to: number;
  rows: Row[];
  ticks: number[];
}

/// The leaves in the order in which the ray meets them, the material last.
export function chartOf(story: CsgStory, hitDistance: number | null): Chart {
  const stretches = [...story.leaves.flatMap((leaf) => leaf.stretches), ...story.material];
  const marks = stretches.flatMap((s) => (s.out === null ? [s.in] : [s.in, s.out])).filter((t) => t > 0);
  if (hitDistance !== null) marks.push(hitDistance);
  const first = marks.reduce((a, b) => Math.min(a, b), Infinity);
  const last = marks.reduce((a, b) => Math.max(a, b), 0) || 1;
  // What comes before the first crossing is left out where it would press the others together.
  const pressed = first > 0.5 * last && last - first > 1e-6 * last && !stretches.some((s) => s.in === 0);
  const from = pressed ? first - (last - first) * 0.08 : 0;
  const to = last + (last - from) * 0.08;

  const barOf = (s: Stretch): Bar => ({
    from: Math.max(0, (s.in - from) / (to - from)),
    to: s.out === null ? 1 : (s.out - from) / (to - from),
    in: s.in,
    out: s.out,
    startsInside: s.in === 0,
    endless: s.out === null,
  });
  const leaves = [...story.leaves].sort((a, b) => (a.stretches[0]?.in ?? 0) - (b.stretches[0]?.in ?? 0));
  const rows: Row[] = leaves.map(({ leaf, name, stretches }) => ({ leaf, name, bars: stretches.map(barOf) }));
  rows.push({ leaf: null, name: "material", bars: story.material.map(barOf) });
  return { from, to, rows, ticks: ticksOf(from, to) };
}

/// Round numbers, three to eight of them.
export function ticksOf(from: number, to: number): number[] {
  const rough = (to - from) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * (rough < 1.5 * power ? 1 : rough < 3.5 * power ? 2 : rough < 7.5 * power ? 5 : 10);
  const ticks: number[] = [];
  for (let i = Math.ceil(from / step); i * step <= to; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}
