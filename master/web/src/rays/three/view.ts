// The 3D view: draws what the signals say, and again when they change.
import { effect } from "@preact/signals";
import type * as THREE from "three";
import { approach, isStill, pose } from "../camera";
import { cloudState } from "../cloud";
import { filled, importanceAs, shown } from "../options";
import { distanceOf } from "../pose";
import { box, boxOf, everything, scene } from "../scene";
import { allSegments, outlierSegments, segmentsShown } from "../segments_shown";
import { entries, hovered, selected, spanMark } from "../selection";
import { outlierColor } from "../strokes";
import { diagonalOf, edgesOf } from "../vec";
import { fitDashes, glowOf, raysOf } from "./lines";
import { axes, axesLength, cloudPoints, dots, fitSprites, icons, normals } from "./marks";
import { filledBoxes, preview, wireframes } from "./solids";
import { discard, type Next, Stage } from "./stage";

export interface View {
  stage: Stage;
  dispose(): void;
}

export function openView(canvas: HTMLCanvasElement, settled: (still: boolean) => void): View {
  const stage: Stage = new Stage(canvas, (milliseconds): Next => {
    approach(milliseconds);
    const look = stage.lookOf(pose.peek());
    fitSprites(stage.world, look);
    fitDashes(stage.world, look, distanceOf(look.pose));
    settled(isStill());
    return { look, box: everything.peek(), again: !isStill() };
  });

  /// A part of the picture that is made anew when a signal it reads has changed; null shows none.
  const keep = (parent: THREE.Group, make: () => THREE.Object3D | null): (() => void) => {
    let kept: THREE.Object3D | null = null;
    return effect(() => {
      const made = make();
      if (kept) discard(kept);
      if (made) parent.add(made);
      kept = made;
      settled(false);
      stage.invalidate();
    });
  };
  const inWorld = (make: () => THREE.Object3D | null) => keep(stage.world, make);

  const ends = [
    effect(() => stage.setBackground(scene.value?.background ?? [0.02, 0.02, 0.025])),
    effect(() => {
      isStill(); // reads where the view is and where it is going
      settled(false);
      stage.invalidate();
    }),
    inWorld(() => raysOf(segmentsShown.value, importanceAs.value)),
    inWorld(() =>
      segmentsShown.value.length > 0
        ? dots(
            hitsShown().map((hit) => hit.point),
            7,
            "#ffffff",
          )
        : null,
    ),
    inWorld(() => glowOf(outlierSegments.value, 8, 0.6, outlierColor)),
    inWorld(() => {
      const ends = outlierSegments.value.filter((segment) => !segment.missed).map((segment) => segment.to);
      return ends.length > 0 ? dots(ends, 18, outlierColor) : null;
    }),
    inWorld(() => (shown.normals.value ? normals(hitsShown(), 0.05 * diagonalOf(box.value)) : null)),
    inWorld(() =>
      glowOf(
        allSegments.value.filter((s) => s.entry === selected.value?.id),
        9,
        0.55,
      ),
    ),
    inWorld(() =>
      glowOf(
        allSegments.value.filter((s) => s.entry === hovered.value?.id),
        11,
        0.8,
      ),
    ),
    inWorld(() =>
      scene.value && shown.boxes.value ? wireframes(scene.value.solids, boxOf(scene.value)) : null,
    ),
    inWorld(() =>
      scene.value && shown.boxes.value && filled.value ? filledBoxes(scene.value.solids) : null,
    ),
    inWorld(() =>
      scene.value && shown.preview.value ? preview(scene.value.solids, boxOf(scene.value)) : null,
    ),
    inWorld(() => (scene.value && shown.icons.value ? icons(scene.value) : null)),
    inWorld(() => (scene.value && shown.axes.value ? axes(axesLength(boxOf(scene.value))) : null)),
    inWorld(() => (spanMark.value ? dots(spanMark.value.points, 13, "#2fb8ff") : null)),
    inWorld(() => glowOf(markedBox(), 2.5, 1)),
    keep(stage.mirrored, () =>
      shown.cloud.value && cloudState.value.state === "ready" ? cloudPoints(cloudState.value.cloud) : null,
    ),
  ];

  const restored = () => stage.invalidate();
  canvas.addEventListener("webglcontextrestored", restored);
  return {
    stage,
    dispose() {
      for (const end of ends) end();
      canvas.removeEventListener("webglcontextrestored", restored);
      stage.dispose();
    },
  };
}

/// Of the rays that are shown.
function hitsShown() {
  const drawn = new Set(segmentsShown.value.map((segment) => segment.entry));
  return entries.value.flatMap((entry) =>
    entry.what === "ray" && entry.ray.hit && drawn.has(entry.id) ? [entry.ray.hit] : [],
  );
}

/// The edges of the box of the leaf that the chart points at.
function markedBox() {
  const leaf = spanMark.value?.leaf;
  const marked = scene.value?.solids.find((solid) => solid.leaf === leaf)?.box;
  return marked ? edgesOf(marked) : [];
}
