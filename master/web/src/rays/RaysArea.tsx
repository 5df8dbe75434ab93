// The rays of the probed pixel in 3D, as a tree, and as spans. Loaded when it is first shown.
import { effect, untracked } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { alignWithPrimary } from "./align";
import { show } from "./camera";
import { followCloud } from "./cloud";
import { keepAligned } from "./options";
import { answer, asking, followProbe, sampleChoice } from "./probe";
import { RayCanvas, viewIsStill } from "./RayCanvas";
import { RayRecord } from "./RayRecord";
import { RayTree } from "./RayTree";
import { followScene, landmarksOf, scene, sceneError } from "./scene";
import { segmentsShown } from "./segments_shown";
import { rayCount } from "./selection";
import { SpanChart } from "./SpanChart";
import { followStory } from "./story";
import { subject } from "./subject";
import { Toolbar } from "./Toolbar";
import "./rays.css";

/// Each scene is seen whole at first; the next pixel of an aligned view moves it.
function followViews(): () => void {
  const ends = [
    effect(() => {
      const seen = scene.value;
      if (seen) untracked(() => show(landmarksOf(seen), seen.camera.direction, seen.camera.up));
    }),
    effect(() => {
      if (answer.value && keepAligned.peek()) untracked(alignWithPrimary);
    }),
  ];
  return () => ends.forEach((end) => end());
}

export function RaysArea() {
  useEffect(() => {
    const ends = [followScene(), followProbe(), followStory(), followCloud(), followViews()];
    return () => ends.forEach((end) => end());
  }, []);
  const pixel = answer.value?.question.pixel;
  const known = subject.value === null || scene.value !== null || sceneError.value !== null;
  return (
    <section
      class="rays"
      aria-label="Rays"
      data-scope="rays"
      tabIndex={0}
      data-ready={known && !asking.value && viewIsStill.value}
      data-pixel={pixel ? `${pixel.x},${pixel.y}` : ""}
      data-sample={String(sampleChoice.value)}
      data-rays={rayCount.value}
      data-segments={segmentsShown.value.length}
    >
      <div class="rays-body">
        <Toolbar />
        <RayCanvas />
        <RayTree />
        <SpanChart />
        <RayRecord />
      </div>
    </section>
  );
}
