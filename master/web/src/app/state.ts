// What the whole app shares. Parts keep to themselves what only they need.
import { computed, signal } from "@preact/signals";
import type { Job, LayerChoice, LogLine, MapEntry, Worker } from "./types";

export interface Pixel {
  x: number; // in the job's picture, from the upper left
  y: number;
}

export const jobs = signal<Job[]>([]);
export const workers = signal<Worker[]>([]);
export const log = signal<LogLine[]>([]);
/// All maps that the master can make, as it lists them.
export const maps = signal<MapEntry[]>([]);

/// Of the connection that brings news.
export type Link = "connecting" | "open" | "lost";
export const link = signal<Link>("connecting");
/// Since when it is lost, milliseconds.
export const lostSince = signal<number | null>(null);
/// The master does not know who this browser is.
export const loginWanted = signal(false);
/// Messages of the master that made no sense.
export const malformed = signal(0);

export const selectedId = signal<number | null>(null);
export const selectedJob = computed<Job | null>(
  () => jobs.value.find((job) => job.id === selectedId.value) ?? null,
);
export const layer = signal<LayerChoice>({ layer: "picture", reduce: "majority", compat: false });

const clicked = signal<Pixel | null>(null);
/// Null: none any more.
export const probe = (pixel: Pixel | null): void => void (clicked.value = pixel);
/// The pixel that was clicked last, whose rays are shown; none where the selected job's picture does not reach so far.
export const probed = computed<Pixel | null>(() => {
  const [pixel, size] = [clicked.value, selectedJob.value?.settings];
  return pixel && size && pixel.x < size.width && pixel.y < size.height ? pixel : null;
});
export const raysShown = signal(false);

/// Words for people, newest last; errors stay until they are dismissed.
export interface Notice {
  id: number;
  kind: "error" | "info";
  text: string;
}
export const notices = signal<Notice[]>([]);
let lastNotice = 0;

export function dismiss(id: number): void {
  notices.value = notices.value.filter((notice) => notice.id !== id);
}
export function tell(text: string, kind: Notice["kind"] = "info"): void {
  const id = ++lastNotice;
  notices.value = [...notices.value.filter((notice) => notice.text !== text), { id, kind, text }].slice(-4);
  if (kind === "info") setTimeout(() => dismiss(id), 5000);
}
export function tellError(error: unknown): void {
  tell(error instanceof Error ? error.message : String(error), "error");
}
