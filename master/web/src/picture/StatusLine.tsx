import { probed, selectedJob } from "../app/state";
import { currentEntry, reference, shownEntry, showsReference } from "./compare";
import { zoomStep } from "./gestures";
import { pointedAt, readoutAt } from "./readout";
import { zoomText } from "./view";
import { currentView, fit, zoomBy, zoomTo } from "./view_state";

function Values() {
  const pixel = pointedAt();
  const readout = pixel && readoutAt(pixel);
  if (!readout) return <span class="quiet">Point at the picture to read its values; click to probe.</span>;
  return (
    <>
      <span class="place" data-x={readout.pixel.x} data-y={readout.pixel.y}>
        x {readout.pixel.x} y {readout.pixel.y}
      </span>
      <span class="values">{readout.values}</span>
      {readout.preview && <span class="quiet">preview</span>}
      {readout.other && <span class="quiet">reference {readout.other}</span>}
    </>
  );
}

/// What a screen reader says when a pixel was probed.
function Announcement() {
  const readout = probed.value && readoutAt(probed.value);
  return (
    <span class="out-of-sight" aria-live="polite">
      {readout && `Pixel ${readout.pixel.x}, ${readout.pixel.y}: ${readout.values}`}
    </span>
  );
}

function standing(): string {
  const message = shownEntry.value?.message.value;
  if (!message) return "";
  if (message.state === "making") return `${Math.floor(message.progress * 100)} %`;
  return message.state === "failed" ? "failed" : "";
}

function ZoomTools() {
  return (
    <span class="zoom-tools" role="group" aria-label="Zoom">
      <button class="plain" aria-label="Zoom out" title="Zoom out (-)" onClick={() => zoomBy(1 / zoomStep)}>
        −
      </button>
      <button class="plain zoom-level" title="Zoom to 100 % (0)" onClick={() => zoomTo(1)}>
        {zoomText(currentView.value.zoom)}
      </button>
      <button class="plain" aria-label="Zoom in" title="Zoom in (+)" onClick={() => zoomBy(zoomStep)}>
        +
      </button>
      <button class="plain" title="Fit the picture into the window (F)" onClick={fit}>
        fit
      </button>
    </span>
  );
}

export function StatusLine() {
  const job = showsReference.value ? reference.value : selectedJob.value;
  const step = currentEntry.value?.data?.step ?? 1;
  return (
    <div class="status-line">
      <output id="picture-readout" class="readout">
        <Values />
      </output>
      <Announcement />
      {job && (
        <span class="facts">
          <span>{standing()}</span>
          {showsReference.value && <strong>reference</strong>}
          {step > 1 && (
            <span title="The picture is so large that not every pixel is sent">
              every {step === 2 ? "2nd" : `${step}th`} pixel
            </span>
          )}
          <span class="spare">
            {job.settings.width} × {job.settings.height}
          </span>
          <span class="spare">{job.settings.spp} spp</span>
          <span class="spare">#{job.id}</span>
          <ZoomTools />
        </span>
      )}
    </div>
  );
}
