// The rays of a trace as line segments in the world.
import type { Vec3 } from "../app/types";
import type { Entry, PixelTrace, TracedRay } from "./trace";
import { along, type Box, boxAround, diagonalOf, exitOf, grown, unit } from "./vec";

/// "shadow" runs from a surface towards a light, up to what blocks it; "blocked" from there on.
export type Stroke = "camera" | "reflected" | "refracted" | "shadow" | "blocked";

export interface Segment {
  entry: string; // id of its line in the ray tree
  stroke: Stroke;
  missed: boolean; // cut: the ray goes on for ever
  from: Vec3;
  to: Vec3;
  importance: number; // 0 to 1
}

const strokeOf = { primary: "camera", reflected: "reflected", refracted: "refracted" } as const;

/// Where a ray's line ends: its hit, or where it leaves the box.
export function endOf(ray: TracedRay, box: Box): Vec3 {
  if (ray.hit) return ray.hit.point;
  const direction = unit(ray.direction);
  return along(ray.origin, direction, exitOf(box, ray.origin, direction) || diagonalOf(box) / 4);
}

export function segmentsOf(entries: readonly Entry[], box: Box): Segment[] {
  return entries.flatMap((entry) => {
    switch (entry.what) {
      case "untraced":
        return [];
      case "ray": {
        const { kind, origin, importance, hit } = entry.ray;
        const to = endOf(entry.ray, box);
        return [{ entry: entry.id, stroke: strokeOf[kind], missed: !hit, from: origin, to, importance }];
      }
      case "light":
        return lightSegments(entry);
    }
  });
}

function lightSegments({ id, ray, light }: Extract<Entry, { what: "light" }>): Segment[] {
  if (!ray.hit || !light.at || (light.fate !== "reached" && light.fate !== "blocked")) return [];
  const common = { entry: id, missed: false, importance: ray.importance };
  const from = ray.hit.point;
  if (light.fate === "reached") return [{ ...common, stroke: "shadow", from, to: light.at }];
  // Without a blocker the surface itself lies within another solid.
  const occluder = light.blocker?.point ?? from;
  return [
    { ...common, stroke: "shadow", from, to: occluder },
    { ...common, stroke: "blocked", from: occluder, to: light.at },
  ];
}

function* placesOf(trace: PixelTrace): Generator<Vec3> {
  const stack = trace.samples.map((sample) => sample.ray);
  for (let ray = stack.pop(); ray; ray = stack.pop()) {
    yield ray.origin;
    if (ray.hit) yield ray.hit.point;
    stack.push(...ray.rays);
  }
}

/// In which rays that miss are cut: around the scene and all that the rays touch.
export function cutBox(scene: Box | null, trace: PixelTrace): Box {
  const corners = scene ? [scene.min, scene.max] : [];
  const box = boxAround([...corners, ...placesOf(trace)]) ?? { min: [-1, -1, -1], max: [1, 1, 1] };
  return diagonalOf(box) > 0 ? grown(box, 0.1) : { min: add1(box.min, -1), max: add1(box.max, 1) };
}

const add1 = (p: Vec3, d: number): Vec3 => [p[0] + d, p[1] + d, p[2] + d];
