// The angle at which a pixel's surface is seen: between its normal and the way back to the camera.
import { effect, signal } from "@preact/signals";
import { getJson } from "../app/api";
import { frameQuery, shownFrame } from "../app/frames";
import { layer, selectedId } from "../app/state";
import type { Vec3 } from "../app/types";
import type { Point, Size } from "./view";

export interface Camera {
  kind: string;
  from: Vec3;
  direction: Vec3;
  up: Vec3;
  angle_deg: number; // horizontal
}

const dot = (a: ArrayLike<number>, b: ArrayLike<number>): number =>
  a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
const unit = (v: Vec3): Vec3 => {
  const length = Math.hypot(...v);
  return [v[0] / length, v[1] / length, v[2] / length];
};
const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/// Right, up and forward parts of the ray through a pixel's centre; not unit.
function rayInCamera(camera: Camera, film: Size, pixel: Point): Vec3 {
  const half = Math.tan((camera.angle_deg * Math.PI) / 360);
  const across = (2 * (pixel.x + 0.5)) / film.width - 1;
  const down = (2 * (pixel.y + 0.5)) / film.height - 1;
  return [across * half, (-down * half * film.height) / film.width, 1];
}

/// Left-handed: seen along +z with y up, +x is to the right.
function axesOf(camera: Camera): [Vec3, Vec3, Vec3] {
  const forward = unit(camera.direction);
  const right = unit(cross(unit(camera.up), forward));
  return [right, unit(cross(forward, right)), forward];
}

/// Degrees; null when the pixel shows nothing. The normal is in the world's axes, or in the camera's (right, up,
/// forward).
export function viewAngle(
  camera: Camera,
  film: Size,
  pixel: Point,
  normal: ArrayLike<number>,
  axes: "world" | "camera",
): number | null {
  const length = Math.sqrt(dot(normal, normal));
  if (!Number.isFinite(length) || length === 0) return null;
  const ray = rayInCamera(camera, film, pixel);
  const [right, up, forward] = axesOf(camera);
  const along: Vec3 =
    axes === "camera"
      ? ray
      : ([0, 1, 2].map((i) => right[i]! * ray[0] + up[i]! * ray[1] + forward[i]! * ray[2]) as Vec3);
  const cosine = -dot(normal, along) / (length * Math.hypot(...along));
  return (Math.acos(Math.min(Math.max(cosine, -1), 1)) * 180) / Math.PI;
}

/// Of the selected job, while one of its normal maps is looked at.
export const camera = signal<Camera | null>(null);

export function startCamera(): () => void {
  return effect(() => {
    const id = selectedId.value;
    camera.value = null;
    if (id === null || !layer.value.layer.startsWith("normal")) return;
    const stop = new AbortController();
    getJson<{ camera: Camera }>(`/jobs/${id}/scene${frameQuery(shownFrame.value, "?")}`, stop.signal).then(
      (scene) => (camera.value = scene.camera.kind === "perspective" ? scene.camera : null),
      () => undefined, // without it there is no angle, and the normal is all there is to tell
    );
    return () => stop.abort();
  });
}
