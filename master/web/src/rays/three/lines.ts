// Rays as lines of some pixels' width, with a rim that sets them off, and seen faintly through what hides them.
import * as THREE from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Segment } from "../segments";
import { accent, penOf, type Pen } from "../strokes";
import type { Look } from "./stage";

type Line = Pick<Segment, "from" | "to">;

function materialOf(pen: Pen, change: Partial<Pen>, parameters: THREE.MaterialParameters): LineMaterial {
  const { color, dash, width, opacity } = { ...pen, ...change };
  const material = new LineMaterial({ ...parameters, color, linewidth: width, opacity, transparent: true });
  if (dash) {
    material.dashed = true;
    [material.dashSize, material.gapSize] = dash;
  }
  material.depthWrite = false;
  material.side = THREE.DoubleSide; // made on the screen, so the mirrored world does not turn it
  return material;
}

function geometryOf(lines: readonly Line[]): LineSegmentsGeometry {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(Float32Array.from(lines.flatMap(({ from, to }) => [...from, ...to])));
  return geometry;
}

function drawn(geometry: LineSegmentsGeometry, material: LineMaterial, order: number): LineSegments2 {
  const lines = new LineSegments2(geometry, material);
  lines.renderOrder = order;
  lines.frustumCulled = false;
  if (material.dashed) lines.computeLineDistances();
  return lines;
}

/// Lines of one pen.
export function linesOf(lines: readonly Line[], pen: Pen): THREE.Group {
  const geometry = geometryOf(lines);
  const behind = { depthFunc: THREE.GreaterDepth };
  const group = new THREE.Group();
  group.add(
    drawn(geometry, materialOf(pen, { opacity: 0.3 * pen.opacity }, behind), 10),
    drawn(
      geometry,
      materialOf(pen, { color: pen.halo, width: pen.width + 2, opacity: 0.55 * pen.opacity }, {}),
      11,
    ),
    drawn(geometry, materialOf(pen, {}, {}), 13),
  );
  return group;
}

/// All segments, those of a pen together.
export function raysOf(segments: readonly Segment[], importanceAs: string): THREE.Group {
  const byPen = new Map<string, { pen: Pen; lines: Segment[] }>();
  for (const segment of segments) {
    const pen = penOf(segment, importanceAs);
    const key = JSON.stringify(pen);
    const kept = byPen.get(key) ?? { pen, lines: [] };
    kept.lines.push(segment);
    byPen.set(key, kept);
  }
  const group = new THREE.Group();
  for (const { pen, lines } of byPen.values()) group.add(linesOf(lines, pen));
  return group;
}

/// A wide glow behind lines that are marked; it is seen through everything.
export function glowOf(
  lines: readonly Line[],
  width: number,
  opacity: number,
  color: string = accent,
): THREE.Group {
  const group = new THREE.Group();
  const pen: Pen = { color, halo: color, dash: null, width, opacity };
  if (lines.length > 0) group.add(drawn(geometryOf(lines), materialOf(pen, {}, { depthTest: false }), 12));
  return group;
}

/// Dashes keep their length on the screen.
export function fitDashes(parts: THREE.Object3D, look: Look, distance: number): void {
  const scale = 1 / look.pixelAt(distance);
  parts.traverse((object) => {
    if (object instanceof LineSegments2 && object.material.dashed) object.material.dashScale = scale;
  });
}
