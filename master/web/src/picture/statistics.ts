// Figures of the values in an area of a layer.
import { missing, type LayerData, type Rect } from "./layer_data";

export interface Figures {
  min: number; // of the finite values, as all here; NaN when there are none
  max: number;
  mean: number;
  sum: number;
  finite: number;
  infinite: number;
  nans: number;
  absent: number; // not there yet
}

export function figuresOf(data: LayerData, channel: number, area: Rect): Figures {
  const { values, there, width, channels } = data;
  let [min, max, sum, finite, infinite, nans] = [Infinity, -Infinity, 0, 0, 0, 0];
  for (let y = area.y; y < area.y + area.height; ++y)
    for (let i = y * width + area.x; i < y * width + area.x + area.width; ++i) {
      if (there[i] === missing) continue;
      const value = values[i * channels + channel]!;
      if (Number.isFinite(value)) {
        ++finite;
        sum += value;
        if (value < min) min = value;
        if (value > max) max = value;
      } else if (value === value) ++infinite;
      else ++nans;
    }
  const absent = area.width * area.height - finite - infinite - nans;
  if (finite === 0) return { min: NaN, max: NaN, mean: NaN, sum: 0, finite, infinite, nans, absent };
  return { min, max, mean: sum / finite, sum, finite, infinite, nans, absent };
}

/// How many finite values lie in each of `bins` equal parts of 0 to 1, where `place` puts them; those outside are
/// not counted.
export function histogramOf(
  data: LayerData,
  channel: number,
  area: Rect,
  place: (value: number) => number,
  bins: number,
): number[] {
  const { values, there, width, channels } = data;
  const counts = new Array<number>(bins).fill(0);
  for (let y = area.y; y < area.y + area.height; ++y)
    for (let i = y * width + area.x; i < y * width + area.x + area.width; ++i) {
      if (there[i] === missing) continue;
      const value = values[i * channels + channel]!;
      const share = Number.isFinite(value) ? place(value) : NaN;
      if (share >= 0 && share <= 1) counts[Math.min(bins - 1, Math.floor(share * bins))]! += 1;
    }
  return counts;
}

/// The values below which the shares `from` and `to` (0 to 1) of the finite values lie, of at most 65,536 of them,
/// evenly taken. Null when there are none.
export function percentilesOf(
  data: LayerData,
  channel: number,
  from: number,
  to: number,
): [number, number] | null {
  const every = Math.max(1, Math.ceil(data.there.length / 65536));
  const some: number[] = [];
  for (let i = 0; i < data.there.length; i += every) {
    const value = data.values[i * data.channels + channel]!;
    if (data.there[i] !== missing && Number.isFinite(value)) some.push(value);
  }
  if (some.length === 0) return null;
  const sorted = Float64Array.from(some).sort();
  const pick = (share: number): number => sorted[Math.round(share * (sorted.length - 1))]!;
  return [pick(from), pick(to)];
}
