// Maps of a job beside its picture: values, colours, ranges and files, against those of the command.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm, sceneFolder } from "../support/farm";
import {
  colorsAt,
  decoded,
  downloaded,
  expectColor,
  hover,
  numbersIn,
  rounded,
  showLayer,
  type Pixel,
} from "../support/picture";

const size = { width: 80, height: 60 };
const settings = ["--size", "80x60", "--spp", "4"];
const some: Pixel[] = [
  { x: 0, y: 0 }, // sky
  { x: 79, y: 59 }, // floor
  { x: 36, y: 27 }, // ball
  { x: 17, y: 44 }, // shadow
  { x: 31, y: 20 }, // edge of the ball
];

let farm: Farm;
let app: App;
let page: Page;
let job: number;

beforeAll(async () => {
  farm = await Farm.start();
  farm.addWorker("lab1");
  job = await farm.render("sphere_plane", ...settings);
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
beforeEach(async () => {
  app = await openApp(farm.url);
  page = app.page;
});
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

const saveAs = (format: string) =>
  page.getByRole("group", { name: "Save" }).getByRole("button", { name: format, exact: true }).click();

/// The rows of a table, without its comment.
function rowsOf(table: Buffer): number[][] {
  const lines = table.toString().trimEnd().split("\n");
  const cells = lines.filter((line) => !line.startsWith("#")).map((line) => line.split(";"));
  return cells.map((row) => row.map((cell) => (cell === "inf" ? Infinity : Number(cell))));
}

/// As the command makes it of the scene, on its own.
async function table(map: string, ...options: string[]): Promise<{ file: Buffer; rows: number[][] }> {
  const name = `${map}${options.join("")}.csv`;
  const scene = join(sceneFolder, "sphere_plane.lua");
  await farm.rayfarm("map", map, scene, ...settings, ...options, "-o", name);
  const file = readFileSync(farm.file(name));
  return { file, rows: rowsOf(file) };
}

/// What only a job has: the app's table, which is that of the command.
async function savedTable(map: string): Promise<number[][]> {
  const { bytes } = await downloaded(page, () => saveAs("CSV"));
  await farm.rayfarm("map", map, "--job", String(job), "-o", `${map}.csv`);
  expect(bytes.toString()).toBe(readFileSync(farm.file(`${map}.csv`)).toString());
  return rowsOf(bytes);
}

/// What the readout says of a value, as a number.
interface Kind {
  channels: number;
  of: (value: number) => number;
}
const fourDecimals = (value: number): number => Number(value.toFixed(4));
const kinds: Record<string, Kind> = {
  depth: { channels: 1, of: fourDecimals },
  normal: { channels: 3, of: fourDecimals },
  "normal-camera": { channels: 3, of: fourDecimals },
  coverage: { channels: 1, of: fourDecimals },
  "primary-rays": { channels: 1, of: (value) => value },
  "all-rays": { channels: 1, of: (value) => value },
  samples: { channels: 1, of: (value) => value },
};

describe.each(Object.entries(kinds))("the %s map", (map, { channels, of }) => {
  it("has the values of the command's table, and saves that table", async () => {
    await showLayer(page, job, map);
    const { file, rows } = await table(map);
    for (const pixel of some) {
      const text = await hover(page, pixel, size);
      const wanted = rows[pixel.y]!.slice(pixel.x * channels, (pixel.x + 1) * channels);
      if (wanted.every(Number.isFinite)) expect(numbersIn(text).slice(0, channels)).toEqual(wanted.map(of));
      else expect(text).toBe("nothing");
    }
    await screenshot(page, `map-${map}`);
    const saved = await downloaded(page, () => saveAs("CSV"));
    expect(saved.name).toBe(`sphere_plane-${job}-${map}.csv`);
    expect(saved.bytes.toString()).toBe(file.toString());
  });
});

describe("the cost map", () => {
  it("tells times in units that people read, as many as the table has seconds", async () => {
    await showLayer(page, job, "cost");
    const rows = await savedTable("cost");
    const units: Record<string, number> = { "µs": 1e-6, ms: 1e-3, s: 1 };
    for (const { x, y } of some) {
      const [, number, unit] = /^([\d.]+) (µs|ms|s)$/.exec(await hover(page, { x, y }, size))!;
      expect(Number(number) * units[unit!]!).toBeCloseTo(rounded(rows[y]![x]!, 3), 12);
    }
    const highest = page.getByLabel("Highest value µs");
    expect(Number(await highest.inputValue())).toBeCloseTo(Math.max(...rows.flat()) * 1e6, 2);
    expect(await highest.evaluate((field) => field.scrollWidth <= field.clientWidth)).toBe(true);
    await screenshot(page, "map-cost");
  });
});

describe("the worker map", () => {
  it("names who rendered each pixel, and everybody's share", async () => {
    await showLayer(page, job, "worker");
    const rows = await savedTable("worker");
    const items = page.locator(".labels li");
    const names = await items.locator(".name").allInnerTexts();
    const workers = await farm.rayfarm("workers");
    expect(names.filter((name) => !workers.includes(`${name} `))).toEqual([]);
    for (const pixel of some) expect(await hover(page, pixel, size)).toBe(names[rows[pixel.y]![pixel.x]!]);
    const all = rows.flat();
    for (const [value, name] of names.entries()) {
      const share = (all.filter((label) => label === value).length / all.length) * 100;
      await items.filter({ hasText: name }).getByText(`${share.toFixed(1)} %`).waitFor();
    }
    await screenshot(page, "map-worker");
  });
});

describe("a map's colours", () => {
  const ends = (): Promise<number[]> =>
    page
      .locator(".legend")
      .getAttribute("aria-label")
      .then((label) => numbersIn(label!));

  it("go from the lowest to the highest value, as the legend says and the saved PNG shows", async () => {
    await showLayer(page, job, "depth");
    const depths = (await table("depth")).rows.flat().filter(Number.isFinite);
    const [low, high] = await ends();
    expect(low).toBe(rounded(Math.min(...depths), 4));
    expect(rounded(high!, 3)).toBe(rounded(Math.max(...depths), 3)); // as large numbers are written
    const png = await decoded(page, (await downloaded(page, () => saveAs("PNG"))).bytes);
    const shown = await colorsAt(page, some, size);
    some.forEach(({ x, y }, i) => expectColor(shown[i]!, png.at(x, y), 2));
  });

  it("keep a range that is fixed, on the screen and in the PNG", async () => {
    await showLayer(page, job, "all-rays");
    await page.getByLabel("Lowest value").fill("2");
    await page.getByLabel("Highest value").fill("50");
    await page.getByLabel("Highest value").press("Enter");
    await expect.poll(ends).toEqual([2, 50]);
    await expect.poll(() => page.getByLabel("Range", { exact: true }).inputValue()).toBe("fixed");
    const png = await decoded(page, (await downloaded(page, () => saveAs("PNG"))).bytes);
    const shown = await colorsAt(page, some, size);
    some.forEach(({ x, y }, i) => expectColor(shown[i]!, png.at(x, y), 2));
  });
});

describe("a map with choices", () => {
  it("is made as they say: the reduction, and the original's formula", async () => {
    const edge = some[4]!;
    await showLayer(page, job, "depth");
    await page.getByLabel("Reduction").selectOption("mean");
    const mean = (await table("depth", "--reduce", "mean")).rows[edge.y]![edge.x]!;
    await expect.poll(async () => numbersIn(await hover(page, edge, size))).toEqual([fourDecimals(mean)]);
    await showLayer(page, job, "all-rays");
    await page.getByLabel("original").check();
    const rays = (await table("all-rays", "--compat")).rows[edge.y]![edge.x]!;
    await expect.poll(async () => numbersIn(await hover(page, edge, size))).toEqual([rays]);
  });
});

describe("the figures beside a map", () => {
  it("are those of its table", async () => {
    await showLayer(page, job, "all-rays");
    const rays = (await table("all-rays")).rows.flat();
    const sum = rays.reduce((a, b) => a + b, 0);
    const wanted = { min: Math.min(...rays), max: Math.max(...rays), mean: rounded(sum / rays.length, 4), sum };
    for (const [figure, value] of Object.entries(wanted)) {
      const cell = page.locator(`[data-figure="${figure}"] td`);
      await expect.poll(async () => numbersIn(await cell.innerText())).toEqual([value]);
    }
  });
});

describe("a job that was cancelled", () => {
  it("has no maps, and the view says why", async () => {
    const held = await farm.submit("sphere_plane", ...settings, "--hold");
    await farm.rayfarm("cancel", String(held));
    await page.evaluate((hash) => (location.hash = hash), `#/jobs/${held}?layer=depth`);
    await page.locator(".picture-message").getByText(`job ${held} was cancelled`).waitFor();
    await screenshot(page, "map-cancelled");
  });
});
