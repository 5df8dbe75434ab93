// Lists that come anew each time, mostly unchanged: what did not change stays the same object, so that its row
// is not drawn again.

export function same(a: unknown, b: unknown): boolean {
  if (a === b) return true;
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return false;
  const left = a as Record<string, unknown>;
  const right = b as Record<string, unknown>;
  const keys = Object.keys(left);
  if (keys.length !== Object.keys(right).length) return false;
  // An age always changes; it is counted on from when it was heard.
  return keys.every((key) => key === "age_seconds" || (key in right && same(left[key], right[key])));
}

/// The new list with the old objects wherever nothing but the age differs.
export function reconcile<T extends object>(
  old: readonly T[],
  fresh: readonly T[],
  key: (item: T) => unknown,
): T[] {
  const known = new Map(old.map((item) => [key(item), item]));
  return fresh.map((item) => {
    const before = known.get(key(item));
    return before && same(before, item) ? before : item;
  });
}
