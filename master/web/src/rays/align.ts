// Looking along rays.
import { tell } from "../app/state";
import { diagonalOf } from "./vec";
import { lookAlong } from "./camera";
import { keepAligned } from "./options";
import { box } from "./scene";
import { endOf } from "./segments";
import { entries, rayEntryOf, sampleShown, selected } from "./selection";
import type { TracedRay } from "./trace";
import { lengthOf, minus } from "./vec";

function look(ray: TracedRay): void {
  const reach = lengthOf(minus(endOf(ray, box.value), ray.origin));
  lookAlong(ray.origin, ray.direction, reach > 0 ? reach : diagonalOf(box.value));
}

export function alignWithPrimary(): void {
  const sample = sampleShown.value;
  if (sample) look(sample.ray);
  else tell("Click a pixel of the picture first: its primary ray is what the view is aligned with");
}

export function toggleKeepAligned(): void {
  keepAligned.value = !keepAligned.value;
  if (keepAligned.value && entries.value.length > 0) alignWithPrimary();
}

export function alignWithSelected(): void {
  const entry = rayEntryOf(selected.value);
  if (entry) look(entry.ray);
}
