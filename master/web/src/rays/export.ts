// What can be taken home: the rays as a drawing of the current view, and the trace as it came.
import { selectedJob } from "../app/state";
import { baseName, download } from "../picture/save";
import { pose } from "./camera";
import { svgOf } from "./drawing";
import { importanceAs, shown } from "./options";
import { answer } from "./probe";
import { scene } from "./scene";
import { outlierSegments, segmentsShown } from "./segments_shown";

/// Under the job's name and the pixel's place.
export function save(blob: Blob, extension: "png" | "svg" | "json"): void {
  const job = selectedJob.value;
  const pixel = answer.value?.question.pixel;
  download(
    blob,
    `${job ? baseName(job) : "scene"}-rays${pixel ? `-${pixel.x}-${pixel.y}` : ""}.${extension}`,
  );
}

export const traceJson = (): Blob =>
  new Blob([`${JSON.stringify(answer.value?.trace ?? null, null, 1)}\n`], { type: "application/json" });

export function currentSvg(width: number, height: number): Blob {
  const asked = answer.value?.question;
  const svg = svgOf({
    pose: pose.value,
    width,
    height,
    scene: scene.value,
    boxes: shown.boxes.value,
    icons: shown.icons.value,
    segments: segmentsShown.value,
    outliers: outlierSegments.value,
    importanceAs: importanceAs.value,
    title: asked ? `Rays of pixel ${asked.pixel.x}, ${asked.pixel.y} of job ${asked.job}` : "Rays",
  });
  return new Blob([svg], { type: "image/svg+xml" });
}
