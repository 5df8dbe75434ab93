// An animation: from the form to its frames, one after the other.
import type { Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm } from "../support/farm";
import { details, isNow, submit } from "../support/jobs";
import { allShown, canvas, seen } from "../support/picture";

// The ball is red, and higher with each frame.
const script = `return scene{
  camera = perspective{ from = {0, 0, -5}, direction = {0, 0, 1}, angle = 50 },
  root = sphere{}:scale(0.5):translate(0, 0.5 * time, 0):color{1, 0, 0},
  image = { width = 80, height = 60, spp = 1 },
  animation = { stop = 2, fps = 2 },
}
`;

let farm: Farm;
let app: App;
let page: Page;

beforeAll(async () => {
  farm = await Farm.start();
  farm.addWorker("lab1");
  app = await openApp(farm.url);
  page = app.page;
  await page.getByRole("img", { name: "connected" }).waitFor();
});
afterAll(async () => {
  await app.close();
  await closeBrowser();
  await farm.stop();
});

/// How far up the ball is: the share of the height above its highest red point.
async function top(): Promise<number> {
  await allShown(page);
  const image = await seen(canvas(page));
  for (let y = 0; y < image.height; ++y) {
    const [r, g] = image.at(image.width / 2, y);
    if (r > 150 && g < 80) return y / image.height;
  }
  return 1;
}
const frame = (number: number) => page.getByRole("group", { name: "Frames" }).getByText(`Frame ${number}`, { exact: false });

describe("an animation", () => {
  it("is submitted as frames of one job, which are stepped through", async () => {
    await page.keyboard.press("Shift+N");
    await page.getByRole("radio", { name: "A script of mine" }).check();
    await page.getByLabel("Script", { exact: true }).fill(script);
    await page.getByLabel("Name", { exact: true }).fill("ball");
    await page.getByLabel("Frames", { exact: true }).fill("0-9");
    await page.getByText("The animation's last frame is 4.").first().waitFor();
    await page.getByLabel("Frames", { exact: true }).fill("0-4:2");
    await submit(page, "ball");
    await isNow(page, "done");
    expect(await details(page).innerText()).toMatch(/Frames\s+3 of 3/);

    await frame(4).waitFor();
    const last = await top();
    await page.keyboard.press(",");
    await frame(2).waitFor();
    const middle = await top();
    await page.getByRole("slider", { name: "Frame" }).fill("0");
    await frame(0).waitFor();
    const first = await top();
    expect(last).toBeLessThan(middle);
    expect(middle).toBeLessThan(first);
    await page.waitForURL(/frame=0/);
    await page.keyboard.press(".");
    await frame(2).waitFor();
    expect(await top()).toBe(middle);
    await screenshot(page, "frames");
    expect(app.complaints).toEqual([]);
  });
});
