import { labelColor } from "./palettes";
import { useSteady } from "./steady";
import { missing } from "./layer_data";
import { currentEntry } from "./compare";
import type { Entry } from "./store";

/// How many pixels have each label.
function shares(entry: Entry | null): Map<number, number> {
  const counts = new Map<number, number>();
  entry?.data?.values.forEach((value, i) => {
    if (entry.data!.there[i] !== missing && Number.isFinite(value))
      counts.set(value, (counts.get(value) ?? 0) + 1);
  });
  return counts;
}

/// Names with their colours and shares of the picture.
export function LabelLegend({ entry }: { entry: Entry }) {
  const counts = useSteady(
    () => currentEntry.value?.revision.value,
    () => shares(currentEntry.value),
  );
  const pixels = entry.data?.there.length ?? 1;
  return (
    <ul class="labels">
      {(entry.message.value?.labels ?? []).map((label, value) => (
        <li key={label}>
          <span class="swatch" style={{ background: `rgb(${labelColor(value).join(" ")})` }} />
          <span class="name">{label}</span>
          <span class="number">{(((counts?.get(value) ?? 0) / pixels) * 100).toFixed(1)} %</span>
        </li>
      ))}
    </ul>
  );
}
