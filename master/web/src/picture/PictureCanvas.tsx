import { useEffect, useRef } from "preact/hooks";
import { selectedJob } from "../app/state";
import { shownEntry } from "./compare";
import { shownMap } from "./display";
import { flipIsComing } from "./flip";
import { attachGestures } from "./gestures";
import { makeHands } from "./hands";
import { attachPainter, attachSize, painted, trouble } from "./painting";
import { canvasId, currentView } from "./view_state";

function description(): string {
  const job = selectedJob.value;
  const message = shownEntry.value?.message.value;
  if (!job) return "Picture: no job is chosen";
  const state = message
    ? message.state === "making"
      ? `${Math.floor(message.progress * 100)} % there`
      : message.state
    : "waiting";
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
  const isReady = painted.value.entry !== null && painted.value.entry === shownEntry.value;
  return (
    <div
      class="picture-stage"
      data-ready={isReady}
      data-complete={isReady && painted.value.complete}
      data-zoom={currentView.value.zoom}
    >
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
      {message?.state === "making" && (
        <progress max={1} value={message.progress} aria-label="Progress of the layer" />
      )}
      {message?.state === "making" && !isReady && shownMap.value && (
        <p class="picture-message late" role="status">
          {shownMap.value.title} is being made; rendering goes first.
        </p>
      )}
      {message?.state === "failed" && (
        <p class="picture-message" role="alert">
          {message.message}
        </p>
      )}
      {flipIsComing.value && <p class="picture-message">The ꟻLIP picture is being made …</p>}
      {trouble.value && (
        <p class="picture-message" role="alert">
          {trouble.value}
        </p>
      )}
      {!selectedJob.value && <p class="picture-message">No job is chosen.</p>}
    </div>
  );
}
