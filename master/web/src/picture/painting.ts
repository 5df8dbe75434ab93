// Keeps the canvases as the state of the app says they look.
import { effect, signal } from "@preact/signals";
import { probed, selectedJob } from "../app/state";
import { theme } from "../app/theme";
import { comparison, compares, reference, shownEntry, wipeAt } from "./compare";
import { valuesShown } from "./display";
import { partsNow } from "./frame";
import type { LayerData } from "./layer_data";
import { onFrame } from "./on_frame";
import { drawOverlay } from "./overlay";
import { Painter } from "./painter";
import { selection } from "./selection";
import type { Entry } from "./store";
import { originOf } from "./view";
import { currentView, cursor, density, screen } from "./view_state";

/// Why nothing can be painted.
export const trouble = signal("");
/// What the canvas shows: of which layer, and whether all its numbers were there.
export const painted = signal<{ entry: Entry | null; complete: boolean }>({ entry: null, complete: false });

const grounds = { light: [0.886, 0.898, 0.914], dark: [0.059, 0.067, 0.078] } as const;

function paint(painter: Painter, canvas: HTMLCanvasElement, overlay: HTMLCanvasElement): void {
  const size = screen.peek();
  for (const each of [canvas, overlay])
    if (each.width !== size.width || each.height !== size.height) Object.assign(each, size);
  const view = currentView.peek();
  const parts = partsNow();
  painter.paint(size, density.peek(), [...grounds[theme.peek()]], parts);
  const wipes = comparison.peek() === "wipe" && compares.peek() && parts.length > 0;
  const frame = {
    screen: size,
    density: density.peek(),
    origin: originOf(view, size),
    zoom: view.zoom,
    parts,
  };
  drawOverlay(overlay.getContext("2d")!, frame, {
    probed: probed.peek(),
    cursor: cursor.peek(),
    selection: selection.peek(),
    wipe: wipes
      ? {
          at: wipeAt.peek() * size.width,
          left: `#${selectedJob.peek()?.id}`,
          right: `#${reference.peek()?.id}`,
        }
      : null,
    values: valuesShown.peek(),
  });
  const all = (has: (data: LayerData) => boolean): boolean =>
    parts.length > 0 && parts.every((part) => has(part.data));
  painted.value = {
    entry: all((data) => data.begun) ? shownEntry.peek() : null,
    complete: all((data) => data.complete),
  };
}

/// Paints before the next frame whenever something that is seen has changed.
export function attachPainter(canvas: HTMLCanvasElement, overlay: HTMLCanvasElement): () => void {
  let painter: Painter | null = null;
  const begin = (): void => {
    try {
      painter = new Painter(canvas);
      trouble.value = "";
    } catch (error) {
      trouble.value = error instanceof Error ? error.message : String(error);
    }
  };
  begin();
  const painting = onFrame(() => painter && paint(painter, canvas, overlay));
  const stopEffect = effect(() => {
    partsNow();
    void [currentView, screen, density, theme, probed, cursor, selection, valuesShown].map(
      (each) => each.value,
    );
    painting.ask();
  });
  const lost = (event: Event): void => {
    event.preventDefault(); // it may come back
    painter = null;
  };
  const restored = (): void => {
    begin();
    painting.ask();
  };
  canvas.addEventListener("webglcontextlost", lost);
  canvas.addEventListener("webglcontextrestored", restored);
  return () => {
    stopEffect();
    painting.stop();
    canvas.removeEventListener("webglcontextlost", lost);
    canvas.removeEventListener("webglcontextrestored", restored);
  };
}

/// The screen's size in whole device pixels, as exactly as the browser tells.
export function attachSize(target: HTMLElement): () => void {
  const observer = new ResizeObserver(([entry]) => {
    if (!entry) return;
    const exact = entry.devicePixelContentBoxSize?.[0];
    const width = exact?.inlineSize ?? Math.round(entry.contentRect.width * devicePixelRatio);
    const height = exact?.blockSize ?? Math.round(entry.contentRect.height * devicePixelRatio);
    if (width <= 0 || height <= 0) return;
    density.value = width / entry.contentRect.width; // a browser may not paint as densely as it says
    screen.value = { width, height };
  });
  try {
    observer.observe(target, { box: "device-pixel-content-box" });
  } catch {
    observer.observe(target); // Safari
  }
  return () => observer.disconnect();
}
