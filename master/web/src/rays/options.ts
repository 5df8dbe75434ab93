// What of the rays and the scene is shown, and how; this browser remembers it.
import { signal } from "@preact/signals";
import { isBoolean, stored } from "../app/stored";

const remembered = (name: string, initial: boolean) => stored(`rays-${name}`, initial, isBoolean);

export const shown = {
  camera: remembered("camera", true),
  reflected: remembered("reflected", true),
  refracted: remembered("refracted", true),
  shadow: remembered("shadow", true),
  misses: remembered("misses", true),
  normals: remembered("normals", false),
  outliers: remembered("outliers", true),
  boxes: remembered("boxes", true),
  preview: remembered("preview", false),
  cloud: signal(false), // not remembered: it is fetched when it is asked for
  icons: remembered("icons", true),
  axes: remembered("axes", true),
};
export type Shown = keyof typeof shown;

/// Boxes are filled too, not only their edges drawn.
export const filled = remembered("filled", false);

/// How a ray's importance is seen.
export type ImportanceAs = "width" | "opacity" | "nothing";
export const importanceAs = stored<ImportanceAs>("rays-importance", "width", (v) =>
  ["width", "opacity", "nothing"].includes(v as string),
);

/// The view looks along the primary ray, also of the next pixel.
export const keepAligned = signal(false);

export const toggle = (what: Shown): void => {
  shown[what].value = !shown[what].value;
};
