// What is drawn over the picture: values in large pixels, the probed pixel, the cursor, the selection, the wipe.
import type { Pixel } from "../app/state";
import { differenceOf } from "./difference";
import { plain } from "./format";
import type { Rect } from "./layer_data";
import type { Part } from "./painter";
import type { Point, Size } from "./view";

/// CSS pixels of a pixel from which on its values appear, and are opaque.
const valuesFrom = 50;
const valuesFull = 80;

export interface Marks {
  probed: Pixel | null;
  cursor: Pixel | null;
  selection: Rect | null; // in the picture's pixels
  wipe: { at: number; left: string; right: string } | null; // device pixels
  values: boolean;
}

export interface Frame {
  screen: Size;
  density: number;
  origin: Point;
  zoom: number;
  parts: readonly Part[];
}

export function drawOverlay(context: CanvasRenderingContext2D, frame: Frame, marks: Marks): void {
  context.clearRect(0, 0, frame.screen.width, frame.screen.height);
  if (marks.values) for (const part of frame.parts) drawValues(context, frame, part);
  const box = (pixel: Pixel, least: number): Rect => boxOf(frame, { ...pixel, width: 1, height: 1 }, least);
  if (marks.selection) outline(context, frame, boxOf(frame, marks.selection, 0), [4, 3]);
  if (marks.probed) cross(context, frame, box(marks.probed, 7));
  if (marks.cursor) outline(context, frame, box(marks.cursor, 9), [2, 2]);
  if (marks.wipe) drawWipe(context, frame, marks.wipe);
}

/// On the screen, at least so many CSS pixels wide.
function boxOf(frame: Frame, area: Rect, least: number): Rect {
  const side = (pixels: number): number => Math.max(pixels * frame.zoom, least * frame.density);
  const [width, height] = [side(area.width), side(area.height)];
  return {
    x: frame.origin.x + (area.x + area.width / 2) * frame.zoom - width / 2,
    y: frame.origin.y + (area.y + area.height / 2) * frame.zoom - height / 2,
    width,
    height,
  };
}

/// White on black, so that it shows on any picture.
function stroke(context: CanvasRenderingContext2D, frame: Frame, path: Path2D, dash: number[]): void {
  context.setLineDash([]);
  context.strokeStyle = "rgb(0 0 0 / 0.7)";
  context.lineWidth = 3 * frame.density;
  context.stroke(path);
  context.setLineDash(dash.map((length) => length * frame.density));
  context.strokeStyle = "#fff";
  context.lineWidth = frame.density;
  context.stroke(path);
  context.setLineDash([]);
}

function outline(context: CanvasRenderingContext2D, frame: Frame, box: Rect, dash: number[]): void {
  const path = new Path2D();
  path.rect(box.x, box.y, box.width, box.height);
  stroke(context, frame, path, dash);
}

function cross(context: CanvasRenderingContext2D, frame: Frame, box: Rect): void {
  const path = new Path2D();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const arm = 8 * frame.density;
  path.rect(box.x, box.y, box.width, box.height);
  for (const [dx, dy] of [
    [-1, 0],
    [1, 0],
    [0, -1],
    [0, 1],
  ] as const) {
    const [ex, ey] = [x + (dx * box.width) / 2, y + (dy * box.height) / 2];
    path.moveTo(ex, ey);
    path.lineTo(ex + dx * arm, ey + dy * arm);
  }
  stroke(context, frame, path, []);
}

function drawWipe(context: CanvasRenderingContext2D, frame: Frame, wipe: NonNullable<Marks["wipe"]>): void {
  const path = new Path2D();
  path.moveTo(wipe.at, 0);
  path.lineTo(wipe.at, frame.screen.height);
  stroke(context, frame, path, []);
  context.font = `${12 * frame.density}px system-ui, sans-serif`;
  context.textBaseline = "top";
  const apart = 8 * frame.density;
  context.textAlign = "right";
  legible(context, wipe.left, wipe.at - apart, apart, "#fff", frame.density);
  context.textAlign = "left";
  legible(context, wipe.right, wipe.at + apart, apart, "#fff", frame.density);
}

function legible(
  context: CanvasRenderingContext2D,
  text: string,
  x: number,
  y: number,
  color: string,
  density: number,
): void {
  context.lineJoin = "round";
  context.lineWidth = 2.5 * density;
  context.strokeStyle = "rgb(0 0 0 / 0.75)";
  context.strokeText(text, x, y);
  context.fillStyle = color;
  context.fillText(text, x, y);
}

const channelColors = ["#ffb3ad", "#b5f0bd", "#b5d2ff"];

function drawValues(context: CanvasRenderingContext2D, frame: Frame, part: Part): void {
  const side = part.texel / frame.density;
  const opacity = Math.min(1, (side - valuesFrom) / (valuesFull - valuesFrom));
  if (opacity <= 0) return;
  const { data } = part;
  const lines = data.channels;
  const size = Math.min(side / (lines === 1 ? 5 : 6.5), 15) * frame.density;
  context.globalAlpha = opacity;
  context.font = `${size}px "DejaVu Sans Mono", ui-monospace, monospace`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  const first = (origin: number, from: number): number =>
    Math.max(0, Math.floor((from - origin) / part.texel));
  const last = (origin: number, to: number, most: number): number =>
    Math.min(most - 1, Math.floor((to - origin) / part.texel));
  for (let y = first(part.origin.y, 0); y <= last(part.origin.y, frame.screen.height, data.height); ++y)
    for (let x = first(part.origin.x, part.left); x <= last(part.origin.x, part.right - 1, data.width); ++x) {
      const middle = { x: part.origin.x + (x + 0.5) * part.texel, y: part.origin.y + (y + 0.5) * part.texel };
      if (middle.x < part.left || middle.x >= part.right) continue;
      valuesAt(part, x, y)?.forEach((value, c) => {
        const at = middle.y + (c - (lines - 1) / 2) * size * 1.25;
        legible(
          context,
          plain(value, 4),
          middle.x,
          at,
          lines === 3 ? channelColors[c]! : "#fff",
          frame.density,
        );
      });
    }
  context.globalAlpha = 1;
}

/// As shown: of a difference, the difference.
function valuesAt(part: Part, x: number, y: number): number[] | null {
  const a = part.data.at(x, y);
  if (!a || part.metric === "none") return a && [...a];
  const metric = part.metric;
  const b = part.other?.at(x, y);
  return b ? [...a].map((value, c) => differenceOf(value, b[c]!, metric)) : null;
}
