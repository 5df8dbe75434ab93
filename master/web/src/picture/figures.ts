// Figures of the layers on the screen, made when they are looked at and again only when the numbers changed.
import type { MapEntry } from "../app/types";
import { errorsOf, comparable, type Errors } from "./difference";
import { whole } from "./layer_data";
import type { Range, Shown } from "./range";
import { percentilesOf } from "./statistics";
import type { Entry } from "./store";

/// The last result for each entry.
function remembered<T>(make: (entry: Entry) => T): (entry: Entry) => T {
  const kept = new WeakMap<Entry, { revision: number; value: T }>();
  return (entry) => {
    const revision = entry.revision.value;
    let found = kept.get(entry);
    if (found?.revision !== revision) kept.set(entry, (found = { revision, value: make(entry) }));
    return found.value;
  };
}

/// What all but the outermost hundredths lie in.
const middle = remembered((entry): Range | null => {
  const range = entry.data && percentilesOf(entry.data, 0, 0.01, 0.99);
  return range && { low: range[0], high: range[1] };
});

export function rangeOf(entry: Entry, map: MapEntry, shown: Shown): Range {
  if (shown.mode === "fixed") return { low: shown.low, high: shown.high };
  if (shown.mode === "percentile" && map.channels === 1) return middle(entry) ?? { low: 0, high: 1 };
  const [low, high] = entry.message.value?.range ?? [0, 1];
  return { low, high };
}

let errorsKept: { key: unknown[]; errors: Errors } | null = null;

/// Of two entries; null when they cannot be compared.
export function errorsBetween(a: Entry, b: Entry): Errors | null {
  const key = [a, b, a.revision.value, b.revision.value];
  if (!a.data || !b.data || !comparable(a.data, b.data)) return null;
  if (!errorsKept || errorsKept.key.some((each, i) => each !== key[i]))
    errorsKept = { key, errors: errorsOf(a.data, b.data, whole(a.data)) };
  return errorsKept.errors;
}
