// A new job: from the form to the finished picture.
import { closeSync, ftruncateSync, openSync, writeFileSync } from "node:fs";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm } from "../support/farm";
import { details, fillForm, isNow, submit, submitButton } from "../support/jobs";
import { allShown, canvas, numbersIn, seen, type Seen } from "../support/picture";

const script = `local size = param{ "size", type = "number", default = 1, min = 0.5, max = 2 }
return scene{
  camera = perspective{ from = {0, 0, -5}, direction = {0, 0, 1}, angle = 50 },
  lights = { ambient(1) },
  root = sphere{}:scale(size),
}
`;

let farm: Farm;
let app: App;
let page: Page;

beforeAll(async () => {
  farm = await Farm.start();
  farm.addWorker("lab1");
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
beforeEach(async () => {
  app = await openApp(farm.url);
  page = app.page;
  await page.getByRole("img", { name: "connected" }).waitFor();
});
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

/// How many different colours the middle of the picture shows.
function colorsIn(image: Seen): number {
  const found = new Set<string>();
  for (let y = image.height * 0.3; y < image.height * 0.7; ++y)
    for (let x = image.width * 0.3; x < image.width * 0.7; ++x) found.add(image.at(x, y).join());
  return found.size;
}

describe("a job of the master's scenes", () => {
  it("is rendered with the parameters of the form", async () => {
    await fillForm(page, { name: "small flake", depth: 2 });
    await submit(page, "small flake");
    await isNow(page, "done");
    expect(await details(page).innerText()).toMatch(
      /small flake[\s\S]*80 × 60[\s\S]*4 per pixel, sobol[\s\S]*depth\n2/,
    );
    expect(page.url()).toMatch(/#\/jobs\/\d+$/);
  });

  it("has the form of its scene in sight as soon as that is chosen", async () => {
    await page.keyboard.press("Shift+N");
    const scene = page.getByRole("radio", { name: /^sphere_flake/ });
    await scene.check();
    const inSight = async (name: string): Promise<boolean> => {
      const box = (await page.getByLabel(name, { exact: true }).boundingBox())!;
      return box.y >= 0 && box.y + box.height < (await submitButton(page).boundingBox())!.y;
    };
    expect(await inSight("depth")).toBe(true);
    expect(await inSight("Width")).toBe(true);
    await page.getByLabel("Hold").scrollIntoViewIfNeeded();
    expect(await scene.isVisible()).toBe(true);
    await page.locator(".scenes label").last().scrollIntoViewIfNeeded();
    expect(await inSight("Name")).toBe(true); // each scrolls by itself
  });

  it("is seen before it is finished, can be paused, and becomes the exact picture", async () => {
    await fillForm(page, { name: "watched flake", depth: 5, width: 160, height: 120, spp: 512 });
    await submit(page, "watched flake");
    await page.locator('section.picture[data-layer-state="making"] .picture-stage[data-ready="true"]').waitFor();
    await page.getByRole("button", { name: "Pause" }).click();
    await isNow(page, "paused");
    expect(await page.locator("section.picture").getAttribute("data-layer-state")).toBe("making");
    expect(colorsIn(await seen(canvas(page)))).toBeGreaterThan(20);
    const pixels = details(page).locator("dt:text-is('Pixels') + dd");
    expect(await pixels.innerText()).not.toContain("100 %");
    await screenshot(page, "picture-coarse");
    await page.getByRole("button", { name: "Resume" }).click();
    await isNow(page, "done");
    await allShown(page);
    expect(await pixels.innerText()).toContain("100 %");
    expect(colorsIn(await seen(canvas(page)))).toBeGreaterThan(100);
    await screenshot(page, "picture-done");
  });

  it("is not sent while a parameter or a setting is wrong, and the form says why", async () => {
    await fillForm(page, { name: "deep flake", depth: 9 });
    await page.getByText("depth must be 8 or less, is 9.").first().waitFor();
    expect(await submitButton(page).isDisabled()).toBe(true);
    await page.getByLabel("depth", { exact: true }).fill("2");
    await page.getByLabel("Sampler").selectOption("adapt1");
    await page.getByLabel("Samples per pixel").fill("15");
    await page.getByText("adapt1 wants a square number of samples, as 9 or 16.").first().waitFor();
    expect(await submitButton(page).isDisabled()).toBe(true);
  });
});

describe("a job of one's own script", () => {
  beforeEach(async () => {
    await page.keyboard.press("Shift+N");
    await page.getByText("A script of mine").click();
  });

  it("is uploaded, asks for its parameters, and is rendered with them", async () => {
    writeFileSync(farm.file("ball.lua"), script);
    await page.locator("input[type=file]").setInputFiles(farm.file("ball.lua"));
    await page.getByText("The script can be rendered.").waitFor();
    await page.getByLabel("size", { exact: true }).fill("1.5");
    await page.getByLabel("Width", { exact: true }).fill("40");
    await page.getByLabel("Height", { exact: true }).fill("30");
    await submit(page, "ball");
    await isNow(page, "done");
    expect(await details(page).innerText()).toMatch(/ball[\s\S]*size\n1\.5/);
  });

  it("is told what is wrong with a broken one, and where", async () => {
    await page.getByLabel("Script", { exact: true }).fill("local a = 1\nscene{");
    await page.getByText(/^pasted\.lua:2:/).waitFor();
    expect(await submitButton(page).isDisabled()).toBe(true);
    // The browser reports the master's refusal as well.
    expect(app.complaints.splice(0).every((text) => text.includes("422"))).toBe(true);
  });

  it("is not made of a file of 200 MB, which is not even read", async () => {
    const big = openSync(farm.file("big.lua"), "w");
    ftruncateSync(big, 200 * 1024 * 1024);
    closeSync(big);
    await page.locator("input[type=file]").setInputFiles(farm.file("big.lua"));
    await page.getByText("big.lua has 200 MB; a script has 1 MB at most.").waitFor();
    expect(await submitButton(page).isDisabled()).toBe(true);
  });
});

describe("a cloned job", () => {
  it("has another's very scene and settings, but for what is changed", async () => {
    await fillForm(page, { name: "original", depth: 3 });
    await submit(page, "original");
    await isNow(page, "done");
    const hash = await details(page).locator("code").getAttribute("title");
    await page.getByRole("button", { name: "Clone" }).click();
    await page.getByLabel("Samples per pixel").fill("9");
    await page.getByLabel("Name", { exact: true }).fill("copy");
    await submit(page, "copy");
    await isNow(page, "done");
    expect(await details(page).innerText()).toMatch(/80 × 60[\s\S]*9 per pixel, sobol[\s\S]*depth\n3/);
    expect(await details(page).locator("code").getAttribute("title")).toBe(hash);
  });
});

describe("the farm's jobs", () => {
  it("appear by themselves, also when they are submitted by the command", async () => {
    const id = await farm.render("sphere_plane", "--size", "80x60", "--spp", "4", "--name", "by command");
    const row = page.locator(`#job-${id}`);
    await row.getByText("by command").click();
    await isNow(page, "done");
    await allShown(page);
    const size = details(page).locator("dt:text-is('Size') + dd");
    expect(numbersIn(await size.innerText())).toEqual([80, 60]);
  });
});
