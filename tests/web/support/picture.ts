// Hands and eyes on the picture view.
import { readFileSync } from "node:fs";
import { expect } from "vitest";
import type { Locator, Page } from "playwright-core";

export interface Pixel {
  x: number;
  y: number;
}
export interface Size {
  width: number;
  height: number;
}
export type Color = [number, number, number];

export const canvas = (page: Page): Locator => page.locator("#picture-canvas");
export const readout = (page: Page): Locator => page.locator("#picture-readout .values");

export const zoomOf = async (page: Page): Promise<number> =>
  Number(await page.locator(".picture-stage").getAttribute("data-zoom"));

/// Opens a job, or a map of it, and waits until all of it is there and painted.
export async function showLayer(page: Page, job: number, layer = "picture"): Promise<void> {
  const path = layer === "picture" ? `#/jobs/${job}` : `#/jobs/${job}?layer=${layer}`;
  await page.evaluate((hash) => (location.hash = hash), path);
  await page.getByRole("tab", { selected: true }).and(page.locator(`[data-layer="${layer}"]`)).waitFor();
  await page.locator(`#job-${job}[aria-selected=true]`).waitFor();
  await allShown(page);
}

export async function allShown(page: Page): Promise<void> {
  await page.locator('section.picture[data-layer-state="done"] .picture-stage[data-ready="true"]').waitFor();
  await nextFrame(page);
}

/// What was asked to be painted is on the screen then.
export const nextFrame = (page: Page): Promise<void> =>
  page.evaluate(
    () => new Promise<void>((done) => requestAnimationFrame(() => requestAnimationFrame(() => done()))),
  );

/// The screen's place of the middle of a pixel, while all of the picture is shown.
export async function placeOf(page: Page, pixel: Pixel, size: Size): Promise<Pixel> {
  const [box, zoom] = [(await canvas(page).boundingBox())!, await zoomOf(page)];
  const origin = (side: number, length: number): number => Math.round(side / 2 - (length / 2) * zoom);
  return {
    x: box.x + origin(box.width, size.width) + (pixel.x + 0.5) * zoom,
    y: box.y + origin(box.height, size.height) + (pixel.y + 0.5) * zoom,
  };
}

/// Moves the pointer there; what the view then says of the pixel. It has to say the pixel's name too.
export async function hover(page: Page, pixel: Pixel, size: Size): Promise<string> {
  const place = await placeOf(page, pixel, size);
  await page.mouse.move(place.x, place.y);
  await page.locator(`#picture-readout [data-x="${pixel.x}"][data-y="${pixel.y}"]`).waitFor();
  return readout(page).innerText();
}

export async function pixelPointedAt(page: Page): Promise<Pixel> {
  const place = page.locator("#picture-readout .place");
  return { x: Number(await place.getAttribute("data-x")), y: Number(await place.getAttribute("data-y")) };
}

/// As the readout writes it: six digits, a true minus, the sign of infinity.
export function numberIn(text: string): number {
  return Number(text.replaceAll("−", "-").replace("∞", "Infinity"));
}
export const numbersIn = (text: string): number[] =>
  [...text.matchAll(/[−-]?(?:∞|[\d.]+(?:e[−+-]?\d+)?)/g)].map(([each]) => numberIn(each));

/// So many digits of it.
export const rounded = (value: number, digits: number): number => Number(value.toPrecision(digits));

/// What is seen, as colours.
export interface Seen extends Size {
  at(x: number, y: number): Color;
  colors(): Iterable<Color>;
}

export async function seen(target: Locator): Promise<Seen> {
  await nextFrame(target.page());
  return decoded(target.page(), await target.screenshot());
}

/// A PNG's colours, as the browser reads them.
export async function decoded(page: Page, png: Buffer): Promise<Seen> {
  const image = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d")!;
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let text = "";
    for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
    return { width: bitmap.width, height: bitmap.height, base64: btoa(text) };
  }, png.toString("base64"));
  const bytes = Buffer.from(image.base64, "base64");
  const at = (x: number, y: number): Color => {
    const i = 4 * (Math.floor(y) * image.width + Math.floor(x));
    return [bytes[i]!, bytes[i + 1]!, bytes[i + 2]!];
  };
  return {
    width: image.width,
    height: image.height,
    at,
    *colors() {
      for (let y = 0; y < image.height; ++y) for (let x = 0; x < image.width; ++x) yield at(x, y);
    },
  };
}

/// The colours on the screen of some pixels, while all of the picture is shown.
export async function colorsAt(page: Page, pixels: readonly Pixel[], size: Size): Promise<Color[]> {
  const [image, box] = [await seen(canvas(page)), (await canvas(page).boundingBox())!];
  const places = await Promise.all(pixels.map((pixel) => placeOf(page, pixel, size)));
  return places.map((place) => image.at(place.x - box.x, place.y - box.y));
}

/// Equal but for rounding.
export function expectColor(got: Color, wanted: readonly number[], apart = 1): void {
  const close = got.every((value, c) => Math.abs(value - wanted[c]!) <= apart);
  expect(close, `${got.join(" ")} is not ${wanted.join(" ")}`).toBe(true);
}

/// The file that the browser is given by what is done.
export async function downloaded(
  page: Page,
  act: () => Promise<void>,
): Promise<{ name: string; bytes: Buffer }> {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}
