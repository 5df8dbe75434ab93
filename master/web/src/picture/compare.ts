// Two results side by side, or rather one over the other: the current and the reference.
import { computed, signal } from "@preact/signals";
import { frameOf, frameQuery, shownFrame } from "../app/frames";
import { jobs, layer, selectedId, tell } from "../app/state";
import type { Job, Watch } from "../app/types";
import { metrics, type Metric } from "./difference";
import { results } from "./history";
import { entryOf, type Entry } from "./store";

export type Comparison = "off" | "wipe" | "difference";

const referenceId = signal<number | null>(null);
export const reference = computed<Job | null>(
  () => jobs.value.find((job) => job.id === referenceId.value) ?? null,
);
export const comparison = signal<Comparison>("off");
export const metric = signal<Metric>("absolute");
/// Where the wipe divides the screen, 0 to 1 from the left.
export const wipeAt = signal(0.5);
/// The reference is shown instead: until the next Space, or while Shift is held.
export const flipped = signal(false);
export const shiftHeld = signal(false);

/// A reference other than what is shown.
export const compares = computed(() => reference.value !== null && reference.value.id !== selectedId.value);
export const showsReference = computed(() => compares.value && flipped.value !== shiftHeld.value);

const watchOf = (job: number, frame: number | null): Watch => ({
  job,
  ...(frame !== null && { frame }),
  ...layer.value,
});
export const currentWatch = computed<Watch | null>(() =>
  selectedId.value === null ? null : watchOf(selectedId.value, shownFrame.value),
);
/// The same frame of the reference, if it has that.
export const referenceFrame = computed<number | null>(
  () => reference.value && frameOf(reference.value, shownFrame.value),
);
/// Behind the path of a difference between the two.
export const framesQuery = computed(() =>
  [frameQuery(shownFrame.value, "&"), referenceFrame.value === null ? "" : `&other_frame=${referenceFrame.value}`]
    .join("")
    .replace("&", "?"),
);
export const referenceWatch = computed<Watch | null>(() =>
  compares.value && reference.value ? watchOf(reference.value.id, referenceFrame.value) : null,
);
export const currentEntry = computed<Entry | null>(() => currentWatch.value && entryOf(currentWatch.value));
export const referenceEntry = computed<Entry | null>(
  () => referenceWatch.value && entryOf(referenceWatch.value),
);
/// What the screen shows when nothing is compared.
export const shownEntry = computed<Entry | null>(() =>
  showsReference.value ? referenceEntry.value : currentEntry.value,
);

export function setReference(id: number | null): void {
  referenceId.value = id;
  flipped.value = false;
  if (id === null) comparison.value = "off";
}

/// Without a reference the result before this one is it.
function ensureReference(): boolean {
  if (compares.peek()) return true;
  const list = results.peek();
  const at = list.findIndex((job) => job.id === selectedId.peek());
  const other = list[at + 1] ?? list[at - 1];
  if (other) setReference(other.id);
  else tell("There is nothing to compare with: this scene has one result only");
  return other !== undefined;
}

export function toggleComparison(kind: Exclude<Comparison, "off">): void {
  if (comparison.peek() === kind) comparison.value = "off";
  else if (ensureReference()) comparison.value = kind;
}

export function toggleFlip(): void {
  if (!ensureReference()) return;
  comparison.value = "off";
  flipped.value = !flipped.peek();
}

/// The difference in the next metric; ends after the last.
export function nextMetric(): void {
  if (comparison.peek() !== "difference") {
    metric.value = metrics[0]!;
    toggleComparison("difference");
    return;
  }
  const next = metrics[metrics.indexOf(metric.peek()) + 1];
  if (next && (next !== "flip" || layer.peek().layer === "picture")) metric.value = next;
  else comparison.value = "off";
}
