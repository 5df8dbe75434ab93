// Small things that keep their size on the screen or lie beside the rays: icons, axes, dots, normals, the cloud.
import * as THREE from "three";
import type { Vec3 } from "../../app/types";
import type { Cloud } from "../ply";
import type { SceneView } from "../scene";
import { along, between, centreOf, lengthOf, minus, type Box } from "../vec";
import { cameraIcon, dotIcon, letterIcon, lightIcon } from "./icons";
import { linesOf } from "./lines";
import type { Look } from "./stage";

/// A picture that faces the viewer, so many pixels high.
function billboard(at: Vec3, canvas: HTMLCanvasElement, pixels: number): THREE.Sprite {
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthTest: false, transparent: true }));
  sprite.position.set(...at);
  sprite.userData.pixels = pixels;
  sprite.renderOrder = 20;
  return sprite;
}

/// Sprites keep their size on the screen.
export function fitSprites(parts: THREE.Object3D, look: Look): void {
  parts.traverse((object) => {
    if (!(object instanceof THREE.Sprite)) return;
    const distance = lengthOf(minus(object.position.toArray() as Vec3, look.pose.eye));
    object.scale.setScalar(look.pixelAt(distance) * (object.userData.pixels as number));
  });
}

/// The camera and the lights that have a place.
export function icons(scene: SceneView): THREE.Group {
  const group = new THREE.Group();
  group.add(billboard(scene.camera.from, cameraIcon(), 30));
  for (const light of scene.lights) {
    if (light.kind === "ambient") continue;
    if (light.kind === "point") {
      group.add(billboard(light.at, lightIcon(), 30));
      continue;
    }
    const { at, width, height } = light;
    const corners = [at, along(at, width, 1), along(along(at, width, 1), height, 1), along(at, height, 1)];
    const sides = corners.map((from, i) => ({ from, to: corners[(i + 1) % 4]! }));
    group.add(linesOf(sides, { color: "#ffe27a", halo: "#000000", dash: null, width: 2, opacity: 1 }));
    group.add(billboard(between(corners[0]!, corners[2]!, 0.5), lightIcon(), 30));
  }
  return group;
}

/// Of the world, at its origin; x, y, z as far as the scene is large.
export function axes(length: number): THREE.Group {
  const group = new THREE.Group();
  const colors = ["#e0736b", "#7fc46f", "#6f9fe8"];
  ["x", "y", "z"].forEach((name, i) => {
    const to: Vec3 = [0, 0, 0];
    to[i] = length;
    const color = colors[i]!;
    group.add(
      linesOf([{ from: [0, 0, 0], to }], { color, halo: "#000000", dash: null, width: 1.5, opacity: 0.9 }),
    );
    group.add(billboard(to, letterIcon(name, color), 18));
  });
  return group;
}

/// Round dots of so many pixels; larger ones lie below smaller ones.
export function dots(points: readonly Vec3[], pixels: number, color: string): THREE.Points {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points.flat(), 3));
  const map = new THREE.CanvasTexture(dotIcon());
  map.colorSpace = THREE.SRGBColorSpace;
  const size = pixels * Math.min(devicePixelRatio, 2);
  const material = new THREE.PointsMaterial({
    map,
    size,
    color,
    sizeAttenuation: false,
    transparent: true,
    depthTest: false,
  });
  const drawn = new THREE.Points(geometry, material);
  drawn.renderOrder = 15 + 1 / pixels;
  drawn.frustumCulled = false;
  return drawn;
}

export function normals(hits: readonly { point: Vec3; normal: Vec3 }[], length: number): THREE.Group {
  const lines = hits.map(({ point, normal }) => ({ from: point, to: along(point, normal, length) }));
  return linesOf(lines, { color: "#9dc3ff", halo: "#000000", dash: null, width: 1.8, opacity: 1 });
}

/// The points come with z mirrored.
export function cloudPoints(cloud: Cloud): THREE.Points {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(cloud.positions, 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(cloud.colors, 3, true));
  const size = 2 * Math.min(devicePixelRatio, 2);
  return new THREE.Points(
    geometry,
    new THREE.PointsMaterial({ size, sizeAttenuation: false, vertexColors: true }),
  );
}

export const axesLength = (box: Box): number => 0.35 * lengthOf(minus(box.max, centreOf(box)));
