// The values at the pointer, the cursor, or else the probed pixel, in words.
import { layer, probed, type Pixel } from "../app/state";
import type { MapEntry } from "../app/types";
import { compares, comparison, currentEntry, referenceEntry, showsReference } from "./compare";
import { shownMap } from "./display";
import { fixed, plain, timeText } from "./format";
import type { Entry } from "./store";
import { camera, viewAngle } from "./view_angle";
import { cursor, hovered, pictureSize } from "./view_state";

export interface Readout {
  pixel: Pixel;
  values: string; // "R 0.25 G 0.5 B 1", "12.25 scene units"
  other: string; // of the reference; "" without one
  preview: boolean; // not the pixel's own value yet
}

function numberOf(entry: Entry, map: MapEntry, value: number): string {
  if (map.scale === "label") return entry.message.value?.labels?.[value] ?? `no. ${plain(value)}`;
  if (!Number.isFinite(value) && !Number.isNaN(value)) return "nothing";
  if (map.unit === "seconds") return timeText(value);
  return map.scale === "depth" ? `${fixed(value, 4)} ${map.unit}` : `${plain(value, 6)} ${map.unit}`;
}

function normalText(values: Float32Array, pixel: Pixel, map: MapEntry): string {
  if (!Number.isFinite(values[0]!)) return "nothing";
  const size = pictureSize.value;
  const inCamera = map.name.endsWith("camera");
  // The original's formula is in no axes, so there is no angle to tell.
  const told = camera.value && size && !(inCamera && layer.value.compat);
  const angle = told ? viewAngle(camera.value!, size, pixel, values, inCamera ? "camera" : "world") : null;
  const vector = `(${[...values].map((value) => fixed(value, 4)).join(", ")})`;
  return angle === null ? vector : `${vector}  ${fixed(angle, 1)}° to the view`;
}

export function valuesText(entry: Entry, pixel: Pixel): string {
  void entry.revision.value;
  const step = entry.data?.step ?? 1;
  const values = entry.data?.at(Math.floor(pixel.x / step), Math.floor(pixel.y / step));
  if (!values) return "not there yet";
  const map = shownMap.value;
  if (!map) return ["R", "G", "B"].map((name, c) => `${name} ${plain(values[c]!, 6)}`).join("  ");
  return map.channels === 3 ? normalText(values, pixel, map) : numberOf(entry, map, values[0]!);
}

export function readoutAt(pixel: Pixel): Readout | null {
  const [current, reference] = [currentEntry.value, compares.value ? referenceEntry.value : null];
  const first = showsReference.value ? reference : current;
  if (!first) return null;
  const step = first.data?.step ?? 1;
  const both = reference && !showsReference.value && comparison.value !== "off";
  return {
    pixel,
    values: valuesText(first, pixel),
    other: both ? valuesText(reference, pixel) : "",
    preview:
      first.data !== null && !first.data.isExact(Math.floor(pixel.x / step), Math.floor(pixel.y / step)),
  };
}

export const pointedAt = (): Pixel | null => hovered.value ?? cursor.value ?? probed.value;
