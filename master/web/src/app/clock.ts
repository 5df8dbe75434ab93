// The time as people see it pass: ages and ETAs that are read from it go on between the master's messages.
import { signal } from "@preact/signals";

/// Milliseconds, a step each second.
export const now = signal(Date.now());

/// When the master said how old these are.
const heard = new WeakMap<object, number>();

export function hear(items: readonly object[], time: number): void {
  for (const item of items) heard.set(item, time);
}
/// When it happened, milliseconds.
export function timeOf(item: { age_seconds: number }): number {
  return (heard.get(item) ?? Date.now()) - item.age_seconds * 1000;
}
/// Seconds.
export function ageOf(item: { age_seconds: number }): number {
  return item.age_seconds + Math.max(0, now.value - (heard.get(item) ?? now.value)) / 1000;
}

export function startClock(): void {
  setInterval(() => (now.value = Date.now()), 1000);
}
