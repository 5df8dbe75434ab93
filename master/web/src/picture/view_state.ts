// How the picture lies on the screen now, and what moves it. Kept from layer to layer, from one result to the
// next, and in the page's address.
import { computed, effect, signal, untracked } from "@preact/signals";
import { viewQuery } from "../app/route";
import { selectedJob, type Pixel } from "../app/state";
import * as view from "./view";

/// Of the element that has the focus when keys move the cursor.
export const canvasId = "picture-canvas";

/// Of the area the picture is shown in, device pixels.
export const screen = signal<view.Size>({ width: 1, height: 1 });
/// Device pixels a CSS pixel.
export const density = signal(1);

const current = signal<view.View>({ zoom: 1, x: 0, y: 0 });
/// All of the picture is shown, also when the window changes, until somebody moves it.
const followsFit = signal(true);
export const currentView = computed(() => current.value);

const settings = computed(() => selectedJob.value?.settings);
export const pictureWidth = computed(() => settings.value?.width ?? 0);
export const pictureHeight = computed(() => settings.value?.height ?? 0);
export const pictureSize = computed<view.Size | null>(() =>
  pictureWidth.value > 0 ? { width: pictureWidth.value, height: pictureHeight.value } : null,
);

/// Where the pointer is on the screen, and the pixel under it, also when the picture moves and the pointer does not.
export const pointer = signal<view.Point | null>(null);
export const hovered = computed<Pixel | null>(() => pointer.value && pixelUnder(pointer.value));
/// The pixel that keys move.
export const cursor = signal<Pixel | null>(null);

function show(next: view.View): void {
  const size = pictureSize.peek();
  current.value = size ? view.kept(next, screen.peek(), size) : next;
}
function move(next: view.View): void {
  followsFit.value = false;
  show(next);
}

const middle = (): view.Point => ({ x: screen.peek().width / 2, y: screen.peek().height / 2 });

export const zoomBy = (factor: number, at: view.Point = middle()): void =>
  move(view.zoomedAt(current.peek(), screen.peek(), at, factor));
export const zoomTo = (zoom: number, at: view.Point = middle()): void =>
  zoomBy(zoom / current.peek().zoom, at);
export const panBy = (by: view.Point): void => move(view.panned(current.peek(), by));
export function reveal(pixel: Pixel): void {
  const next = view.showing(current.peek(), screen.peek(), pixel);
  if (next.x !== current.peek().x || next.y !== current.peek().y) move(next);
}

export function fit(): void {
  followsFit.value = true;
  const size = pictureSize.peek();
  if (size) show(view.fitted(screen.peek(), size));
}

/// Between all of it and one to one around the point.
export function fitOrFull(at: view.Point): void {
  if (followsFit.peek()) zoomTo(1, at);
  else fit();
}

export const pixelUnder = (at: view.Point): Pixel | null => {
  const size = pictureSize.value;
  return size && view.pixelAt(view.toPicture(current.value, screen.value, at), size);
};

/// What was shown before, to carry the place over to another resolution of the same scene.
let before: { name: string; size: view.Size } | null = null;

function takeSize(size: view.Size, name: string): void {
  const same = before && before.size.width === size.width && before.size.height === size.height;
  const place = before?.name === name && !same && before.size;
  before = { name, size };
  if (followsFit.peek()) fit();
  else if (place) show(view.carried(current.peek(), place, size));
  else show(current.peek());
}

export function startView(): () => void {
  let written: string | undefined;
  const textOf = (query: Readonly<Record<string, string>>): string => `${query.z ?? ""} ${query.c ?? ""}`;
  const stops = [
    effect(() => {
      const size = pictureSize.value;
      if (size) untracked(() => takeSize(size, selectedJob.peek()?.name ?? ""));
    }),
    effect(() => {
      if (screen.value.width > 1) untracked(() => (followsFit.peek() ? fit() : show(current.peek())));
    }),
    effect(() => {
      const query = viewQuery.value;
      const asked = view.viewIn(query);
      if (asked && textOf(query) !== written) untracked(() => move(asked));
    }),
    effect(() => {
      const others = Object.entries(viewQuery.peek()).filter(([name]) => name !== "z" && name !== "c");
      const mine = followsFit.value || !pictureSize.value ? {} : view.queryOf(current.value);
      written = textOf(mine);
      if (written !== textOf(viewQuery.peek())) viewQuery.value = { ...Object.fromEntries(others), ...mine };
    }),
  ];
  return () => stops.forEach((stop) => stop());
}
