// The picture view: what is under the pointer, how it is moved, and the files that it saves.
import { readFileSync } from "node:fs";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { readExr, type Floats } from "../support/exr";
import { Farm } from "../support/farm";
import {
  canvas,
  colorsAt,
  decoded,
  downloaded,
  expectColor,
  hover,
  nextFrame,
  numbersIn,
  pixelPointedAt,
  placeOf,
  readout,
  rounded,
  seen,
  showLayer,
  zoomOf,
  type Pixel,
} from "../support/picture";

const size = { width: 80, height: 60 };
const some: Pixel[] = [
  { x: 0, y: 0 }, // sky
  { x: 79, y: 59 }, // floor
  { x: 36, y: 27 },
  { x: 41, y: 33 }, // ball
  { x: 17, y: 44 }, // shadow
];

let farm: Farm;
let app: App;
let page: Page;
let job: number;
let exr: Floats;

beforeAll(async () => {
  farm = await Farm.start();
  farm.addWorker("lab1");
  job = await farm.render("sphere_plane", "--size", "80x60", "--spp", "4");
  await farm.rayfarm("fetch", String(job), "-o", "wanted.exr");
  await farm.rayfarm("fetch", String(job), "-o", "wanted.png");
  exr = readExr(readFileSync(farm.file("wanted.exr")));
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
beforeEach(async () => {
  app = await openApp(farm.url);
  page = app.page;
  await showLayer(page, job);
});
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

const rgbOf = ({ x, y }: Pixel): number[] => exr.at(x, y).reverse();

describe("a pixel of the picture", () => {
  it("has the values of the EXR", async () => {
    for (const pixel of some) {
      const values = numbersIn(await hover(page, pixel, size));
      expect(values).toEqual(rgbOf(pixel).map((value) => rounded(value, 6)));
    }
  });

  it("has on the screen the colour that the PNG has", async () => {
    const png = await decoded(page, readFileSync(farm.file("wanted.png")));
    const shown = await colorsAt(page, some, size);
    some.forEach(({ x, y }, i) => expectColor(shown[i]!, png.at(x, y)));
  });

  it("is probed with the arrow keys and Enter", async () => {
    const from = await placeOf(page, { x: 40, y: 30 }, size);
    await page.mouse.click(from.x, from.y);
    await page.mouse.move(0, 0);
    await page.keyboard.press("i");
    for (const key of ["ArrowRight", "ArrowDown", "Shift+ArrowLeft", "Enter"]) await page.keyboard.press(key);
    const pixel = { x: 40 + 1 - 10, y: 30 + 1 };
    expect(await pixelPointedAt(page)).toEqual(pixel);
    expect(numbersIn(await readout(page).innerText())).toEqual(rgbOf(pixel).map((value) => rounded(value, 6)));
  });
});

describe("a dense screen", () => {
  it("has the same pixel under the pointer", async () => {
    await app.close();
    app = await openApp(farm.url, { density: 2 });
    page = app.page;
    await showLayer(page, job);
    const box = (await canvas(page).boundingBox())!;
    await page.mouse.click(box.x + box.width / 2 + 3, box.y + box.height / 2 + 3);
    await page.locator('#picture-readout [data-x="40"][data-y="30"]').waitFor();
  });
});

describe("zoom", () => {
  it("keeps the pixel under the pointer, and its level is shown", async () => {
    const pixel = some[3]!;
    await hover(page, pixel, size);
    const [box, before] = [(await canvas(page).boundingBox())!, await zoomOf(page)];
    const [at, [color]] = [await placeOf(page, pixel, size), await colorsAt(page, [pixel], size)];
    for (let notch = 0; notch < 5; ++notch) await page.mouse.wheel(0, -100);
    await expect.poll(() => zoomOf(page)).toBeCloseTo(before * 1.1 ** 5);
    expect(await pixelPointedAt(page)).toEqual(pixel);
    expect(await page.locator(".zoom-level").innerText()).toBe(`${Math.round(before * 110 ** 5 * 1e-8)} %`);
    expectColor((await seen(canvas(page))).at(at.x - box.x, at.y - box.y), color!, 0);
  });

  it("goes to 100 % and to all of the picture with keys, and the address keeps it", async () => {
    await page.keyboard.press("0");
    await expect.poll(() => zoomOf(page)).toBe(1);
    await page.keyboard.press("Shift+PageUp");
    await expect.poll(() => zoomOf(page)).toBeCloseTo(1.331);
    await expect.poll(() => page.url()).toMatch(/z=1\.331/);
    await page.reload();
    await expect.poll(() => zoomOf(page)).toBeCloseTo(1.331);
    await page.keyboard.press("r");
    await expect.poll(() => zoomOf(page)).toBeGreaterThan(3);
    await expect.poll(() => page.url()).not.toMatch(/z=/);
  });

  it("into large pixels prints their values into them", async () => {
    const pixel = some[2]!;
    await hover(page, pixel, size);
    for (let notch = 0; notch < 10; ++notch) {
      await page.keyboard.down("Shift");
      await page.mouse.wheel(0, -100);
      await page.keyboard.up("Shift");
    }
    await expect.poll(() => zoomOf(page)).toBeGreaterThan(80);
    const brightest = async (): Promise<number> => {
      let most = 0;
      for (const color of (await seen(canvas(page))).colors()) most = Math.max(most, ...color);
      return most;
    };
    expect(await brightest()).toBeGreaterThan(240); // letters
    await screenshot(page, "picture-values");
    await page.keyboard.press("p");
    expect(await brightest()).toBeLessThan(240);
    await page.keyboard.press("p");
  });
});

describe("a drag", () => {
  it("pans: the picture follows the hand", async () => {
    const pixel = some[2]!;
    await hover(page, pixel, size);
    const from = await placeOf(page, pixel, size);
    await page.mouse.down();
    await page.mouse.move(from.x + 37, from.y - 21, { steps: 3 });
    await page.mouse.up();
    expect(await pixelPointedAt(page)).toEqual(pixel);
    await page.mouse.move(from.x, from.y);
    await nextFrame(page);
    expect(await pixelPointedAt(page)).not.toEqual(pixel);
  });

  it("with Shift selects a rectangle, whose figures are shown and saved", async () => {
    const [from, to] = [await placeOf(page, { x: 10, y: 50 }, size), await placeOf(page, { x: 12, y: 51 }, size)];
    await page.keyboard.down("Shift");
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 3 });
    await page.mouse.up();
    await page.keyboard.up("Shift");
    await page.getByText("3 × 2 at 10, 50").waitFor();
    const rows = [50, 51].map((y) => [10, 11, 12].flatMap((x) => rgbOf({ x, y })));
    const reds = rows.flat().filter((_, i) => i % 3 === 0);
    const most = page.locator('[data-figure="max"] td').first();
    await expect.poll(async () => numbersIn(await most.innerText())).toEqual([rounded(Math.max(...reds), 4)]);
    const saved = await downloaded(page, () => page.getByRole("button", { name: "Save CSV" }).click());
    const lines = saved.bytes.toString().trimEnd().split("\n").slice(1);
    expect(lines.map((line) => line.split(";").map((cell) => Math.fround(Number(cell))))).toEqual(rows);
  });
});

describe("a saved picture", () => {
  it("is, as EXR and as PNG, the very file that the command fetches", async () => {
    for (const format of ["exr", "png"] as const) {
      const button = page.getByRole("group", { name: "Save" }).getByRole("button", { name: format.toUpperCase() });
      const saved = await downloaded(page, () => button.click());
      expect(saved.name).toBe(`sphere_plane-${job}.${format}`);
      expect(saved.bytes.equals(readFileSync(farm.file(`wanted.${format}`)))).toBe(true);
    }
  });
});

describe("exposure", () => {
  it("brightens the screen and leaves the values alone", async () => {
    const pixel = some[3]!;
    const [[before], value] = [await colorsAt(page, [pixel], size), await hover(page, pixel, size)];
    await page.keyboard.press("e");
    await page.keyboard.press("e"); // one stop
    const [after] = await colorsAt(page, [pixel], size);
    expectColor(after!, before!.map((channel) => Math.min(255, channel * 2 ** (1 / 2.2))), 2);
    expect(await readout(page).innerText()).toBe(value);
    await page.keyboard.press("Shift+R");
    expectColor((await colorsAt(page, [pixel], size))[0]!, before!, 0);
  });
});
