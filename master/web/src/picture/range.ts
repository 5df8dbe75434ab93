// Which values get the lowest and the highest colour, and where those between lie.
import type { MapEntry, Scale } from "../app/types";

export interface Range {
  low: number;
  high: number;
}

export type RangeMode = "auto" | "fixed" | "percentile";

/// How a map is shown.
export interface Shown extends Range {
  palette: number; // in the scale kind's list
  log: boolean;
  mode: RangeMode; // low, high: of fixed
}

export const initiallyShown = (scale: Scale): Shown => ({
  palette: 0,
  log: scale === "depth",
  mode: "auto",
  low: 0,
  high: 1,
});

/// What counts as one step on a logarithmic scale: the finest difference that matters.
export function logStep(entry: Pick<MapEntry, "unit">): number {
  return entry.unit === "seconds" ? 1e-6 : 1;
}

/// 0 for low to 1 for high. The logarithm is that of the original renderer's depth map, which starts at low and
/// so needs no positive values. When all is one value, counts are highest and depths nearest, as there.
export function positionOf(value: number, range: Range, log: boolean, step: number, scale: Scale): number {
  if (!(range.high > range.low)) return scale === "depth" ? 0 : 1;
  const share = (value - range.low) / (range.high - range.low);
  if (!log) return share;
  return Math.log(1 + Math.max(0, value - range.low) / step) / Math.log(1 + (range.high - range.low) / step);
}

/// The value at a position: the inverse.
export function valueAt(position: number, range: Range, log: boolean, step: number): number {
  if (!log) return range.low + position * (range.high - range.low);
  return range.low + step * (Math.exp(position * Math.log(1 + (range.high - range.low) / step)) - 1);
}

/// At most `most` round numbers within the range: 1, 2 or 5 times a power of ten apart on a linear scale, else
/// round numbers near even places.
export function ticksOf(range: Range, log: boolean, step: number, most: number): number[] {
  const span = range.high - range.low;
  if (!(span > 0)) return [range.low];
  if (log) {
    const places = Array.from({ length: most }, (_, i) => valueAt(i / (most - 1), range, log, step));
    const round = places.map((value) => Number(value.toPrecision(2)));
    return [...new Set(round)].filter((value) => value >= range.low && value <= range.high);
  }
  const rough = span / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const apart = ([1, 2, 5, 10].find((n) => n * power >= rough) ?? 10) * power;
  const first = Math.ceil(range.low / apart - 1e-9);
  const last = Math.floor(range.high / apart + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * apart).toPrecision(12)));
}
