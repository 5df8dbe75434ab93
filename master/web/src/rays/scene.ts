// The selected job's scene as the master describes it (GET /jobs/ID/scene), for the 3D view.
import { computed, effect, signal } from "@preact/signals";
import { getJson } from "../app/api";
import { frameQuery } from "../app/frames";
import { link } from "../app/state";
import type { Vec3 } from "../app/types";
import { answer } from "./probe";
import { cutBox } from "./segments";
import { subject, type Subject } from "./subject";
import { type Box, boxAround, centreOf, diagonalOf, edgesOf, lengthOf, minus } from "./vec";

export interface SolidView {
  leaf: number;
  name: string;
  subtracted: boolean; // from others: it is where they are not
  kind: string; // "sphere", "cube", ...
  color: Vec3; // linear
  box: Box | null; // null: endless
  matrix: number[]; // 12 numbers: the rows of world_from_local
  parameters: Record<string, number | null>; // null: endless
}

export type LightView =
  | { kind: "ambient"; intensity: Vec3 }
  | { kind: "point"; at: Vec3; intensity: Vec3 }
  | { kind: "rectangle"; at: Vec3; width: Vec3; height: Vec3; intensity: Vec3 };

export interface SceneView {
  background: Vec3; // linear
  camera: { kind: string; from: Vec3; direction: Vec3; up: Vec3; angle_deg: number };
  lights: LightView[];
  solids: SolidView[];
  truncated: boolean; // more solids than are told
}

export const scene = signal<SceneView | null>(null);
export const sceneError = signal<string | null>(null);

/// Around the solids that end somewhere and the camera.
export function boxOf(view: SceneView): Box {
  const corners = view.solids.flatMap(({ box }) => (box ? [box.min, box.max] : []));
  return boxAround([...corners, view.camera.from])!;
}

const lightPlaces = (view: SceneView): Vec3[] =>
  view.lights.flatMap((light) => (light.kind === "ambient" ? [] : [light.at]));

const farLight = 3; // times the scene's size; beyond it a light is not among the landmarks

/// What an overview shows: the solids that end somewhere, the camera, and the lights unless they are far away.
export function landmarksOf(view: SceneView): Vec3[] {
  const box = boxOf(view);
  const reach = farLight * diagonalOf(box);
  const near = lightPlaces(view).filter((at) => lengthOf(minus(at, centreOf(box))) <= reach);
  return [...edgesOf(box).flatMap(({ from, to }) => [from, to]), ...near];
}

/// Around the scene and the rays: where rays that miss are cut.
export const box = computed<Box>(() =>
  cutBox(scene.value && boxOf(scene.value), answer.value?.trace ?? { pixel: [0, 0], samples: [] }),
);

/// Around the lights too, however far away: nothing outside is drawn.
export const everything = computed<Box>(() =>
  boxAround([box.value.min, box.value.max, ...(scene.value ? lightPlaces(scene.value) : [])])!,
);

/// Of the job that is shown, until the result is called. What could not be had is asked for again when the connection to
/// the master is found again.
export function followScene(): () => void {
  let got: Subject | null = null;
  return effect(() => {
    const asked = subject.value;
    if (asked && (link.value === "lost" || asked === got)) return;
    scene.value = sceneError.value = got = null;
    if (!asked) return;
    const controller = new AbortController();
    getJson<SceneView>(`/jobs/${asked.job}/scene${frameQuery(asked.frame, "?")}`, controller.signal).then(
      (view) => {
        scene.value = view;
        got = asked;
      },
      (error: unknown) => {
        if (!controller.signal.aborted)
          sceneError.value = error instanceof Error ? error.message : String(error);
      },
    );
    return () => controller.abort();
  });
}
