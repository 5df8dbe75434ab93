// What colours a layer gets, from the settings of its kind.
import type { MapEntry } from "../app/types";
import { initialDisplay, type Display, type Tone } from "./display";
import type { Errors, Metric } from "./difference";
import type { Look } from "./painter";
import { diverging, labelTable, palettes, tableOf, viridis, type Palette } from "./palettes";
import { logStep, type Range, type Shown } from "./range";
import { paletteEntries } from "./shader";

const tables = new Map<Palette, Uint8Array>();
function table(palette: Palette): Uint8Array {
  let made = tables.get(palette);
  if (!made) tables.set(palette, (made = tableOf(palette, paletteEntries)));
  return made;
}
const labels = labelTable(paletteEntries);

const toneTables: Partial<Record<Tone, Palette>> = { false: viridis, signed: diverging };

const base: Look = {
  kind: "picture",
  display: initialDisplay,
  table: table(viridis),
  low: 0,
  high: 1,
  logStep: 0,
  flatPosition: 1,
  nothingIsBlack: false,
};

export const pictureLook = (display: Display): Look => ({
  ...base,
  display,
  table: table(toneTables[display.tone] ?? viridis),
});

export const plainLook: Look = { ...base, kind: "plain" };

export function paletteOf(entry: MapEntry, shown: Shown): Palette | null {
  const list = palettes[entry.scale];
  return list[Math.min(shown.palette, list.length - 1)]?.of ?? null;
}

export function mapLook(entry: MapEntry, shown: Shown, range: Range): Look {
  const look = { ...base, ...range, nothingIsBlack: true };
  if (entry.scale === "normal") return { ...look, kind: "normal" };
  if (entry.scale === "label") return { ...look, kind: "label", table: labels };
  return {
    ...look,
    kind: "scalar",
    table: table(paletteOf(entry, shown) ?? viridis),
    logStep: shown.log ? logStep(entry) : 0,
    flatPosition: entry.scale === "depth" ? 0 : 1,
  };
}

/// Differences of pictures are seen through the same exposure and tone, but for their signs; those of maps over
/// their own range.
export function differenceLook(
  isPicture: boolean,
  display: Display,
  metric: Metric,
  errors: Errors | null,
): Look {
  const most = isPicture ? 2 ** -display.exposure : metric === "relative" ? 1 : (errors?.max ?? 1);
  if (metric === "signed")
    return { ...base, kind: "scalar", table: table(diverging), low: -most, high: most, flatPosition: 0.5 };
  if (isPicture) return pictureLook(display);
  return { ...base, kind: "scalar", table: table(viridis), low: 0, high: most, flatPosition: 0 };
}
