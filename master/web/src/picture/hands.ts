// What the gestures over the picture do to the app.
import { probe } from "../app/state";
import { comparison, compares, shiftHeld, wipeAt } from "./compare";
import type { Hands } from "./gestures";
import { onFrame } from "./on_frame";
import { areaBetween, selection } from "./selection";
import { toPicture, type Point } from "./view";
import {
  currentView,
  cursor,
  density,
  fitOrFull,
  panBy,
  pictureSize,
  pixelUnder,
  pointer,
  screen,
  zoomBy,
} from "./view_state";

const wipeReach = 6; // CSS pixels around the line

export function makeHands(): Hands & { stop: () => void } {
  let scrubbed: Point | null = null;
  const scrubbing = onFrame(() => {
    const pixel = scrubbed && pixelUnder(scrubbed);
    if (pixel) probe(pixel);
  });
  const place = (at: Point): Point => toPicture(currentView.peek(), screen.peek(), at);
  return {
    pan: panBy,
    zoom: zoomBy,
    probe: (at) => {
      const pixel = pixelUnder(at);
      if (!pixel) return;
      probe(pixel);
      cursor.value = null;
    },
    scrub: (at) => {
      scrubbed = at;
      scrubbing.ask();
    },
    select: (from, to) => {
      const size = pictureSize.peek();
      const moved = Math.hypot(to.x - from.x, to.y - from.y) > 3 * density.peek();
      selection.value = moved && size ? areaBetween(place(from), place(to), size) : null;
    },
    hover: (at) => (pointer.value = at),
    toggleFit: fitOrFull,
    overWipe: (at) =>
      comparison.peek() === "wipe" &&
      compares.peek() &&
      Math.abs(at.x - wipeAt.peek() * screen.peek().width) <= wipeReach * density.peek(),
    wipe: (at) => (wipeAt.value = Math.min(Math.max(at.x / screen.peek().width, 0), 1)),
    start: () => (shiftHeld.value = false),
    stop: scrubbing.stop,
  };
}
