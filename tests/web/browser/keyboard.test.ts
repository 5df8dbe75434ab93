// The app by keyboard alone, in every size and theme.
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm } from "../support/farm";
import { details, fillForm, isNow, listed } from "../support/jobs";
import { controls, outside, tabbed } from "../support/layout";
import { allShown, showLayer } from "../support/picture";

let farm: Farm;
let app: App;
let page: Page;
let job: number;

beforeAll(async () => {
  farm = await Farm.start();
  farm.addWorker("lab1");
  job = await farm.render("sphere_flake", "-p", "depth=3", "--size", "160x120", "--spp", "4");
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
async function open(view: { width?: number; height?: number; dark?: boolean } = {}): Promise<void> {
  app = await openApp(farm.url, view);
  page = app.page;
  await page.getByRole("img", { name: "connected" }).waitFor();
}
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

describe("Tab", () => {
  beforeEach(() => open());

  const pages: [string, () => Promise<void>][] = [
    ["the picture with its rays", async () => {
      await showLayer(page, job, "depth");
      await page.keyboard.press("v");
      await page.locator('section[data-scope="rays"][data-ready="true"]').waitFor();
    }],
    ["the form for a new job", async () => {
      await page.keyboard.press("Shift+N");
      await page.getByRole("radio", { name: /^sphere_flake/ }).waitFor();
    }],
    ["the workers", async () => {
      await page.keyboard.press("Shift+W");
      await page.getByRole("row", { name: /^lab1/ }).waitFor();
    }],
  ];
  it.each(pages)("reaches every control of %s, in the page's order, and each shows it", async (_, go) => {
    await go();
    const wanted = await controls(page);
    const { order, unmarked } = await tabbed(page);
    expect(order).toEqual(wanted);
    expect(unmarked).toEqual([]);
  });
});

describe("the keyboard alone", () => {
  beforeEach(() => open());

  it("steers the queue: jobs are chosen, raised, cancelled, removed, resumed", async () => {
    const list = page.locator("#job-list:focus");
    for (const name of ["held one", "held two"]) {
      await fillForm(page, { name, hold: true });
      await page.keyboard.press("Enter");
      await details(page).getByRole("heading", { name }).waitFor();
    }
    await page.keyboard.press("q");
    await list.waitFor();
    await page.keyboard.press("Home");
    await details(page).getByRole("heading", { name: "held one" }).waitFor();
    await page.keyboard.press("ArrowDown");
    await details(page).getByRole("heading", { name: "held two" }).waitFor();
    await page.keyboard.press("+"); // goes before the other
    await expect.poll(() => listed(page).first().innerText()).toContain("held two");
    await page.keyboard.press("Delete");
    await page.getByRole("button", { name: "Keep as it is" }).and(page.locator(":focus")).waitFor();
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await isNow(page, "cancelled");
    await list.waitFor(); // the dialog gave the focus back
    await page.keyboard.press("Shift+Delete");
    await page.getByRole("dialog", { name: "Remove job" }).waitFor();
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await page.getByText("keeps it no longer").waitFor();
    await list.waitFor();
    await page.keyboard.press("Home");
    await details(page).getByRole("heading", { name: "held one" }).waitFor();
    await page.keyboard.press("p");
    await isNow(page, "done");
  });

  it.each([
    ["[", "]"],
    ["ArrowLeft", "ArrowRight"],
  ])("goes through the maps with %s and %s", async (previous, next) => {
    await showLayer(page, job);
    await page.keyboard.press(next);
    await expect.poll(() => page.url()).toContain("layer=depth");
    await allShown(page);
    await page.keyboard.press(previous);
    await expect.poll(() => page.url()).not.toContain("layer=");
  });

  it("asks for help, which lists every key once at each place", async () => {
    await showLayer(page, job);
    await page.keyboard.press("v"); // the 3D view has keys of its own
    await page.keyboard.press("?");
    const dialog = page.getByRole("dialog", { name: "Keys" });
    const keys = await dialog.evaluate((shown) =>
      [...shown.querySelectorAll("section")].flatMap((section) => {
        const title = section.querySelector("h3")!.textContent;
        const place = title.includes(", ") ? title.split(", ")[1]! : "everywhere";
        return [...section.querySelectorAll(".keys")].map((each) => `${place}: ${each.textContent}`);
      }),
    );
    expect(keys.length).toBeGreaterThan(40);
    expect(keys.filter((key, index) => keys.indexOf(key) !== index)).toEqual([]);
    await page.keyboard.press("Escape");
    expect(await dialog.count()).toBe(0);
  });

  // On a busy machine the first letters came before the dialog, and each did something to the picture.
  it("writes into the palette from the very next letter", async () => {
    const focused = await page.evaluate(async () => {
      document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "k", ctrlKey: true, bubbles: true }));
      for (let turn = 0; turn < 10; ++turn) await null; // no frame is drawn meanwhile
      return document.activeElement!.getAttribute("role");
    });
    expect(focused).toBe("combobox");
  });

  it("closes the palette with one Escape, whatever is written there", async () => {
    await page.keyboard.press("Control+k");
    await page.keyboard.type("depth");
    await page.keyboard.press("Escape");
    expect(await page.getByRole("dialog").count()).toBe(0);
  });

  it("finds actions, layers and jobs by name in the palette, and the back button goes back", async () => {
    await showLayer(page, job);
    await page.keyboard.press("Control+k");
    await page.keyboard.type("depth");
    await screenshot(page, "palette");
    await page.keyboard.press("Enter");
    await expect.poll(() => page.url()).toContain("layer=depth");
    await page.keyboard.press("Control+k");
    await page.keyboard.type("go to the workers");
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { name: "Log" }).waitFor();
    await page.goBack();
    await expect.poll(() => page.url()).toContain("layer=depth");
  });
});

const windows = [1366, 2560].flatMap((width) => [false, true].map((dark) => ({ width, dark })));

describe.each(windows)("a window $width wide, dark: $dark", ({ width, dark }) => {
  const height = width === 1366 ? 768 : 1440;
  // Large screens are alike but for their room, of which one picture tells.
  const shoot = async (view: string): Promise<void> => {
    if (width === 1366) await screenshot(page, `${view}${dark ? "-dark" : "-light"}`);
    else if (view === "jobs") await screenshot(page, `large-screen${dark ? "-dark" : "-light"}`);
  };

  it("has room for every view, and each is in the theme's colours", async () => {
    await open({ width, height, dark });
    await showLayer(page, job);
    expect(await outside(page)).toEqual([]);
    await shoot("jobs");

    await page.keyboard.press("v");
    await page.keyboard.press("i");
    await page.keyboard.press("Enter");
    await page.locator('section[data-scope="rays"][data-ready="true"]:not([data-pixel=""])').waitFor();
    expect(await outside(page)).toEqual([]);
    await shoot("rays");

    await page.keyboard.press("Shift+W");
    await page.getByRole("row", { name: /^lab1/ }).waitFor();
    expect(await outside(page)).toEqual([]);
    await shoot("workers");

    await fillForm(page, { name: "not sent" });
    expect(await outside(page)).toEqual([]);
    await shoot("submit");

    await page.locator("h1").click(); // out of the text fields
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Keys" }).waitFor();
    expect(await outside(page)).toEqual([]);
    await shoot("help");

    const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const [red] = /\d+/.exec(ground)!;
    expect(Number(red) < 128).toBe(dark);
  });
});
