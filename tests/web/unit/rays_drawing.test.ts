import { describe, expect, it } from "vitest";
import { svgOf } from "../../../master/web/src/rays/drawing";
import { framed, type Pose } from "../../../master/web/src/rays/pose";
import type { SceneView } from "../../../master/web/src/rays/scene";
import { cutBox, segmentsOf } from "../../../master/web/src/rays/segments";
import { outlierColor, penOf } from "../../../master/web/src/rays/strokes";
import { entriesOf } from "../../../master/web/src/rays/trace";
import { glass } from "./rays_traces";

const segments = segmentsOf(entriesOf(glass), cutBox(null, glass));
const look: Pose = { eye: [0, 0, -5], target: [0, 0, 0], up: [0, 1, 0], angleDeg: 40, orthographic: false };
const pose = framed(
  look,
  segments.flatMap(({ from, to }) => [from, to]),
  2,
);
const unitBox = { min: [0, 0, 0], max: [1, 1, 1] } as const;
const scene = {
  background: [1, 0, 0],
  camera: { from: glass.samples[0]!.ray.origin },
  lights: [{ kind: "ambient" }, { kind: "point", at: [-5, 4, -3] }],
  solids: [{ leaf: 0, name: "a", kind: "cube", color: [0, 1, 0], box: unitBox, matrix: [], parameters: {} }],
} as unknown as SceneView;
const drawing = {
  pose,
  width: 400,
  height: 200,
  scene,
  boxes: true,
  icons: true,
  segments,
  outliers: [],
  importanceAs: "nothing",
  title: "a < b",
};

describe("the drawing of the rays", () => {
  const svg = svgOf(drawing);

  it("has a line for each segment in its colour, and twelve for a box", () => {
    for (const stroke of ["camera", "reflected", "refracted", "shadow", "blocked"] as const) {
      const of = segments.filter((segment) => segment.stroke === stroke);
      const { color } = penOf(of[0]!, "nothing");
      expect(svg.split(`stroke="${color}"`).length - 1, stroke).toBe(of.length);
    }
    expect(svg.split('stroke="rgb(0 255 0)"').length - 1).toBe(12);
    expect(svg).toContain('fill="rgb(255 0 0)"');
  });

  it("dashes the box of a solid that is taken away", () => {
    const solids = scene.solids.map((solid) => ({ ...solid, subtracted: true }));
    const dashed = svgOf({ ...drawing, scene: { ...scene, solids }, segments: [] });
    expect(dashed.match(/stroke="rgb\(0 255 0\)"[^>]*stroke-dasharray/g)).toHaveLength(12);
    expect(svgOf({ ...drawing, segments: [] })).not.toContain("stroke-dasharray");
  });

  it("marks the outliers, below the rays", () => {
    const outliers = segments.slice(0, 2);
    const marked = svgOf({ ...drawing, outliers });
    expect(svg).not.toContain(outlierColor);
    expect(marked.split(`stroke="${outlierColor}"`).length - 1).toBe(2);
    expect(marked.indexOf(outlierColor)).toBeLessThan(marked.indexOf(penOf(segments[0]!, "nothing").color));
  });

  it("names the camera and the lights that have a place", () => {
    expect(svg).toContain(">camera</text>");
    expect(svg).toContain(">light 1</text>");
    expect(svg).not.toContain("light 0");
    expect(svgOf({ ...drawing, icons: false })).not.toContain("<text");
  });

  it("is well formed, with its title escaped", () => {
    expect(svg).toContain("<title>a &lt; b</title>");
    for (const [tag] of svg.matchAll(/<(line|rect|circle) [^>]*>/g)) expect(tag).toMatch(/\/>$/);
    expect(svg.trimEnd().endsWith("</svg>")).toBe(true);
  });

  it("shows importance as width or opacity", () => {
    const weak = { stroke: "camera", missed: false, importance: 0.06 } as const;
    const strong = { ...weak, importance: 1 };
    expect(penOf(weak, "width").width).toBeLessThan(penOf(strong, "width").width);
    expect(penOf(weak, "opacity").opacity).toBeLessThan(penOf(strong, "opacity").opacity);
    expect(penOf(weak, "nothing")).toEqual(penOf(strong, "nothing"));
    expect(penOf(strong, "width").width).toBe(3);
  });
});
