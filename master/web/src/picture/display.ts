// How values become colours on the screen. Nothing here changes a value.
import { computed, signal } from "@preact/signals";
import { layer, maps } from "../app/state";
import { stored } from "../app/stored";
import type { MapEntry } from "../app/types";
import { initiallyShown, type Shown } from "./range";

export type Tone = "gamma" | "srgb" | "reinhard" | "aces" | "false" | "signed";
export const tones: Record<Tone, string> = {
  gamma: "gamma, as the PNG",
  srgb: "sRGB",
  reinhard: "Reinhard",
  aces: "ACES (fit)",
  false: "false colour",
  signed: "− / +",
};

export interface Display {
  exposure: number; // stops
  offset: number; // added after it
  gamma: number;
  tone: Tone;
  clip: boolean; // to 0..1 before the tone
  zebra: boolean; // stripes where it would be clipped
}
export const initialDisplay: Display = {
  exposure: 0,
  offset: 0,
  gamma: 2.2,
  tone: "gamma",
  clip: false,
  zebra: false,
};
export const display = signal<Display>(initialDisplay);

const rounded = (value: number): number => Number(value.toFixed(4));
export function adjust(change: Partial<Display>): void {
  const next = { ...display.peek(), ...change };
  display.value = {
    ...next,
    exposure: rounded(Math.min(Math.max(next.exposure, -20), 20)),
    offset: rounded(Math.min(Math.max(next.offset, -100), 100)),
    gamma: rounded(Math.min(Math.max(next.gamma, 0.2), 5)),
  };
}

export function nextTone(): void {
  const names = Object.keys(tones) as Tone[];
  adjust({ tone: names[(names.indexOf(display.peek().tone) + 1) % names.length]! });
}

/// Of the chosen layer; null: the picture.
export const shownMap = computed<MapEntry | null>(
  () => maps.value.find((entry) => entry.name === layer.value.layer) ?? null,
);

/// Of each map that was changed, by name.
const shownByName = signal<Record<string, Shown>>({});
export const shownOf = (entry: MapEntry): Shown =>
  shownByName.value[entry.name] ?? initiallyShown(entry.scale);
export function adjustMap(entry: MapEntry, change: Partial<Shown>): void {
  shownByName.value = { ...shownByName.peek(), [entry.name]: { ...shownOf(entry), ...change } };
}
export function resetMap(entry: MapEntry): void {
  const others = Object.entries(shownByName.peek()).filter(([name]) => name !== entry.name);
  shownByName.value = Object.fromEntries(others);
}

const isBoolean = (value: unknown): boolean => typeof value === "boolean";
export const valuesShown = stored("picture.values", true, isBoolean);
export const gridShown = stored("picture.grid", true, isBoolean);
