import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { bytes } from "../app/format";
import { probed } from "../app/state";
import { pose, setAspect } from "./camera";
import { cloudState } from "./cloud";
import { currentSvg, save } from "./export";
import { shown } from "./options";
import { answer, probeError } from "./probe";
import { nearestSegment, projectorOf } from "./projection";
import { nameOf } from "./record";
import { scene, sceneError } from "./scene";
import { segmentsShown } from "./segments_shown";
import { entryOf, hover, select } from "./selection";
import { subject } from "./subject";
import { listenToHands } from "./three/gestures";
import { openView, type View } from "./three/view";

export const viewIsStill = signal(false);
const noView = signal<string | null>(null);
const tip = signal<{ x: number; y: number; text: string } | null>(null);
let view: View | null = null;

const pickReach = 7; // pixels from a line within which it counts as pointed at

function rayAt(x: number, y: number): string | null {
  const canvas = view!.stage.canvas;
  const projector = projectorOf(pose.value, canvas.clientWidth, canvas.clientHeight);
  return nearestSegment(segmentsShown.value, projector, x, y, pickReach)?.entry ?? null;
}

function point(x: number, y: number): void {
  const id = rayAt(x, y);
  hover(id);
  const entry = entryOf(id);
  tip.value = entry ? { x, y, text: nameOf(entry) } : null;
}

function open(canvas: HTMLCanvasElement): () => void {
  try {
    view = openView(canvas, (still) => (viewIsStill.value = still));
  } catch {
    noView.value =
      "This browser draws no 3D (WebGL 2 is off or missing); the ray tree and the chart are complete.";
    viewIsStill.value = true;
    return () => undefined;
  }
  const ends = listenToHands(canvas, {
    pointed: point,
    left() {
      hover(null);
      tip.value = null;
    },
    clicked: (x, y) => select(rayAt(x, y)),
  });
  const opened = view;
  const observer = new ResizeObserver(() => {
    const { clientWidth: width, clientHeight: height } = canvas;
    opened.stage.resize(width, height);
    if (height > 0) setAspect(width / height);
  });
  observer.observe(canvas.parentElement!);
  return () => {
    observer.disconnect();
    ends();
    opened.dispose();
    view = null;
  };
}

export async function savePng(): Promise<void> {
  if (view) save(await view.stage.png(), "png");
}
export function saveSvg(): void {
  const canvas = view?.stage.canvas;
  save(currentSvg(canvas?.clientWidth ?? 960, canvas?.clientHeight ?? 600), "svg");
}

function CloudProgress() {
  const cloud = cloudState.value;
  if (cloud.state === "making")
    return (
      <p class="rays-note" role="status">
        The master collects the point cloud <progress value={cloud.progress} />{" "}
        {Math.floor(100 * cloud.progress)} %
      </p>
    );
  if (cloud.state === "loading")
    return (
      <p class="rays-note" role="status">
        Loading the point cloud {cloud.total && <progress value={cloud.bytes / cloud.total} />}{" "}
        {bytes(cloud.bytes)}
      </p>
    );
  if (cloud.state === "failed")
    return (
      <p class="rays-note bad" role="alert">
        Point cloud: {cloud.message}
      </p>
    );
  return null;
}

function Hint() {
  if (!subject.value) return <p class="rays-note">No job is selected.</p>;
  if (!probed.value) return <p class="rays-note">Click a pixel of the picture: its rays are shown here.</p>;
  return null;
}

/// Beside the pointer, on the side where there is room.
function Tip() {
  const at = tip.value;
  const canvas = view?.stage.canvas;
  if (!at || !canvas) return null;
  const across = at.x > canvas.clientWidth / 2 ? `calc(-100% - 12px)` : "12px";
  const down = at.y > canvas.clientHeight - 40 ? `calc(-100% - 6px)` : "14px";
  return (
    <div
      class="rays-tip"
      style={{ left: `${at.x}px`, top: `${at.y}px`, transform: `translate(${across}, ${down})` }}
    >
      {at.text}
    </div>
  );
}

export function RayCanvas() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => open(canvas.current!), []);
  const cloud = cloudState.value;
  return (
    <div class="rays-view" data-cloud={cloud.state === "ready" ? cloud.cloud.count : cloud.state}>
      <canvas
        ref={canvas}
        aria-label="The scene and the rays in 3D"
        role="img"
        hidden={noView.value !== null}
      />
      <div class="rays-notes">
        {noView.value && <p class="rays-note">{noView}</p>}
        <Hint />
        {probeError.value && (
          <p class="rays-note bad" role="alert">
            {probeError}
          </p>
        )}
        {sceneError.value && (
          <p class="rays-note bad" role="alert">
            Scene: {sceneError}
          </p>
        )}
        <CloudProgress />
        {scene.value?.truncated && (
          <p class="rays-note">The scene has more solids than the 20 000 that are shown.</p>
        )}
        {answer.value?.trace.truncated && <p class="rays-note">Only the first 20 000 rays were recorded.</p>}
        {shown.preview.value && scene.value && (
          <p class="rays-note">Each solid by itself, what is taken away transparent: set operations are not applied.</p>
        )}
      </div>
      <Tip />
    </div>
  );
}
