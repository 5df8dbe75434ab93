// The numbers that are on the screen: those of a layer, or of the difference that is shown.
import { selectedJob } from "../app/state";
import type { Job } from "../app/types";
import {
  comparison,
  compares,
  currentEntry,
  metric,
  reference,
  referenceEntry,
  shownEntry,
  showsReference,
} from "./compare";
import { comparable, differencesOf, type Metric } from "./difference";
import type { LayerData } from "./layer_data";

export interface ShownValues {
  data: LayerData;
  job: Job;
  difference: { metric: Metric; from: Job } | null;
}

/// What of a difference is shown; null: none is.
export const shownMetric = (): Metric | null =>
  compares.value && !showsReference.value && comparison.value === "difference" ? metric.value : null;

/// Null where there are none: FLIP comes as colours.
export function shownValues(): ShownValues | null {
  const job = showsReference.value ? reference.value : selectedJob.value;
  const kind = shownMetric();
  if (!job) return null;
  if (kind === null) {
    const data = shownEntry.value?.data;
    return data ? { data, job, difference: null } : null;
  }
  const [a, b] = [currentEntry.value?.data, referenceEntry.value?.data];
  if (kind === "flip" || !a || !b || !comparable(a, b)) return null;
  return { data: differencesOf(a, b, kind), job, difference: { metric: kind, from: reference.value! } };
}

/// Reads all that the values depend on.
export const shownStand = (): unknown[] => [
  shownEntry.value?.revision.value,
  shownMetric() && referenceEntry.value?.revision.value,
];
