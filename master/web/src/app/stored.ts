// Signals that this browser remembers.
import { effect, signal, type Signal } from "@preact/signals";

/// A signal whose value is kept under the name; `fits` refuses what an older version may have left there.
export function stored<T>(name: string, initial: T, fits: (value: unknown) => boolean): Signal<T> {
  const key = `rayfarm.${name}`;
  const kept = signal(initial);
  try {
    const value = JSON.parse(localStorage.getItem(key) ?? "null") as unknown;
    if (fits(value)) kept.value = value as T;
  } catch {
    // no storage, or not ours: the initial value
  }
  effect(() => {
    const text = JSON.stringify(kept.value);
    try {
      localStorage.setItem(key, text);
    } catch {
      // private windows may have none
    }
  });
  return kept;
}

export const isShare = (value: unknown): boolean => typeof value === "number" && value > 0 && value < 1;
export const isPixels = (value: unknown): boolean =>
  typeof value === "number" && value >= 0 && value < 10_000;
export const isBoolean = (value: unknown): boolean => typeof value === "boolean";
