import { effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { probed, selectedJob } from "../app/state";
import { theme } from "../app/theme";
import { comparison, compares, reference, shiftHeld, shownEntry, wipeAt } from "./compare";
import { valuesShown } from "./display";
import { partsNow } from "./frame";
import { attachGestures, type Hands } from "./gestures";
import { drawOverlay } from "./overlay";
import { Painter } from "./painter";
import { areaBetween, selection } from "./selection";
import { originOf, toPicture, type Point } from "./view";
import { currentView, cursor, density, fitOrFull, hovered, panBy, pictureSize, pixelUnder, screen, zoomBy } from "./view_state";

/// Why nothing can be painted.
const trouble = signal("");
/// The canvas shows numbers of the layer that is chosen.
const painted = signal(false);
export const canvasId = "picture-canvas";

const grounds = { light: [0.886, 0.898, 0.914], dark: [0.059, 0.067, 0.078] } as const;
const wipeReach = 6; // CSS pixels around the line

/// Runs once before the next frame, however often it is asked for.
function onFrame(run: () => void): { ask: () => void; stop: () => void } {
  let frame = 0;
  const ask = (): void => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      run();
    });
  };
  return { ask, stop: () => cancelAnimationFrame(frame) };
}

function makeHands(): Hands & { stop: () => void } {
  let scrubbed: Point | null = null;
  const scrubbing = onFrame(() => {
    const pixel = scrubbed && pixelUnder(scrubbed);
    if (pixel) probed.value = pixel;
  });
  const place = (at: Point): Point => toPicture(currentView.peek(), screen.peek(), at);
  const probe = (at: Point): void => {
    const pixel = pixelUnder(at);
    if (!pixel) return;
    probed.value = pixel;
    cursor.value = null;
  };
  return {
    pan: panBy,
    zoom: zoomBy,
    probe,
    scrub: (at) => {
      scrubbed = at;
      scrubbing.ask();
    },
    select: (from, to) => {
      const size = pictureSize.peek();
      const moved = Math.hypot(to.x - from.x, to.y - from.y) > 3 * density.peek();
      selection.value = moved && size ? areaBetween(place(from), place(to), size) : null;
    },
    hover: (at) => (hovered.value = at && pixelUnder(at)),
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

function paint(painter: Painter, canvas: HTMLCanvasElement, overlay: HTMLCanvasElement): void {
  const size = screen.peek();
  for (const each of [canvas, overlay])
    if (each.width !== size.width || each.height !== size.height) Object.assign(each, size);
  const view = currentView.peek();
  const parts = partsNow();
  painter.paint(size, density.peek(), [...grounds[theme.peek()]], parts);
  const wipes = comparison.peek() === "wipe" && compares.peek() && parts.length > 0;
  const frame = { screen: size, density: density.peek(), origin: originOf(view, size), zoom: view.zoom, parts };
  drawOverlay(overlay.getContext("2d")!, frame, {
    probed: probed.peek(),
    cursor: cursor.peek(),
    selection: selection.peek(),
    wipe: wipes
      ? { at: wipeAt.peek() * size.width, left: `#${selectedJob.peek()?.id}`, right: `#${reference.peek()?.id}` }
      : null,
    values: valuesShown.peek(),
  });
  painted.value = parts.length > 0 && parts.every((part) => part.data.there.some((quality) => quality !== 0));
}

/// Paints before the next frame whenever something that is seen has changed.
function attachPainter(canvas: HTMLCanvasElement, overlay: HTMLCanvasElement): () => void {
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
    void [currentView, screen, density, theme, probed, cursor, selection, valuesShown].map((each) => each.value);
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
function attachSize(target: HTMLElement): () => void {
  const observer = new ResizeObserver(([entry]) => {
    if (!entry) return;
    const exact = entry.devicePixelContentBoxSize?.[0];
    const width = exact?.inlineSize ?? Math.round(entry.contentRect.width * devicePixelRatio);
    const height = exact?.blockSize ?? Math.round(entry.contentRect.height * devicePixelRatio);
    density.value = devicePixelRatio;
    if (width > 0 && height > 0) screen.value = { width, height };
  });
  try {
    observer.observe(target, { box: "device-pixel-content-box" });
  } catch {
    observer.observe(target); // Safari
  }
  return () => observer.disconnect();
}

function description(): string {
  const job = selectedJob.value;
  const message = shownEntry.value?.message.value;
  if (!job) return "Picture: no job is chosen";
  const state = message ? (message.state === "making" ? `${Math.floor(message.progress * 100)} % there` : message.state) : "waiting";
  const layerName = shownEntry.value?.watch.layer ?? "picture";
  return `${layerName} of job ${job.id}, ${job.name}: ${job.settings.width} by ${job.settings.height} pixels, ${state}. Arrow keys move a cursor, Enter probes.`;
}

export function PictureCanvas() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const overlay = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const hands = makeHands();
    const stops = [
      attachSize(overlay.current!),
      attachPainter(canvas.current!, overlay.current!),
      attachGestures(overlay.current!, hands),
      hands.stop,
    ];
    return () => stops.forEach((stop) => stop());
  }, []);
  const message = shownEntry.value?.message.value;
  return (
    <div class="picture-stage" data-ready={painted.value} data-zoom={currentView.value.zoom}>
      <canvas ref={canvas} aria-hidden="true" />
      <canvas
        ref={overlay}
        id={canvasId}
        tabIndex={0}
        role="application"
        aria-roledescription="picture"
        aria-label={description()}
        aria-describedby="picture-readout"
      />
      {message?.state === "making" && <progress max={1} value={message.progress} aria-label="Progress of the layer" />}
      {message?.state === "failed" && <p class="picture-message" role="alert">{message.message}</p>}
      {trouble.value && <p class="picture-message" role="alert">{trouble.value}</p>}
      {!selectedJob.value && <p class="picture-message">No job is chosen.</p>}
    </div>
  );
}
