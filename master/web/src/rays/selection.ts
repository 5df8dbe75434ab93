// Which ray is chosen or pointed at, in the tree, the chart or the 3D view alike.
import { computed, signal } from "@preact/signals";
import type { Vec3 } from "../app/types";
import { spreadOf } from "./outliers";
import { answer } from "./probe";
import { entriesOf, type Entry, type RayEntry, type TracedSample } from "./trace";

export const entries = computed<Entry[]>(() => (answer.value ? entriesOf(answer.value.trace) : []));
const byId = computed(() => new Map(entries.value.map((entry) => [entry.id, entry])));
export const entryOf = (id: string | null): Entry | null =>
  id === null ? null : (byId.value.get(id) ?? null);

/// Of the samples' colours.
export const spread = computed(() => spreadOf((answer.value?.trace.samples ?? []).map((sample) => sample.color)));

/// Traced rays of all samples, without those to lights.
export const rayCount = computed(() => entries.value.filter((entry) => entry.what === "ray").length);

const chosen = signal<string | null>(null);
const pointed = signal<string | null>(null);

/// Of the newest answer; a line that it has no more counts as none.
export const selected = computed<Entry | null>(() => entryOf(chosen.value));
export const hovered = computed<Entry | null>(() => entryOf(pointed.value));
export const select = (id: string | null): void => void (chosen.value = id);
export const hover = (id: string | null): void => void (pointed.value = id);

/// Whose record is shown: what is pointed at, else chosen, else the first primary ray.
export const described = computed<Entry | null>(
  () => hovered.value ?? selected.value ?? entries.value[0] ?? null,
);

/// The ray of a line, or the one whose hit asks for the light.
export function rayEntryOf(entry: Entry | null): RayEntry | null {
  for (let at = entry; at; at = entryOf(at.parent)) if (at.what === "ray") return at;
  return null;
}

/// The sample that is looked at: its set operations are charted.
export const sampleShown = computed<TracedSample | null>(() => {
  const index = (selected.value ?? entries.value[0])?.sample;
  return index === undefined ? null : (answer.value?.trace.samples[index] ?? null);
});

/// Places that the chart points at, with the leaf whose box is marked (none for the material).
export interface SpanMark {
  points: Vec3[];
  leaf: number | null;
}
export const spanMark = signal<SpanMark | null>(null);
