// Several results of one scene: stepping through them, and comparing two.
import { readFileSync } from "node:fs";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { readExr } from "../support/exr";
import { Farm } from "../support/farm";
import {
  allShown,
  colorsAt,
  hover,
  numbersIn,
  pixelPointedAt,
  rounded,
  showLayer,
  zoomOf,
  type Color,
  type Pixel,
} from "../support/picture";

const size = { width: 80, height: 60 };

let farm: Farm;
let app: App;
let page: Page;
let [plain, other, shadowless] = [0, 0, 0]; // jobs, oldest first
let differing: Pixel; // where plain and shadowless are farthest apart
let difference: number[]; // there, by channel

beforeAll(async () => {
  farm = await Farm.start();
  const settings = ["--size", "80x60", "--spp", "4"];
  plain = await farm.render("sphere_plane", ...settings);
  other = await farm.render("sphere_plane", ...settings, "--seed", "7");
  shadowless = await farm.render("sphere_plane", ...settings, "--no-shadows");
  const [a, b] = [await exrOf(plain), await exrOf(shadowless)];
  let most = -1;
  for (let y = 0; y < size.height; ++y)
    for (let x = 0; x < size.width; ++x) {
      const apart = a.at(x, y).map((value, c) => Math.abs(value - b.at(x, y)[c]!));
      const sum = apart.reduce((all, each) => all + each, 0);
      if (sum > most) [most, differing, difference] = [sum, { x, y }, apart.reverse()];
    }
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
beforeEach(async () => {
  app = await openApp(farm.url);
  page = app.page;
  await showLayer(page, shadowless);
});
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

async function exrOf(job: number) {
  await farm.rayfarm("fetch", String(job), "-o", `${job}.exr`);
  return readExr(readFileSync(farm.file(`${job}.exr`)));
}
const isShown = (job: number) => page.locator(`#job-${job}[aria-selected=true]`).waitFor();
const colorThere = async (): Promise<Color> => (await colorsAt(page, [differing], size))[0]!;

/// The colours of the two results at the pixel where they differ most.
async function bothColors(): Promise<{ current: Color; reference: Color }> {
  await showLayer(page, plain);
  const reference = await colorThere();
  await showLayer(page, shadowless);
  return { current: await colorThere(), reference };
}

describe("the history of a scene", () => {
  it("is stepped through with << and >> and with A and D, and zoom and place stay", async () => {
    await hover(page, differing, size);
    for (let notch = 0; notch < 4; ++notch) await page.mouse.wheel(0, -100);
    const zoom = await zoomOf(page);
    const place = page.locator(".history-place");
    expect(await place.innerText()).toBe("1/3");
    const steps: [() => Promise<void>, number, string][] = [
      [() => page.keyboard.press("a"), other, "2/3"],
      [() => page.keyboard.press("a"), plain, "3/3"],
      [() => page.keyboard.press("a"), plain, "3/3"], // there is no older one
      [() => page.keyboard.press("d"), other, "2/3"],
    ];
    for (const [step, job, at] of steps) {
      await step();
      await isShown(job);
      await allShown(page);
      expect(await place.innerText()).toBe(at);
      expect(await zoomOf(page)).toBe(zoom);
      expect(await pixelPointedAt(page)).toEqual(differing);
    }
    await page.getByRole("button", { name: "Next result" }).click();
    await isShown(shadowless);
    await page.getByRole("button", { name: "Previous result" }).click();
    await isShown(other);
    expect(await zoomOf(page)).toBe(zoom);
    await page.keyboard.press("3");
    await isShown(plain);
  });

  it("says what is other about each result, and is as long as one wishes", async () => {
    const result = page.locator(`.results [data-job="${other}"]`);
    await expect.poll(() => result.innerText()).toMatch(/seed\s*7/);
    const cut = page.locator(".results .changes > span").evaluateAll((all) =>
      all.filter((each) => each.getBoundingClientRect().right > each.closest("button")!.getBoundingClientRect().right),
    );
    expect(await cut).toEqual([]);
    const length = page.getByLabel("last");
    await length.fill("5");
    await length.press("Enter");
    await page.reload();
    await allShown(page);
    expect(await length.inputValue()).toBe("5");
    expect(await page.locator(".results li").count()).toBe(3);
  });

  it("shows each result with its own values", async () => {
    const exr = await exrOf(plain);
    await page.keyboard.press("3");
    await isShown(plain);
    await allShown(page);
    const values = numbersIn(await hover(page, differing, size));
    expect(values).toEqual(exr.at(differing.x, differing.y).reverse().map((value) => rounded(value, 6)));
  });
});

describe("two results", () => {
  it("are compared in figures as `rayfarm compare` tells them", async () => {
    await exrOf(plain);
    await exrOf(shadowless);
    await page.getByRole("button", { name: `Compare with job ${plain}` }).click();
    const figures = { RMSE: "rmse", MAE: "mae", max: "max", ꟻLIP: "flip" };
    for (const [title, metric] of Object.entries(figures)) {
      const told = await farm.rayfarm("compare", `${shadowless}.exr`, `${plain}.exr`, "--metric", metric, "--json");
      const { value } = JSON.parse(told) as { value: number };
      expect(value).toBeGreaterThan(0);
      const cell = page.locator(`[data-comparison] [data-figure="${title}"] td`);
      await expect.poll(async () => numbersIn(await cell.innerText())).toEqual([rounded(value, 5)]);
    }
    await screenshot(page, "comparison");
  });

  it("are flipped with Space, or while Shift is held", async () => {
    const { current, reference } = await bothColors();
    await page.keyboard.press("Shift+3");
    await page.keyboard.press("Space");
    await expect.poll(colorThere).toEqual(reference);
    await screenshot(page, "comparison-flip");
    await page.keyboard.press("Space");
    const flips: [() => Promise<void>, Color][] = [
      [() => page.keyboard.press("Space"), reference],
      [() => page.keyboard.press("Space"), current],
      [() => page.keyboard.down("Shift"), reference],
      [() => page.keyboard.up("Shift"), current],
    ];
    for (const [flip, wanted] of flips) {
      await flip();
      await allShown(page);
      await expect.poll(colorThere).toEqual(wanted);
    }
  });

  it("are seen on both sides of a line that is dragged", async () => {
    const { current, reference } = await bothColors();
    await page.keyboard.press("Shift+3");
    await page.keyboard.press("w");
    const slider = page.getByLabel("Wipe at");
    await slider.fill("0.95");
    await expect.poll(colorThere).toEqual(current);
    await slider.fill("0.05");
    await expect.poll(colorThere).toEqual(reference);
    await slider.fill("0.5");
    await screenshot(page, "comparison-wipe");
  });

  it("have a difference, which is the picture then, with both values told", async () => {
    await page.keyboard.press("Shift+3");
    await page.keyboard.press("x");
    await allShown(page);
    const wanted = difference.map((each) => 255 * Math.min(1, each) ** (1 / 2.2));
    await expect.poll(async () => {
      const color = await colorThere();
      return color.every((value, c) => Math.abs(value - wanted[c]!) <= 1);
    }).toBe(true);
    await hover(page, differing, size);
    const reference = await page.locator("#picture-readout").getByText(/^reference/).innerText();
    const exr = await exrOf(plain);
    expect(numbersIn(reference)).toEqual(
      exr.at(differing.x, differing.y).reverse().map((value) => rounded(value, 6)),
    );
    const values = page.locator(".section").filter({ has: page.getByRole("heading", { name: "Values" }) });
    const current = await exrOf(shadowless);
    const farthest = [0, 0, 0]; // by channel
    for (let y = 0; y < size.height; ++y)
      for (let x = 0; x < size.width; ++x)
        [current, exr].map((each) => each.at(x, y)).reduce((a, b) => a.map((value, c) => Math.abs(value - b[c]!)))
          .forEach((apart, c) => (farthest[c] = Math.max(farthest[c]!, apart)));
    const told = async () => numbersIn((await values.locator('[data-figure="max"] td').allInnerTexts()).join(" "));
    await expect.poll(told).toEqual(farthest.reverse().map((value) => rounded(value, 4)));
    expect(await values.locator(".aside").innerText()).toContain("|a − b|");
    await screenshot(page, "comparison-difference");
    await page.keyboard.press("Shift+X");
    await page.getByText("Choose a reference in the history").waitFor();
  });

  it("are compared in their maps too", async () => {
    await page.keyboard.press("Shift+3");
    await page.locator('[data-layer="all-rays"]').click();
    await allShown(page);
    // Shadow rays are what the one did not shoot.
    const cell = page.locator('[data-comparison] [data-figure="max"] td');
    await expect.poll(async () => numbersIn(await cell.innerText())[0]).toBeGreaterThanOrEqual(4);
    await page.keyboard.press("x");
    await page.locator('[data-layer="depth"]').click();
    await allShown(page);
    await expect.poll(async () => numbersIn(await cell.innerText())).toEqual([0]); // the same surfaces
  });
});
