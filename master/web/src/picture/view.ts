// Where the picture is on the screen: zoom, pan, and the way between the two. Screen lengths are device pixels,
// so that at 100 % one pixel of the picture is one of the screen.

export interface Point {
  x: number;
  y: number;
}
export interface Size {
  width: number;
  height: number;
}
export interface View extends Point {
  zoom: number; // screen pixels a picture pixel; x, y: the picture's point in the middle of the screen
}

export const smallestZoom = 1 / 32;
export const largestZoom = 512;
const leastVisible = 50; // screen pixels of the picture that never leave the screen

/// The screen's point of the picture's upper left corner. On whole screen pixels when enlarged, or a pixel's edge
/// would fall on the middle of the screen's pixels, and which side is shown there would be chance.
export function originOf(view: View, screen: Size): Point {
  const x = screen.width / 2 - view.x * view.zoom;
  const y = screen.height / 2 - view.y * view.zoom;
  return view.zoom >= 1 ? { x: Math.round(x), y: Math.round(y) } : { x, y };
}

export function toScreen(view: View, screen: Size, p: Point): Point {
  const origin = originOf(view, screen);
  return { x: origin.x + p.x * view.zoom, y: origin.y + p.y * view.zoom };
}

export function toPicture(view: View, screen: Size, s: Point): Point {
  const origin = originOf(view, screen);
  return { x: (s.x - origin.x) / view.zoom, y: (s.y - origin.y) / view.zoom };
}

/// Within the limits; 1 when within one percent of it.
export function limitedZoom(zoom: number): number {
  if (Math.abs(zoom - 1) < 0.01) return 1;
  return Math.min(Math.max(zoom, smallestZoom), largestZoom);
}

/// What is under the screen's point `at` stays there.
export function zoomedAt(view: View, screen: Size, at: Point, factor: number): View {
  const zoom = limitedZoom(view.zoom * factor);
  const p = toPicture(view, screen, at);
  return {
    zoom,
    x: p.x - (at.x - screen.width / 2) / zoom,
    y: p.y - (at.y - screen.height / 2) / zoom,
  };
}

/// The picture follows the hand by so many screen pixels.
export function panned(view: View, by: Point): View {
  return { zoom: view.zoom, x: view.x - by.x / view.zoom, y: view.y - by.y / view.zoom };
}

/// Moved back as far as needed for 50 screen pixels of the picture, or all of a smaller one, to be on the screen.
export function kept(view: View, screen: Size, picture: Size): View {
  const axis = (centre: number, screenSide: number, pictureSide: number): number => {
    const visible = Math.min(leastVisible, pictureSide * view.zoom, screenSide);
    const reach = (screenSide / 2 - visible) / view.zoom;
    return Math.min(Math.max(centre, -reach), pictureSide + reach);
  };
  return {
    zoom: view.zoom,
    x: axis(view.x, screen.width, picture.width),
    y: axis(view.y, screen.height, picture.height),
  };
}

/// All of the picture, as large as it goes; enlarged by a whole number, so that its pixels are equally large.
export function fitted(screen: Size, picture: Size): View {
  const zoom = Math.min(screen.width / picture.width, screen.height / picture.height);
  return {
    zoom: limitedZoom(zoom > 1 ? Math.floor(zoom) : zoom),
    x: picture.width / 2,
    y: picture.height / 2,
  };
}

/// Moved as little as needed for the pixel to be on the screen.
export function showing(view: View, screen: Size, pixel: Point): View {
  const axis = (centre: number, side: number, at: number): number => {
    const reach = Math.max(0, side / 2 / view.zoom - 1);
    return Math.min(Math.max(centre, at + 0.5 - reach), at + 0.5 + reach);
  };
  return { zoom: view.zoom, x: axis(view.x, screen.width, pixel.x), y: axis(view.y, screen.height, pixel.y) };
}

/// The same place, as large on the screen, in a picture of another resolution.
export function carried(view: View, from: Size, to: Size): View {
  return {
    zoom: limitedZoom((view.zoom * from.width) / to.width),
    x: (view.x * to.width) / from.width,
    y: (view.y * to.height) / from.height,
  };
}

/// The pixel at a point of the picture; null outside.
export function pixelAt(p: Point, picture: Size): Point | null {
  const x = Math.floor(p.x);
  const y = Math.floor(p.y);
  return x >= 0 && y >= 0 && x < picture.width && y < picture.height ? { x, y } : null;
}

/// "640 %": whole percents from ten up.
export function zoomText(zoom: number): string {
  const percent = zoom * 100;
  return `${percent >= 10 ? Math.round(percent) : Number(percent.toPrecision(2))} %`;
}

/// For the address of the page.
export function queryOf(view: View): { z: string; c: string } {
  const decimal = (value: number): string => String(Number(value.toFixed(2)));
  return { z: String(Number(view.zoom.toPrecision(5))), c: `${decimal(view.x)},${decimal(view.y)}` };
}

export function viewIn(query: Readonly<Record<string, string>>): View | null {
  const zoom = Number(query.z ?? NaN);
  const [x, y] = (query.c ?? "").split(",").map((part) => (part === "" ? NaN : Number(part)));
  if (!(zoom > 0) || x === undefined || y === undefined || !Number.isFinite(x + y)) return null;
  return { zoom: limitedZoom(zoom), x, y };
}
