// The lines of the newest trace, and those that the toggles let through.
import { computed } from "@preact/signals";
import { shown } from "./options";
import { box } from "./scene";
import { segmentsOf, type Segment } from "./segments";
import { entries, entryOf, spread } from "./selection";

export const allSegments = computed<Segment[]>(() => segmentsOf(entries.value, box.value));

export const segmentsShown = computed<Segment[]>(() => {
  const visible = {
    camera: shown.camera.value,
    reflected: shown.reflected.value,
    refracted: shown.refracted.value,
    shadow: shown.shadow.value,
    blocked: shown.shadow.value,
  };
  const misses = shown.misses.value;
  return allSegments.value.filter((segment) => visible[segment.stroke] && (misses || !segment.missed));
});

/// Of the samples that stand out, without their rays to lights.
export const outlierSegments = computed<Segment[]>(() => {
  if (!shown.outliers.value) return [];
  const { outliers } = spread.value;
  return segmentsShown.value.filter(
    ({ entry, stroke }) =>
      stroke !== "shadow" && stroke !== "blocked" && outliers[entryOf(entry)?.sample ?? -1] === true,
  );
});
