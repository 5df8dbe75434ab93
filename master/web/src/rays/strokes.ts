// How each kind of ray is drawn; the legend, the 3D view and the drawings agree on it.
import type { Segment, Stroke } from "./segments";

interface Style {
  color: string;
  halo: string; // sets the line off from any background
  dash: [on: number, off: number] | null; // pixels
  width: number; // pixels, at full importance
}

export const styles: Record<Stroke, Style> = {
  camera: { color: "#ff2d2d", halo: "#000000", dash: null, width: 3 },
  reflected: { color: "#ff8566", halo: "#000000", dash: null, width: 3 },
  refracted: { color: "#ff4d8d", halo: "#000000", dash: [9, 5], width: 3 },
  shadow: { color: "#ffd23f", halo: "#000000", dash: null, width: 2 },
  blocked: { color: "#17191d", halo: "#aab2bd", dash: [5, 5], width: 2 },
};

export const accent = "#2fb8ff"; // marks what is pointed at
export const outlierColor = "#b467ff"; // marks the samples that stand out

/// Importance in four steps, so that lines of a step are drawn together: 0 is the least.
type Step = 0 | 1 | 2 | 3;
const stepOf = (importance: number): Step =>
  importance >= 0.5 ? 3 : importance >= 0.2 ? 2 : importance >= 0.08 ? 1 : 0;
const widthOf: Record<Step, number> = { 0: 0.4, 1: 0.6, 2: 0.8, 3: 1 };
const opacityOf: Record<Step, number> = { 0: 0.25, 1: 0.45, 2: 0.7, 3: 1 };

export interface Pen {
  color: string;
  halo: string;
  dash: [number, number] | null;
  width: number;
  opacity: number;
}

export function penOf(segment: Pick<Segment, "stroke" | "missed" | "importance">, importanceAs: string): Pen {
  const style = styles[segment.stroke];
  const step = stepOf(segment.importance);
  return {
    ...style,
    width: style.width * (importanceAs === "width" ? widthOf[step] : 1),
    opacity: (importanceAs === "opacity" ? opacityOf[step] : 1) * (segment.missed ? 0.55 : 1),
  };
}
