import { describe, expect, it } from "vitest";
import type { Vec3 } from "../../../master/web/src/app/types";
import { jumpBy, pose, setAspect, show } from "../../../master/web/src/rays/camera";
import {
  alike,
  alongRay,
  axesOf,
  distanceOf,
  framed,
  moved,
  orbited,
  overview,
  poseBetween,
  zoomed,
  type Pose,
} from "../../../master/web/src/rays/pose";
import { distanceTo, nearestSegment, projectorOf } from "../../../master/web/src/rays/projection";
import { along, dot, lengthOf, minus } from "../../../master/web/src/rays/vec";
import { glass } from "./rays_traces";

/// As the camera of the scene: x right, y up, z away.
const front: Pose = { eye: [0, 0, -5], target: [0, 0, 0], up: [0, 1, 0], angleDeg: 90, orthographic: false };
const close = (a: Vec3, b: Vec3, digits = 9) => a.forEach((x, i) => expect(x).toBeCloseTo(b[i]!, digits));

describe("the view", () => {
  it("has x to the right and y upwards when it looks along z, as pictures do", () => {
    close(axesOf(front).right, [1, 0, 0]);
    close(axesOf(front).up, [0, 1, 0]);
    const projector = projectorOf(front, 200, 100);
    expect(projector.point([5, 0, 0])).toEqual({ x: 150, y: 50 });
    expect(projector.point([0, 5, 0])!.y).toBeCloseTo(0, 9);
    expect(projector.point([0, 0, -6])).toBeNull();
  });

  it("shows the target as large orthographically as in perspective", () => {
    const flat = projectorOf({ ...front, orthographic: true }, 200, 100);
    expect(flat.point([5, 0, 0])).toEqual({ x: 150, y: 50 });
    expect(flat.point([5, 0, 100])).toEqual({ x: 150, y: 50 });
  });

  it("turns around the target, at the same distance", () => {
    const turned = orbited(front, 0.4, 0.3);
    expect(turned.target).toEqual(front.target);
    expect(distanceOf(turned)).toBeCloseTo(5, 12);
    close(orbited(turned, -0.4, 0).eye, orbited(front, 0, 0.3).eye);
    expect(turned.eye[1]).toBeGreaterThan(0); // upwards: it looks down
    expect(turned.eye[0]).toBeLessThan(0); // to the right: what is in front moves to the right
  });

  it("never tips over at the pole", () => {
    const above = orbited(front, 0, 10);
    expect(dot(axesOf(above).up, front.up)).toBeGreaterThan(0);
    close(axesOf(above).right, [1, 0, 0], 6);
  });

  it("moves by shares of what is seen, and back", () => {
    const step = moved(front, 0.5, 0.25, 0.1);
    close(step.target, [5, 2.5, 0.5]);
    expect(alike(moved(step, -0.5, -0.25, -0.1), front)).toBe(true);
    expect(distanceOf(zoomed(front, 2))).toBeCloseTo(2.5, 12);
  });

  it("aligned with a ray has its end in the middle and its start at the eye", () => {
    const { origin, direction, hit } = glass.samples[0]!.ray;
    const aligned = alongRay(front, origin, direction, hit!.distance, [0, 1, 0]);
    close(aligned.target, hit!.point);
    const middle = projectorOf(aligned, 640, 480).point(hit!.point)!;
    expect(middle.x).toBeCloseTo(320, 6);
    expect(middle.y).toBeCloseTo(240, 6);
    expect(dot(axesOf(aligned).up, [0, 1, 0])).toBeGreaterThan(0);
  });

  it("aligned with a ray straight up still has a right and an up", () => {
    const { right, up, forward } = axesOf(alongRay(front, [0, 0, 0], [0, 2, 0], 3, [0, 1, 0]));
    close(forward, [0, 1, 0]);
    for (const axis of [right, up]) expect(lengthOf(axis)).toBeCloseTo(1, 12);
  });

  it("that frames places shows them all, the outermost at its edge", () => {
    const places: Vec3[] = [
      [0, 0, 0],
      [8, 1, 2],
      [-3, 4, 9],
      [1, -2, 4],
    ];
    for (const pose of [
      framed(orbited(front, 0.5, 0.2), places, 2),
      overview(places, [0, -0.2, 1], [0, 1, 0], 2),
    ]) {
      const shares = places.map((place) => {
        const { x, y } = projectorOf(pose, 200, 100).point(place)!;
        return Math.max(Math.abs(x / 100 - 1), Math.abs(y / 50 - 1));
      });
      expect(Math.max(...shares)).toBeLessThanOrEqual(1 + 1e-9);
      expect(Math.max(...shares)).toBeGreaterThan(0.5);
    }
    expect(Number.isFinite(distanceOf(framed(front, [[2, 2, 2]], 1)))).toBe(true);
  });

  it("on its way ends where it goes", () => {
    const there = moved(orbited(zoomed(front, 0.3), 2, 0.5), 1, 1, 1);
    let pose = front;
    for (let i = 0; i < 60 && !alike(pose, there); ++i) pose = poseBetween(pose, there, 0.3);
    expect(alike(pose, there)).toBe(true);
    expect(Number.isFinite(lengthOf(poseBetween(front, { ...front, eye: [0, 0, 5] }, 0.5).eye))).toBe(true);
  });
});

describe("picking", () => {
  const projector = projectorOf(front, 200, 100);
  const line = (id: string, from: Vec3, to: Vec3) => ({ id, from, to });

  it("finds the nearest line within reach", () => {
    const lines = [line("low", [-5, -1, 0], [5, -1, 0]), line("high", [-5, 1, 0], [5, 1, 0])];
    expect(nearestSegment(lines, projector, 100, 42, 7)?.id).toBe("high");
    expect(nearestSegment(lines, projector, 100, 57, 7)?.id).toBe("low");
    expect(nearestSegment(lines, projector, 100, 20, 7)).toBeNull();
  });

  it("finds a line that begins behind the viewer", () => {
    const [from, to]: [Vec3, Vec3] = [
      [1, 0, -20],
      [1, 0, 20],
    ];
    const near = projector.point(along(from, minus(to, from), 0.5))!;
    expect(nearestSegment([line("long", from, to)], projector, near.x, near.y, 3)?.id).toBe("long");
    expect(projector.segment([0, 0, -20], [1, 0, -10])).toBeNull();
  });

  it("measures to the ends of a segment", () => {
    expect(
      distanceTo(
        [
          { x: 0, y: 0 },
          { x: 10, y: 0 },
        ],
        13,
        4,
      ),
    ).toBe(5);
    expect(
      distanceTo(
        [
          { x: 2, y: 2 },
          { x: 2, y: 2 },
        ],
        2,
        5,
      ),
    ).toBe(3);
  });
});

describe("the 3D view", () => {
  const places: Vec3[] = [
    [-4, 0, 0],
    [4, 1, 2],
  ];
  const forward: Vec3 = [0, 0, 1];
  const up: Vec3 = [0, 1, 0];

  it("shows the whole scene in a canvas of any shape, until somebody moves it", () => {
    show(places, forward, up);
    for (const aspect of [2, 0.5]) {
      setAspect(aspect);
      expect(pose.value).toEqual(overview(places, forward, up, aspect));
    }
    jumpBy((from) => moved(from, 0.1, 0, 0));
    const chosen = pose.value;
    setAspect(1);
    expect(pose.value).toBe(chosen);
  });
});
