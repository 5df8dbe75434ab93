// Colours for the values of maps. A new map needs nothing here: its scale kind, as the master lists it, decides.
import type { Scale } from "../app/types";

export type Rgb = [number, number, number]; // 0 to 255, as shown
/// For positions from 0 (low) to 1 (high).
export type Palette = (t: number) => Rgb;

/// Hue 240 (blue) for the lowest to 0 (red) for the highest, full colours: the original renderer's counts.
export function rainbow(t: number): Rgb {
  const sextant = (240 - 240 * Math.min(Math.max(t, 0), 1)) / 60;
  const part = sextant - Math.floor(sextant);
  const up = Math.floor(255 * part + 0.5);
  const down = Math.floor(255 * (1 - part) + 0.5);
  if (sextant < 1) return [255, up, 0];
  if (sextant < 2) return [down, 255, 0];
  if (sextant < 3) return [0, 255, up];
  if (sextant < 4) return [0, down, 255];
  return [up, 0, 255];
}

/// White for the nearest, black for the farthest: the original renderer's depths.
export function nearWhite(t: number): Rgb {
  const grey = 255 - Math.floor(255 * Math.min(Math.max(t, 0), 1));
  return [grey, grey, grey];
}

export function grey(t: number): Rgb {
  const value = Math.round(255 * Math.min(Math.max(t, 0), 1));
  return [value, value, value];
}

function polynomial(coefficients: readonly Rgb[]): Palette {
  return (t) => {
    const x = Math.min(Math.max(t, 0), 1);
    const channel = (c: 0 | 1 | 2): number => {
      const value = coefficients.reduceRight((sum, each) => sum * x + each[c], 0);
      return Math.round(255 * Math.min(Math.max(value, 0), 1));
    };
    return [channel(0), channel(1), channel(2)];
  };
}

/// Source: M. Zucker's fit of matplotlib's viridis (S. van der Walt, N. Smith, 2015), shadertoy.com/view/WlfXRN, CC0.
export const viridis = polynomial([
  [0.2777273272234177, 0.005407344544966578, 0.3340998053353061],
  [0.1050930431085774, 1.404613529898575, 1.384590162594685],
  [-0.3308618287255563, 0.214847559468213, 0.09509516302823659],
  [-4.634230498983486, -5.799100973351585, -19.33244095627987],
  [6.228269936347081, 14.17993336680509, 56.69055260068105],
  [4.776384997670288, -13.74514537774601, -65.35303263337234],
  [-5.435455855934631, 4.645852612178535, 26.3124352495832],
]);

/// Source: A. Mikhailov, R. Du, "Turbo, an improved rainbow colormap", Google, 2019: their polynomial fit, Apache 2.0.
export const turbo = polynomial([
  [0.13572138, 0.09140261, 0.1066733],
  [4.6153926, 2.19418839, 12.64194608],
  [-42.66032258, 4.84296658, -60.58204836],
  [132.13108234, -14.18503333, 110.36276771],
  [-152.94239396, 4.27729857, -89.90310912],
  [59.28637943, 2.82956604, 27.34824973],
]);

/// Blue for the lowest over a dark middle to orange for the highest: signed differences.
export function diverging(t: number): Rgb {
  const s = 2 * Math.min(Math.max(t, 0), 1) - 1;
  const strength = Math.sqrt(Math.abs(s));
  const [r, g, b]: Rgb = s < 0 ? [70, 150, 255] : [255, 150, 50];
  return [Math.round(r * strength), Math.round(g * strength), Math.round(b * strength)];
}

/// Hues a golden angle apart: neighbours in number differ most.
export function labelColor(value: number): Rgb {
  const turns = value * 0.6180339887;
  return rainbow(turns - Math.floor(turns));
}

/// Of a unit normal; facing the usual camera is blue. As the original renderer.
export function normalColor(n: ArrayLike<number>): Rgb {
  if (!Number.isFinite(n[0]!)) return [0, 0, 0];
  const byte = (component: number): number => Math.floor((component + 1) * 127.499);
  return [byte(n[0]!), byte(n[1]!), 255 - byte(n[2]!)];
}

export interface NamedPalette {
  name: string; // as listed
  of: Palette;
}

const reversed =
  (palette: Palette): Palette =>
  (t) =>
    palette(1 - t);

/// What maps of a scale kind can be shown in, the original's first; none: the colours are fixed.
export const palettes: Record<Scale, NamedPalette[]> = {
  depth: [
    { name: "near white", of: nearWhite },
    { name: "viridis", of: reversed(viridis) },
    { name: "turbo", of: reversed(turbo) },
  ],
  count: [
    { name: "rainbow", of: rainbow },
    { name: "viridis", of: viridis },
    { name: "turbo", of: turbo },
    { name: "grey", of: grey },
  ],
  normal: [],
  label: [],
};

/// Colours in a row from low to high, four bytes each.
export function tableOf(palette: Palette, entries: number): Uint8Array {
  const bytes = new Uint8Array(entries * 4);
  for (let i = 0; i < entries; ++i) bytes.set([...palette(i / (entries - 1)), 255], 4 * i);
  return bytes;
}

/// One colour for each label, repeated when there are more.
export function labelTable(entries: number): Uint8Array {
  const bytes = new Uint8Array(entries * 4);
  for (let i = 0; i < entries; ++i) bytes.set([...labelColor(i), 255], 4 * i);
  return bytes;
}
