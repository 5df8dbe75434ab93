// From where and how the 3D view looks at the world, as a value. Left-handed as the world: right = up x forward.
import type { Vec3 } from "../app/types";
import {
  add,
  along,
  between,
  boxAround,
  centreOf,
  cross,
  diagonalOf,
  dot,
  lengthOf,
  minus,
  squareTo,
  times,
  unit,
} from "./vec";

export interface Pose {
  eye: Vec3;
  target: Vec3; // what turning goes around
  up: Vec3; // unit; roughly upwards in the view
  angleDeg: number; // vertical
  orthographic: boolean; // shows the target as large as the perspective does
}

export interface Axes {
  right: Vec3;
  up: Vec3;
  forward: Vec3;
}

export const distanceOf = (pose: Pose): number => lengthOf(minus(pose.target, pose.eye));

export function axesOf(pose: Pose): Axes {
  const forward = unit(minus(pose.target, pose.eye));
  const across = cross(pose.up, forward);
  const right = lengthOf(across) > 1e-9 ? unit(across) : squareTo(forward);
  return { right, up: cross(forward, right), forward };
}

/// About a unit axis. Source: O. Rodrigues, 1840.
function turned(v: Vec3, axis: Vec3, angle: number): Vec3 {
  const c = Math.cos(angle);
  const around = add(times(v, c), times(cross(axis, v), Math.sin(angle)));
  return along(around, axis, dot(axis, v) * (1 - c));
}

const poleMargin = 0.02; // radians that stay between the view and straight up or down

/// Around the target, as a hand turns what it holds: its near side goes to the right, the eye up. In radians.
export function orbited(pose: Pose, right: number, up: number): Pose {
  const axes = axesOf(pose);
  const height = Math.asin(Math.max(-1, Math.min(1, dot(axes.forward, pose.up)))); // of the view's direction
  const limit = Math.PI / 2 - poleMargin;
  const tilt = Math.max(-limit, Math.min(limit, height - up)) - height;
  const tilted = turned(minus(pose.eye, pose.target), axes.right, -tilt);
  return { ...pose, eye: add(pose.target, turned(tilted, pose.up, right)) };
}

/// By shares of the view's height, in the plane of the view; the distance for `forward`.
export function moved(pose: Pose, right: number, up: number, forward: number): Pose {
  const axes = axesOf(pose);
  const distance = distanceOf(pose);
  const height = 2 * distance * Math.tan((pose.angleDeg * Math.PI) / 360);
  const way = add(
    add(times(axes.right, right * height), times(axes.up, up * height)),
    times(axes.forward, forward * distance),
  );
  return { ...pose, eye: add(pose.eye, way), target: add(pose.target, way) };
}

/// Towards the target; larger than 1 is nearer.
export function zoomed(pose: Pose, factor: number): Pose {
  return { ...pose, eye: along(pose.target, minus(pose.eye, pose.target), 1 / factor) };
}

/// From the ray's origin along it, with what it hits (at the distance) in the middle.
export function alongRay(pose: Pose, origin: Vec3, direction: Vec3, distance: number, up: Vec3): Pose {
  const forward = unit(direction);
  const straight = lengthOf(cross(unit(up), forward)) < 1e-6;
  return {
    ...pose,
    eye: origin,
    target: along(origin, forward, distance),
    up: straight ? squareTo(forward) : unit(up),
  };
}

/// Looks along the pose's direction, so that all the places are just seen. The aspect is the view's width over its
/// height.
export function framed(pose: Pose, places: readonly Vec3[], aspect: number): Pose {
  const { right, up, forward } = axesOf(pose);
  // The middle of what is seen, not of the box around it.
  const seen = boxAround(
    places.map((place): Vec3 => [dot(place, right), dot(place, up), dot(place, forward)]),
  )!;
  const [x, y, z] = centreOf(seen);
  const target = add(add(times(right, x), times(up, y)), times(forward, z));
  const tangent = Math.tan((pose.angleDeg * Math.PI) / 360);
  const needed = places.map((place) => {
    const p = minus(place, target);
    return Math.max(Math.abs(dot(p, right)) / aspect, Math.abs(dot(p, up))) / tangent - dot(p, forward);
  });
  const distance = Math.max(...needed, diagonalOf(seen) / 100) || 1;
  return { ...pose, target, eye: along(target, forward, -distance) };
}

/// All the places, seen from beside and above the scene's camera, with a margin.
export function overview(places: readonly Vec3[], cameraDirection: Vec3, up: Vec3, aspect: number): Pose {
  const behind: Pose = {
    eye: times(unit(cameraDirection), -1),
    target: [0, 0, 0],
    up: unit(up),
    angleDeg: 40,
    orthographic: false,
  };
  return zoomed(framed(orbited(behind, -0.7, 0.35), places, aspect), 0.92);
}

/// On the way from one to the other; keeps the distance from its target as it turns.
export function poseBetween(a: Pose, b: Pose, t: number): Pose {
  const target = between(a.target, b.target, t);
  const back = between(unit(minus(a.eye, a.target)), unit(minus(b.eye, b.target)), t);
  const distance = distanceOf(a) + (distanceOf(b) - distanceOf(a)) * t;
  const direction = lengthOf(back) > 1e-6 ? unit(back) : axesOf(a).right;
  const up = between(a.up, b.up, t);
  return { ...b, target, eye: along(target, direction, distance), up: lengthOf(up) > 1e-6 ? unit(up) : b.up };
}

/// So alike that nobody sees a difference.
export function alike(a: Pose, b: Pose): boolean {
  const limit = 1e-3 * distanceOf(b);
  const near = (p: Vec3, q: Vec3) => lengthOf(minus(p, q)) <= limit;
  return near(a.eye, b.eye) && near(a.target, b.target) && lengthOf(minus(a.up, b.up)) <= 1e-3;
}
