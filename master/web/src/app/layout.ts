// What is where on the page, and the actions that change it.
import { signal } from "@preact/signals";
import { isBoolean, isPixels, isShare, stored } from "./stored";

/// The column with the jobs.
export const columnWidth = stored("column", 340, isPixels);
export const columnShown = stored("column-shown", true, isBoolean);
/// The job list's share of the column's height; the rest is the details.
export const listShare = stored("list-share", 0.5, isShare);
/// The picture's share of the centre while the rays are shown.
export const pictureShare = stored("picture-share", 0.5, isShare);

export type RaysPlace = "auto" | "beside" | "below";
export const raysPlace = stored<RaysPlace>("rays-place", "auto", (value) =>
  ["auto", "beside", "below"].includes(value as string),
);

/// All panels around the picture, also the picture's own: hidden to see it alone.
export const panelsShown = signal(true);

/// Whether rays beside the picture leave both enough width.
export const fitsBeside = signal(typeof window !== "undefined" && innerWidth >= 1700);
if (typeof window !== "undefined") addEventListener("resize", () => (fitsBeside.value = innerWidth >= 1700));

export const raysBeside = (): boolean =>
  raysPlace.value === "auto" ? fitsBeside.value : raysPlace.value === "beside";
