// Samples of a pixel that stand out, as fireflies do.
import type { Vec3 } from "../app/types";

const luminanceOf = ([r, g, b]: Vec3): number => 0.2126 * r + 0.7152 * g + 0.0722 * b; // Rec. 709

export const outlierRule =
  "luminance more than 2 standard deviations, and 1 %, from the mean of the pixel's samples";

export interface Spread {
  mean: number;
  deviation: number;
  outliers: boolean[]; // by sample
}

/// Of few samples none can be an outlier; differences that nobody sees are none.
export function spreadOf(colors: readonly Vec3[]): Spread {
  const values = colors.map(luminanceOf);
  const mean = values.reduce((sum, value) => sum + value, 0) / Math.max(values.length, 1);
  const squares = values.reduce((sum, value) => sum + (value - mean) ** 2, 0);
  const deviation = Math.sqrt(squares / Math.max(values.length, 1));
  const limit = Math.max(2 * deviation, 0.01 * Math.abs(mean));
  return { mean, deviation, outliers: values.map((v) => Math.abs(v - mean) > limit) };
}
