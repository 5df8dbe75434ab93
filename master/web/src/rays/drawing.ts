// The rays as a drawing: what the 3D view shows, as SVG.
import { cssOf } from "./color";
import type { Pose } from "./pose";
import { projectorOf, type Point2, type Projector } from "./projection";
import type { SceneView } from "./scene";
import type { Segment } from "./segments";
import { outlierColor, penOf, styles } from "./strokes";
import { add, along, edgesOf } from "./vec";

const escaped = (text: string): string =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
const line = ([a, b]: [Point2, Point2], attributes: string): string =>
  `<line x1="${a.x.toFixed(2)}" y1="${a.y.toFixed(2)}" x2="${b.x.toFixed(2)}" y2="${b.y.toFixed(2)}" ${attributes}/>`;

export interface Drawing {
  pose: Pose;
  width: number;
  height: number;
  scene: SceneView | null;
  boxes: boolean;
  icons: boolean;
  segments: readonly Segment[];
  outliers: readonly Segment[]; // those of them that are marked
  importanceAs: string;
  title: string;
}

/// The camera and the lights, as dots with their names.
function marksOf({ scene, icons }: Drawing, projector: Projector): string[] {
  if (!scene || !icons) return [];
  const lights = scene.lights.flatMap((light, i) => {
    if (light.kind === "ambient") return [];
    const middle = light.kind === "point" ? light.at : along(light.at, add(light.width, light.height), 0.5);
    return [{ at: middle, name: `light ${i}`, color: styles.shadow.color }];
  });
  const camera = { at: scene.camera.from, name: "camera", color: styles.camera.color };
  return [camera, ...lights].flatMap(({ at, name, color }) => {
    const seen = projector.point(at);
    if (!seen) return [];
    const [x, y] = [seen.x.toFixed(2), seen.y.toFixed(2)];
    return [
      `<circle cx="${x}" cy="${y}" r="5" fill="${color}" stroke="#14171c" stroke-width="1.5"/>`,
      `<text x="${x}" y="${y}" dx="8" dy="-8" font-family="sans-serif" font-size="12" fill="${color}">${name}</text>`,
    ];
  });
}

/// The rays as the view shows them, over the boxes.
export function svgOf(drawing: Drawing): string {
  const { width, height } = drawing;
  const projector = projectorOf(drawing.pose, width, height);
  const boxes = (drawing.boxes && drawing.scene ? drawing.scene.solids : []).flatMap((solid) => {
    const edges = solid.box ? edgesOf(solid.box) : [];
    return edges.flatMap(({ from, to }) => {
      const seen = projector.segment(from, to);
      const dash = solid.subtracted ? ` stroke-dasharray="5 5"` : "";
      return seen ? [line(seen, `stroke="${cssOf(solid.color)}" stroke-opacity="0.7"${dash}`)] : [];
    });
  });
  const marks = drawing.outliers.flatMap((segment) => {
    const seen = projector.segment(segment.from, segment.to);
    return seen ? [line(seen, `stroke="${outlierColor}" stroke-width="8" stroke-opacity="0.6"`)] : [];
  });
  const rays = drawing.segments.flatMap((segment) => {
    const seen = projector.segment(segment.from, segment.to);
    if (!seen) return [];
    const pen = penOf(segment, drawing.importanceAs);
    const dash = pen.dash ? ` stroke-dasharray="${pen.dash.join(" ")}"` : "";
    return [
      line(
        seen,
        `stroke="${pen.color}" stroke-width="${pen.width.toFixed(2)}" stroke-opacity="${pen.opacity.toFixed(2)}"${dash}`,
      ),
    ];
  });
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">`,
    `<title>${escaped(drawing.title)}</title>`,
    `<rect width="${width}" height="${height}" fill="${cssOf(drawing.scene?.background ?? [1, 1, 1])}"/>`,
    `<g fill="none" stroke-linecap="round">`,
    ...boxes,
    ...marks,
    ...rays,
    `</g>`,
    ...marksOf(drawing, projector),
    `</svg>`,
    "",
  ].join("\n");
}
