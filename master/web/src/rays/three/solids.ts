// The scene's solids: their bounding boxes, and a preview of each by itself, without the set operations.
import * as THREE from "three";
import type { Vec3 } from "../../app/types";
import type { SolidView } from "../scene";
import { along, between, type Box, centreOf, cross, diagonalOf, edgesOf, minus, times, unit } from "../vec";

/// Of world_from_local.
function matrixOf(rows: readonly number[]): THREE.Matrix4 {
  const [a, b, c, d, e, f, g, h, i, j, k, l] = rows as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  return new THREE.Matrix4(a, b, c, d, e, f, g, h, i, j, k, l, 0, 0, 0, 1);
}

const colorOf = (solid: SolidView): THREE.Color => new THREE.Color().setRGB(...solid.color);
const vector = (v: Vec3): THREE.Vector3 => new THREE.Vector3(...v);

/// Where an endless plane is shown: a square of it about the middle of the box.
function patchOf(solid: SolidView, box: Box): { middle: Vec3; across: Vec3; along: Vec3 } {
  const m = solid.matrix as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  const u: Vec3 = unit([m[0], m[4], m[8]]);
  const plain: Vec3 = [m[1], m[5], m[9]];
  const normal = unit(cross(u, plain));
  const at: Vec3 = [m[3], m[7], m[11]];
  const from = centreOf(box);
  const height =
    normal[0] * (from[0] - at[0]) + normal[1] * (from[1] - at[1]) + normal[2] * (from[2] - at[2]);
  const half = 0.6 * diagonalOf(box);
  return {
    middle: along(from, normal, -height),
    across: times(u, half),
    along: times(cross(normal, u), half),
  };
}

const cells = 12; // of a plane's grid, each way

function gridOf(solid: SolidView, box: Box): Vec3[] {
  const { middle, across, along: down } = patchOf(solid, box);
  const at = (i: number, j: number) =>
    along(along(middle, across, (2 * i) / cells - 1), down, (2 * j) / cells - 1);
  return Array.from({ length: cells + 1 }, (_, i) => [at(i, 0), at(i, cells), at(0, i), at(cells, i)]).flat();
}

const dashes = 8; // of an edge

/// The ends of the pieces of a line, one after another.
const dashed = (from: Vec3, to: Vec3): Vec3[] =>
  Array.from({ length: 2 * dashes }, (_, i) => between(from, to, i / (2 * dashes - 1)));

function boxLines(solid: SolidView, box: Box): Vec3[] {
  return edgesOf(box).flatMap(({ from, to }) => (solid.subtracted ? dashed(from, to) : [from, to]));
}

/// Lines in the solids' colours: the boxes, dashed where a solid is taken away, and a grid for what is endless.
export function wireframes(solids: readonly SolidView[], box: Box): THREE.LineSegments {
  const positions: number[] = [];
  const colors: number[] = [];
  for (const solid of solids) {
    const points = solid.box
      ? boxLines(solid, solid.box)
      : solid.kind === "plane"
        ? gridOf(solid, box)
        : [];
    const share = solid.box ? 1 : 0.5;
    for (const p of points) {
      positions.push(...p);
      colors.push(...solid.color, share);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colors, 4));
  return new THREE.LineSegments(
    geometry,
    new THREE.LineBasicMaterial({ vertexColors: true, transparent: true }),
  );
}

export function filledBoxes(solids: readonly SolidView[]): THREE.Object3D {
  const bounded = solids.filter((solid) => solid.box);
  const material = new THREE.MeshBasicMaterial({
    transparent: true,
    opacity: 0.16,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
  const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(), material, bounded.length);
  bounded.forEach((solid, i) => {
    const { min, max } = solid.box!;
    const size = minus(max, min);
    mesh.setMatrixAt(i, new THREE.Matrix4().makeScale(...size).setPosition(...centreOf(solid.box!)));
    mesh.setColorAt(i, colorOf(solid));
  });
  mesh.frustumCulled = false;
  return mesh;
}

/// How a solid's preview is made: a shape shared by all of its kind, and where it goes.
interface Instance {
  shape: string;
  make: () => THREE.BufferGeometry;
  place: THREE.Matrix4;
}

/// A kind that has no shape here is its bounding box.
function boxInstance({ box }: SolidView): Instance | null {
  if (!box) return null;
  const place = new THREE.Matrix4().makeScale(...minus(box.max, box.min)).setPosition(...centreOf(box));
  return { shape: "box", make: () => new THREE.BoxGeometry(), place };
}

function instanceOf(solid: SolidView, box: Box, detail: number): Instance | null {
  const world = matrixOf(solid.matrix);
  switch (solid.kind) {
    case "sphere":
      return { shape: "sphere", make: () => new THREE.SphereGeometry(1, 2 * detail, detail), place: world };
    case "cube":
      return { shape: "cube", make: () => new THREE.BoxGeometry().translate(0.5, 0.5, 0.5), place: world };
    case "torus": {
      const [R = 1, r = 0.25] = [solid.parameters.R ?? undefined, solid.parameters.r ?? undefined];
      const make = () => new THREE.TorusGeometry(1, r / R, detail, 3 * detail);
      return { shape: `torus ${r / R}`, make, place: world.scale(new THREE.Vector3(R, R, R)) };
    }
    case "cylinder": {
      const [low, high] = limitsOf(solid, world, box);
      const open = solid.parameters.z_min === null && solid.parameters.z_max === null;
      const make = () =>
        new THREE.CylinderGeometry(1, 1, 1, 2 * detail, 1, open).rotateX(Math.PI / 2).translate(0, 0, 0.5);
      const stretched = new THREE.Matrix4().makeScale(1, 1, high - low).setPosition(0, 0, low);
      return { shape: open ? "tube" : "cylinder", make, place: world.multiply(stretched) };
    }
    case "cone": {
      const [low, high] = limitsOf(solid, world, box);
      const heights = low < 0 && high > 0 ? [low, 0, high] : [low, high];
      const make = () => {
        const side = heights.map((z) => new THREE.Vector2(Math.abs(z), z));
        const outline = [new THREE.Vector2(0, low), ...side, new THREE.Vector2(0, high)];
        return new THREE.LatheGeometry(outline, 2 * detail).rotateX(Math.PI / 2);
      };
      return { shape: `cone ${low} ${high}`, make, place: world };
    }
    case "plane": {
      const { middle, across, along: down } = patchOf(solid, box);
      const place = new THREE.Matrix4().makeBasis(
        vector(across),
        vector(down),
        vector(unit(cross(across, down))),
      );
      return {
        shape: "plane",
        make: () => new THREE.PlaneGeometry(2, 2),
        place: place.setPosition(...middle),
      };
    }
    default:
      return boxInstance(solid);
  }
}

/// Of a cylinder or cone along its axis; where it is endless, as far as the box.
function limitsOf(solid: SolidView, world: THREE.Matrix4, box: Box): [number, number] {
  const local = world.clone().invert();
  const reach = edgesOf(box)
    .flatMap(({ from, to }) => [from, to])
    .map((corner) => vector(corner).applyMatrix4(local).z);
  const { z_min, z_max } = solid.parameters;
  return [z_min ?? Math.min(...reach), z_max ?? Math.max(...reach)];
}

const seeThrough = { transparent: true, opacity: 0.25, depthWrite: false };

const detailOf = (count: number): number => (count > 4000 ? 6 : count > 400 ? 10 : 24);

/// Each solid by itself: what the set operations take away is there too, but transparent.
export function preview(solids: readonly SolidView[], box: Box): THREE.Group {
  const shapes = new Map<
    string,
    { make: Instance["make"]; subtracted: boolean; items: { place: THREE.Matrix4; solid: SolidView }[] }
  >();
  for (const solid of solids) {
    const instance = instanceOf(solid, box, detailOf(solids.length));
    if (!instance) continue;
    const { shape, make, place } = instance;
    const { subtracted } = solid;
    const alike = `${shape} ${subtracted}`;
    const kept = shapes.get(alike) ?? { make, subtracted, items: [] };
    kept.items.push({ place, solid });
    shapes.set(alike, kept);
  }
  const group = new THREE.Group();
  for (const { make, subtracted, items } of shapes.values()) {
    const mesh = new THREE.InstancedMesh(
      make(),
      new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, ...(subtracted ? seeThrough : {}) }),
      items.length,
    );
    items.forEach(({ place, solid }, i) => {
      mesh.setMatrixAt(i, place);
      mesh.setColorAt(i, colorOf(solid));
    });
    mesh.frustumCulled = false;
    group.add(mesh);
  }
  return group;
}
