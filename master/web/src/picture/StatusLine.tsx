import { probed, selectedJob } from "../app/state";
import { currentEntry, reference, shownEntry, showsReference } from "./compare";
import { pointedAt, readoutAt } from "./readout";

function Values() {
  const pixel = pointedAt();
  const readout = pixel && readoutAt(pixel);
  if (!readout) return <span class="quiet">Point at the picture to read its values; click to probe.</span>;
  return (
    <>
      <span class="place" data-x={readout.pixel.x} data-y={readout.pixel.y}>
        x {readout.pixel.x}  y {readout.pixel.y}
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
          {step > 1 && <span title="The picture is so large that not every pixel is sent">every {step}th pixel</span>}
          <span>{job.settings.width} × {job.settings.height}</span>
          <span>{job.settings.spp} spp</span>
          <span>{job.settings.sampler}</span>
          <span>#{job.id}</span>
        </span>
      )}
    </div>
  );
}
