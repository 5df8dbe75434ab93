// What is on the screen now, from the state of the app: the parts that the painter paints.
import type { Job } from "../app/types";
import { selectedJob } from "../app/state";
import {
  comparison,
  compares,
  currentEntry,
  metric,
  reference,
  referenceEntry,
  showsReference,
  wipeAt,
} from "./compare";
import { display, gridShown, shownMap, shownOf } from "./display";
import { errorsBetween, rangeOf } from "./figures";
import { flipPicture } from "./flip";
import type { LayerData } from "./layer_data";
import { differenceLook, mapLook, pictureLook, plainLook } from "./look";
import type { Look, Part } from "./painter";
import type { Entry } from "./store";
import { originOf } from "./view";
import { currentView, density, screen } from "./view_state";

/// Screen pixels of a pixel from which on its edges are drawn, and fully.
const gridFrom = 12;
const gridFull = 32;

export const lookOf = (entry: Entry): Look => {
  const map = shownMap.value;
  if (!map) return pictureLook(display.value);
  const shown = shownOf(map);
  return mapLook(map, shown, rangeOf(entry, map, shown));
};

function partOf(data: LayerData, job: Job, look: Look): Part {
  const view = currentView.value;
  const width = selectedJob.value?.settings.width ?? job.settings.width;
  // Another resolution of the scene covers the same area.
  const texel = view.zoom * data.step * (width / job.settings.width);
  const strength = (texel / density.value - gridFrom) / (gridFull - gridFrom);
  return {
    data,
    other: null,
    metric: "none",
    look,
    origin: originOf(view, screen.value),
    texel,
    left: 0,
    right: screen.value.width,
    grid: gridShown.value ? 0.18 * Math.min(Math.max(strength, 0), 1) : 0,
  };
}

function entryPart(entry: Entry | null, job: Job | null): Part[] {
  if (!entry || !job) return [];
  void entry.revision.value; // painted again when it changes
  return entry.data ? [partOf(entry.data, job, lookOf(entry))] : [];
}

function differencePart(job: Job): Part[] {
  const [a, b] = [currentEntry.value, referenceEntry.value];
  if (metric.value === "flip") return flipPicture.value ? [partOf(flipPicture.value, job, plainLook)] : [];
  const errors = a && b && errorsBetween(a, b);
  if (!errors || !a.data || !b.data) return [];
  const look = differenceLook(!shownMap.value, display.value, metric.value, errors);
  return [{ ...partOf(a.data, job, look), other: b.data, metric: metric.value }];
}

export function partsNow(): Part[] {
  const job = selectedJob.value;
  if (!job) return [];
  if (showsReference.value) return entryPart(referenceEntry.value, reference.value);
  const current = entryPart(currentEntry.value, job);
  if (!compares.value || comparison.value === "off") return current;
  if (comparison.value === "difference") return differencePart(job);
  const middle = wipeAt.value * screen.value.width;
  return [
    ...current.map((part) => ({ ...part, right: middle })),
    ...entryPart(referenceEntry.value, reference.value).map((part) => ({ ...part, left: middle })),
  ];
}
