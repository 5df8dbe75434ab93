// Files of what is shown, made by the master from its own numbers where it can.
import { getBlob, getMade } from "../app/api";
import { chosenFrame, frameOf, frameQuery, shownFrame } from "../app/frames";
import { layer, selectedJob, tell, tellError } from "../app/state";
import type { Job, LayerChoice, MapEntry } from "../app/types";
import { currentEntry } from "./compare";
import { csvOf } from "./csv";
import { shownMap, shownOf } from "./display";
import { rangeOf } from "./figures";
import { lookOf } from "./frame";
import type { LayerData } from "./layer_data";
import { Painter, type Look } from "./painter";
import { palettes, viridis } from "./palettes";
import type { Range, Shown } from "./range";
import { areaIn, selection } from "./selection";
import { shownValues } from "./shown_values";

export type Format = "png" | "exr" | "csv";

/// The name the master has for these colours; null when it has none.
export function masterScale(map: MapEntry, shown: Shown): "original" | "perceptual" | null {
  if (map.scale === "normal" || map.scale === "label") return "original";
  if (shown.log !== (map.scale === "depth")) return null;
  if (shown.palette === 0) return "original";
  return map.scale === "count" && palettes.count[shown.palette]?.of === viridis ? "perceptual" : null;
}

export function mapPath(
  job: number,
  choice: LayerChoice,
  map: MapEntry,
  format: Format,
  shown: Shown,
  range: Range,
  frame: number | null = null,
): string {
  const query = new URLSearchParams({ format });
  if (frame !== null) query.set("frame", String(frame));
  if (map.reduces) query.set("reduce", choice.reduce);
  if (map.compat && choice.compat) query.set("compat", "1");
  if (format === "png" && palettes[map.scale].length > 0) {
    query.set("scale", masterScale(map, shown) ?? "original");
    if (shown.mode !== "auto") {
      query.set("low", String(range.low));
      query.set("high", String(range.high));
    }
  }
  return `/jobs/${job}/maps/${map.name}?${query.toString()}`;
}

/// In colours that only this view has, pixel for pixel.
async function paintedPng(data: LayerData, look: Look): Promise<Blob> {
  const canvas = new OffscreenCanvas(data.width, data.height);
  const part = {
    data,
    look,
    other: null,
    metric: "none",
    origin: { x: 0, y: 0 },
    texel: 1,
    grid: 0,
  } as const;
  new Painter(canvas).paint(data, 1, [0, 0, 0], [{ ...part, left: 0, right: data.width }]);
  return canvas.convertToBlob({ type: "image/png" });
}

/// Of what is shown of the job.
export const baseName = (job: Job): string => {
  const frame = frameOf(job, chosenFrame.peek());
  return `${job.name.replace(/[^\w.-]+/g, "_")}-${job.id}${frame === null ? "" : `-frame-${frame}`}`;
};

export function download(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

async function makeAndSave(path: string, name: string): Promise<void> {
  let told = false;
  const response = await getMade(path, () => {
    if (!told) tell(`${name} is being made`);
    told = true;
  });
  download(await response.blob(), name);
}

export function save(format: Format): void {
  const job = selectedJob.peek();
  const map = shownMap.peek();
  const entry = currentEntry.peek();
  if (!job || !entry) return;
  if (!map) {
    getBlob(`/jobs/${job.id}/picture.${format}${frameQuery(shownFrame.peek(), "?")}`).then(
      (blob) => download(blob, `${baseName(job)}.${format}`),
      tellError,
    );
    return;
  }
  const shown = shownOf(map);
  if (format === "png" && entry.data && masterScale(map, shown) === null) {
    paintedPng(entry.data, lookOf(entry)).then(
      (blob) => download(blob, `${baseName(job)}-${map.name}.png`),
      tellError,
    );
    return;
  }
  const path = mapPath(job.id, layer.peek(), map, format, shown, rangeOf(entry, map, shown), shownFrame.peek());
  makeAndSave(path, `${baseName(job)}-${map.name}.${format}`).catch(tellError);
}

/// The selected values as they are here.
export function saveSelection(): void {
  const shown = shownValues();
  const area = shown && areaIn(shown.data, selection.peek());
  if (!area) return;
  const { data, job, difference } = shown;
  const kind = difference ? ` ${difference.metric} difference from job ${difference.from.id}` : "";
  const name = layer.peek().layer + kind;
  const place = `x ${area.x * data.step} to ${(area.x + area.width - 1) * data.step}, y ${area.y * data.step} to ${(area.y + area.height - 1) * data.step}`;
  const title = `${name} of job ${job.id}, ${job.name}: ${place}${data.step > 1 ? `, one pixel of ${data.step} each way` : ""}`;
  download(
    new Blob([csvOf(data, area, title)], { type: "text/csv" }),
    `${baseName(job)}-${name.replaceAll(" ", "-")}-selection.csv`,
  );
}
