// How two layers of the same size differ.
import { LayerData, missing, type Rect } from "./layer_data";

export type Metric = "absolute" | "signed" | "relative" | "flip";
export const metrics: Metric[] = ["absolute", "signed", "relative", "flip"];
export const metricNames: Record<Metric, string> = {
  absolute: "|a − b|",
  signed: "a − b",
  relative: "|a − b| / |b|",
  flip: "ꟻLIP",
};

/// Keeps relative differences of almost nothing finite.
export const relativeFloor = 0.01;

/// a: current, b: reference. Equal infinities do not differ.
export function differenceOf(a: number, b: number, metric: Metric): number {
  if (a === b) return 0;
  if (metric === "signed") return a - b;
  const absolute = Math.abs(a - b);
  return metric === "relative" ? absolute / (Math.abs(b) + relativeFloor) : absolute;
}

export interface Errors {
  rmse: number;
  mae: number;
  max: number;
  compared: number; // values
  apart: number; // values that are a number in one and none in the other
}

export const comparable = (a: LayerData, b: LayerData): boolean =>
  a.width === b.width && a.height === b.height && a.channels === b.channels && a.step === b.step;

/// Of two that are comparable: there where both are.
export function differencesOf(a: LayerData, b: LayerData, metric: Exclude<Metric, "flip">): LayerData {
  const made = new LayerData(a.width, a.height, a.channels, a.step);
  for (let i = 0; i < a.there.length; ++i)
    made.there[i] = a.there[i] === missing || b.there[i] === missing ? missing : Math.max(a.there[i]!, b.there[i]!);
  for (let i = 0; i < a.values.length; ++i) made.values[i] = differenceOf(a.values[i]!, b.values[i]!, metric);
  return made;
}

/// Over the values that are there in both; those that are finite in neither are equal.
export function errorsOf(a: LayerData, b: LayerData, area: Rect): Errors {
  const errors = { rmse: 0, mae: 0, max: 0, compared: 0, apart: 0 };
  for (let y = area.y; y < area.y + area.height; ++y)
    for (let x = area.x; x < area.x + area.width; ++x) {
      const i = y * a.width + x;
      if (a.there[i] === missing || b.there[i] === missing) continue;
      for (let c = 0; c < a.channels; ++c)
        add(errors, a.values[i * a.channels + c]!, b.values[i * b.channels + c]!);
    }
  const n = Math.max(1, errors.compared);
  return { ...errors, rmse: Math.sqrt(errors.rmse / n), mae: errors.mae / n };
}

function add(errors: Errors, a: number, b: number): void {
  if (!Number.isFinite(a) && !Number.isFinite(b)) return;
  if (!Number.isFinite(a) || !Number.isFinite(b)) {
    ++errors.apart;
    return;
  }
  const d = Math.abs(a - b);
  ++errors.compared;
  errors.rmse += d * d;
  errors.mae += d;
  if (d > errors.max) errors.max = d;
}
