// Where the 3D view stands and where it is going.
import { signal } from "@preact/signals";
import { alongRay, alike, moved, orbited, overview, poseBetween, zoomed, type Pose } from "./pose";
import type { Vec3 } from "../app/types";

/// What an overview shows.
interface Subject {
  places: readonly Vec3[];
  cameraDirection: Vec3;
  up: Vec3;
}
let subject: Subject = {
  places: [
    [-1, -1, -1],
    [1, 1, 1],
  ],
  cameraDirection: [0, 0, 1],
  up: [0, 1, 0],
};
/// Of the canvas: its width over its height.
let aspect = 1.3;
const overviewOf = (): Pose => overview(subject.places, subject.cameraDirection, subject.up, aspect);

export const pose = signal<Pose>(overviewOf());
const goal = signal<Pose>(pose.value);
/// The last overview; the goal as long as nobody has moved the view.
let home = pose.value;
const goHome = (go: (to: Pose) => void): void =>
  go((home = { ...overviewOf(), orthographic: goal.value.orthographic }));

/// An overview stays one in a canvas of another shape.
export function setAspect(value: number): void {
  aspect = value;
  if (goal.value === home) goHome(jumpTo);
}
/// Differs from pose while the view is on its way.
export const isStill = (): boolean => pose.value === goal.value;

function jumpTo(to: Pose): void {
  goal.value = pose.value = to;
}

function goTo(to: Pose): void {
  goal.value = to;
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) pose.value = to;
}

/// Steps from where the view is going, so that repeated keys add up.
const goBy = (step: (from: Pose) => Pose): void => goTo(step(goal.value));
/// Follows the hand at once.
export const jumpBy = (step: (from: Pose) => Pose): void => jumpTo(step(pose.value));

const settling = 90; // milliseconds until a way is down to its 1/e

/// After so many milliseconds more.
export function approach(milliseconds: number): void {
  if (isStill()) return;
  const next = poseBetween(pose.value, goal.value, 1 - Math.exp(-milliseconds / settling));
  pose.value = alike(next, goal.value) ? goal.value : next;
}

/// A new scene is seen whole at first.
export function show(places: readonly Vec3[], cameraDirection: Vec3, up: Vec3): void {
  subject = { places, cameraDirection, up };
  goHome(jumpTo);
}

export const reset = (): void => goHome(goTo);
export const toggleOrthographic = (): void =>
  jumpBy((from) => ({ ...from, orthographic: !from.orthographic }));
export const step = (right: number, up: number, forward: number): void =>
  goBy((from) => moved(from, right, up, forward));
export const turn = (right: number, down: number): void => goBy((from) => orbited(from, right, down));
export const zoom = (factor: number): void => goBy((from) => zoomed(from, factor));

/// From the ray's origin along it; its end is in the middle, where turning goes around.
export function lookAlong(origin: Vec3, direction: Vec3, distance: number): void {
  goBy((from) => alongRay(from, origin, direction, distance, subject.up));
}
