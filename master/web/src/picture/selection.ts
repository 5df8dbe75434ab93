// The rectangle whose figures are shown.
import { signal } from "@preact/signals";
import { overlap, type LayerData, type Rect } from "./layer_data";
import type { Point, Size } from "./view";

/// In the picture's pixels; null: all of it.
export const selection = signal<Rect | null>(null);

/// Of all pixels that the rectangle between two points of the picture touches; null when there are none.
export function areaBetween(a: Point, b: Point, picture: Size): Rect | null {
  const x = Math.floor(Math.min(a.x, b.x));
  const y = Math.floor(Math.min(a.y, b.y));
  const area = {
    x,
    y,
    width: Math.floor(Math.max(a.x, b.x)) + 1 - x,
    height: Math.floor(Math.max(a.y, b.y)) + 1 - y,
  };
  return overlap(area, { x: 0, y: 0, ...picture });
}

/// In the layer's pixels; null when it has none there.
export function areaIn(data: LayerData, selected: Rect | null): Rect | null {
  const all = { x: 0, y: 0, width: data.width, height: data.height };
  if (!selected) return all;
  const x = Math.ceil(selected.x / data.step);
  const y = Math.ceil(selected.y / data.step);
  const right = Math.ceil((selected.x + selected.width) / data.step);
  const bottom = Math.ceil((selected.y + selected.height) / data.step);
  return overlap({ x, y, width: right - x, height: bottom - y }, all);
}
