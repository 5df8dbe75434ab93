// The lines of the newest trace, and those that the toggles let through.
import { computed } from "@preact/signals";
import { shown } from "./options";
import { box } from "./scene";
import { segmentsOf, type Segment } from "./segments";
import { entries } from "./selection";

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
