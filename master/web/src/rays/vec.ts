// Vectors and boxes of the scene's world: x right, y up, z away from a viewer who looks along it (left-handed).
import type { Vec3 } from "../app/types";

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const lengthOf = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const unit = (a: Vec3): Vec3 => times(a, 1 / lengthOf(a));
export const along = (from: Vec3, direction: Vec3, t: number): Vec3 => add(from, times(direction, t));
export const between = (a: Vec3, b: Vec3, t: number): Vec3 => along(a, minus(b, a), t);

/// Any unit vector square to the unit vector.
export function squareTo(a: Vec3): Vec3 {
  return unit(cross(a, Math.abs(a[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
}

export interface Box {
  min: Vec3;
  max: Vec3;
}

export const centreOf = (box: Box): Vec3 => between(box.min, box.max, 0.5);
export const diagonalOf = (box: Box): number => lengthOf(minus(box.max, box.min));

/// Around all the points; null around none.
export function boxAround(points: Iterable<Vec3>): Box | null {
  let box: Box | null = null;
  for (const p of points) {
    if (!box) box = { min: [...p], max: [...p] };
    for (const i of [0, 1, 2] as const) {
      box.min[i] = Math.min(box.min[i], p[i]);
      box.max[i] = Math.max(box.max[i], p[i]);
    }
  }
  return box;
}

/// On each side by this share of the diagonal.
export function grown(box: Box, share: number): Box {
  const d = diagonalOf(box) * share;
  return { min: add(box.min, [-d, -d, -d]), max: add(box.max, [d, d, d]) };
}

/// How far a ray goes until it leaves the box for good; null if it never is in it.
export function exitOf(box: Box, origin: Vec3, direction: Vec3): number | null {
  let enter = 0;
  let leave = Infinity;
  for (const i of [0, 1, 2] as const) {
    if (direction[i] === 0) {
      if (origin[i] < box.min[i] || origin[i] > box.max[i]) return null;
      continue;
    }
    const a = (box.min[i] - origin[i]) / direction[i];
    const b = (box.max[i] - origin[i]) / direction[i];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave && leave < Infinity ? leave : null;
}

// The corners of [0,1]^3 that an edge joins differ in one bit.
const edges = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((a) =>
  [1, 2, 4].filter((bit) => !(a & bit)).flatMap((bit) => [a, a | bit]),
);

/// The twelve edges of a box.
export function edgesOf({ min, max }: Box): { from: Vec3; to: Vec3 }[] {
  const corner = (bits: number): Vec3 => [0, 1, 2].map((i) => (bits & (1 << i) ? max : min)[i]) as Vec3;
  return Array.from({ length: 12 }, (_, i) => ({
    from: corner(edges[2 * i]!),
    to: corner(edges[2 * i + 1]!),
  }));
}
