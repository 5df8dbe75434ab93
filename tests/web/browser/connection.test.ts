// The master goes and comes back while the app is open.
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm } from "../support/farm";
import { fillForm, isNow, listed, submit, submitButton } from "../support/jobs";
import { allShown, canvas, placeOf, seen, showLayer, type Pixel } from "../support/picture";

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
});
afterEach(() => app.close());

const banner = () => page.getByText("The connection to the master is lost");
const connected = () => page.getByRole("img", { name: "connected" });

describe("a master that is killed", () => {
  it("is missed in words, and found again by itself with what the new one has", async () => {
    const job = await farm.render("sphere_plane", "--size", "80x60", "--spp", "4");
    await showLayer(page, job);
    await farm.stopMaster("SIGKILL");
    await banner().waitFor();
    await page.getByRole("button", { name: "Clone" }).click();
    await submitButton(page).click();
    await page.getByText("The master does not answer; is it running?").first().waitFor();
    await page.keyboard.press("Escape");
    await screenshot(page, "connection-lost");

    await farm.startMaster();
    await banner().waitFor({ state: "detached" });
    await connected().waitFor();
    await expect.poll(() => listed(page).count()).toBe(0); // this master keeps nothing
    await fillForm(page, { name: "after the restart" });
    await submit(page, "after the restart");
    await isNow(page, "done");
    await allShown(page);
    const colors = new Set([...(await seen(canvas(page))).colors()].map(String));
    expect(colors.size).toBeGreaterThan(50);

    const byCommand = await farm.render("sphere_plane", "--size", "80x60", "--spp", "4", "--name", "by command");
    await page.locator(`#job-${byCommand}`).getByText("by command").waitFor();
    await page.keyboard.press("Shift+W");
    await page.getByRole("row", { name: /^lab1/ }).waitFor(); // the worker has found it too
  });

  it("leaves no rays beside another pixel's name, and takes those of its jobs along", async () => {
    const job = await farm.render("sphere_plane", "--size", "80x60", "--spp", "4");
    await showLayer(page, job);
    await page.keyboard.press("v");
    const rays = page.locator('section[data-scope="rays"]');
    const click = async (pixel: Pixel): Promise<void> => {
      const place = await placeOf(page, pixel, { width: 80, height: 60 });
      await page.mouse.click(place.x, place.y);
    };
    await rays.and(page.locator('[data-ready="true"]')).waitFor(); // the picture has its new size
    await click({ x: 40, y: 30 });
    await rays.and(page.locator('[data-pixel="40,30"]')).waitFor();
    expect(await page.getByRole("treeitem").count()).toBeGreaterThan(1);
    const bars = page.locator(".rays-spans .span");
    expect(await bars.count()).toBeGreaterThan(0);

    await farm.stopMaster("SIGKILL");
    await banner().waitFor();
    await click({ x: 20, y: 50 });
    await rays.getByText("The master does not answer; is it running?").waitFor();
    expect(await page.locator(".rays-status").innerText()).toBe("Pixel 20, 50");
    expect(await page.getByRole("treeitem").count()).toBe(0);
    expect(await bars.count()).toBe(0);
    await page.getByText("No ray yet.").waitFor();

    await farm.startMaster();
    await banner().waitFor({ state: "detached" });
    await rays.getByText("No job is selected.").waitFor();
    expect(await rays.getAttribute("data-segments")).toBe("0");
    expect(await rays.getByRole("alert").count()).toBe(0);
  });

  it("while it is away nothing else breaks: pages, help and palette work", async () => {
    await connected().waitFor();
    await farm.stopMaster("SIGKILL");
    await banner().waitFor();
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Keys" }).waitFor();
    await page.keyboard.press("Escape");
    await page.keyboard.press("Control+k");
    await page.keyboard.type("go to the workers");
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { name: "Log" }).waitFor();
    await page.getByRole("button", { name: "Try now" }).click();
    expect(await banner().isVisible()).toBe(true);
    await farm.startMaster();
    await banner().waitFor({ state: "detached" });
  });
});
