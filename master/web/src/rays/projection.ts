// Where world points appear in the 3D view, for picking and for drawings.
import type { Vec3 } from "../app/types";
import { axesOf, distanceOf, type Pose } from "./pose";
import { between, dot, minus } from "./vec";

export interface Point2 {
  x: number; // pixels from the upper left
  y: number;
}

export interface Projector {
  point(p: Vec3): Point2 | null; // null behind the viewer
  segment(from: Vec3, to: Vec3): [Point2, Point2] | null; // cut at the viewer
}

export function projectorOf(pose: Pose, width: number, height: number): Projector {
  const { right, up, forward } = axesOf(pose);
  const distance = distanceOf(pose);
  const focal = height / 2 / Math.tan((pose.angleDeg * Math.PI) / 360);
  const near = pose.orthographic ? -Infinity : 1e-4 * distance;
  const depthOf = (p: Vec3) => dot(minus(p, pose.eye), forward);
  const seen = (p: Vec3): Point2 => {
    const d = minus(p, pose.eye);
    const scale = focal / (pose.orthographic ? distance : dot(d, forward));
    return { x: width / 2 + dot(d, right) * scale, y: height / 2 - dot(d, up) * scale };
  };
  return {
    point: (p) => (depthOf(p) > near ? seen(p) : null),
    segment(from, to) {
      const a = depthOf(from);
      const b = depthOf(to);
      if (a <= near && b <= near) return null;
      const cut = (inside: Vec3, outside: Vec3, i: number, o: number) =>
        between(inside, outside, (i - near * 1.01) / (i - o));
      return [seen(a > near ? from : cut(to, from, b, a)), seen(b > near ? to : cut(from, to, a, b))];
    },
  };
}

/// From a point to a segment, in pixels.
export function distanceTo([a, b]: [Point2, Point2], x: number, y: number): number {
  const dx = b.x - a.x;
  const dy = b.y - a.y;
  const square = dx * dx + dy * dy;
  const t = square > 0 ? Math.max(0, Math.min(1, ((x - a.x) * dx + (y - a.y) * dy) / square)) : 0;
  return Math.hypot(a.x + t * dx - x, a.y + t * dy - y);
}

/// The nearest segment within the limit; of equally near ones the first.
export function nearestSegment<T extends { from: Vec3; to: Vec3 }>(
  segments: readonly T[],
  projector: Projector,
  x: number,
  y: number,
  limit: number,
): T | null {
  let best: T | null = null;
  let least = limit;
  for (const segment of segments) {
    const line = projector.segment(segment.from, segment.to);
    const distance = line ? distanceTo(line, x, y) : Infinity;
    if (distance < least) [best, least] = [segment, distance];
  }
  return best;
}
