// The workers page, and the command's view of the same workers.
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm } from "../support/farm";

let farm: Farm;
let app: App;
let page: Page;

beforeAll(async () => {
  farm = await Farm.start();
  farm.addWorker("lab1");
  farm.addWorker("lab2");
  await farm.render("sphere_flake", "--size", "80x60", "--spp", "4");
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
beforeEach(async () => {
  app = await openApp(`${farm.url}/#/workers`);
  page = app.page;
  await row("lab1").getByText(working).waitFor();
  await row("lab2").getByText(working).waitFor();
});
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

const working = /^(idle|busy)$/;
const row = (name: string) => page.getByRole("row", { name: new RegExp(`^${name}`) });
const log = () => page.getByRole("log", { name: "Lines" });

/// The state of a worker as the command tells it.
async function toldState(name: string): Promise<string> {
  const line = (await farm.rayfarm("workers")).split("\n").find((each) => each.startsWith(`${name} `))!;
  return /\b(idle|busy|drained|banned|dialling)\b/.exec(line)![1]!;
}

describe("a worker", () => {
  it("is drained and works again, and the command says so too", async () => {
    await page.getByRole("button", { name: "drain lab1", exact: true }).click();
    await row("lab1").getByText("drained").waitFor();
    expect(await toldState("lab1")).toBe("drained");
    expect(await toldState("lab2")).toMatch(working);
    await page.getByRole("button", { name: "undrain lab1" }).click();
    await row("lab1").getByText(working).waitFor();
    expect(await toldState("lab1")).toMatch(working);
  });

  it("that the command drains is shown as drained", async () => {
    await farm.rayfarm("drain", "lab2");
    await row("lab2").getByText("drained").waitFor();
    await farm.rayfarm("undrain", "lab2");
    await row("lab2").getByText(working).waitFor();
  });

  it("is banned after a question only, and let in again", async () => {
    await page.getByRole("button", { name: "Ban lab1" }).click();
    await page.getByRole("dialog", { name: "Ban lab1?" }).waitFor();
    await page.keyboard.press("Escape");
    expect(await toldState("lab1")).toMatch(working);
    await page.getByRole("button", { name: "Ban lab1" }).click();
    await page.getByRole("button", { name: "Ban the worker" }).click();
    await row("lab1").getByText("banned").waitFor();
    expect(await toldState("lab1")).toBe("banned");
    await log().getByText(/ban/).first().waitFor();
    await screenshot(page, "workers");
    await page.getByRole("button", { name: "Take back the ban of lab1" }).click();
    await row("lab1").getByText(working).waitFor();
  });

  it("shows name, address, threads and what it did", async () => {
    const text = (await row("lab1").innerText()).replaceAll(/\s+/g, " ");
    expect(text).toMatch(/^lab1 127\.0\.0\.1:\d+ (idle|busy) 1 /);
  });
});

describe("a worker to be dialled", () => {
  it("has an address, or the master says what is wrong with it", async () => {
    const address = page.getByLabel("Worker to dial");
    await address.fill("no address");
    await page.keyboard.press("Enter");
    await page.locator("#dial-fault").getByText("no address").waitFor();
    expect(app.complaints.splice(0).every((text) => text.includes("422"))).toBe(true);
    await address.fill("attic=127.0.0.1:9");
    await page.keyboard.press("Enter");
    await row("attic").getByText("dialling", { exact: true }).waitFor();
    expect(await page.locator("#dial-fault").count()).toBe(0);
    expect(await toldState("attic")).toBe("dialling");
    const why = row("attic").locator(".why");
    await why.waitFor();
    expect(await why.evaluate((each) => each.scrollWidth <= each.clientWidth)).toBe(true);
    expect(await row("attic").getByRole("button").allInnerTexts()).toEqual(["Stop dialling"]);
    await screenshot(page, "workers-dialling");
    await page.getByRole("button", { name: "Stop dialling attic" }).click();
    await row("attic").waitFor({ state: "detached" });
  });

  it("has a name of its own: that of a worker is refused, and the worker stays", async () => {
    await page.getByLabel("Worker to dial").fill("lab1=127.0.0.1:9");
    await page.keyboard.press("Enter");
    await page.locator("#dial-fault").getByText("lab1").waitFor();
    expect(app.complaints.splice(0).every((text) => text.includes("409"))).toBe(true);
    expect(await row("lab1").count()).toBe(1);
    expect(await toldState("lab1")).toMatch(working);
  });
});

describe("the chart", () => {
  it("is as wide as its frame, from the beginning", async () => {
    const width = (selector: string) => page.locator(selector).evaluate((each) => each.getBoundingClientRect().width);
    await page.evaluate(() => {
      new MutationObserver(() => {
        const chart = document.querySelector<HTMLElement>(".farm-chart .u-wrap");
        if (chart?.style.width) document.body.dataset.chartWidth ??= chart.style.width;
      }).observe(document.body, { subtree: true, childList: true, attributeFilter: ["style"] });
    });
    await page.getByRole("link", { name: "Jobs" }).click();
    await page.getByRole("link", { name: "Workers" }).click();
    await page.locator(".farm-chart .uplot").waitFor();
    const first = page.locator("body[data-chart-width]");
    expect(parseFloat((await first.getAttribute("data-chart-width"))!)).toBe(await width(".farm-chart"));
    expect(await width(".farm-chart .u-wrap")).toBe(await width(".farm-chart"));
  });
});

describe("the log", () => {
  it("stays at its end when the chart above it comes late", async () => {
    const atEnd = () =>
      log().evaluate((list) => list.scrollHeight - list.scrollTop - list.clientHeight < 8 && list.scrollTop > 0);
    await page.setViewportSize({ width: 1366, height: 500 });
    await expect.poll(atEnd).toBe(true);
  });

  it("tells what happened, of all workers or of one", async () => {
    await page.getByLabel("Lines of which worker").selectOption("lab2");
    const lines = log().getByRole("listitem");
    await expect.poll(() => lines.count()).toBeGreaterThan(0);
    const texts = await lines.allInnerTexts();
    expect(texts.every((text) => text.includes("lab2"))).toBe(true);
    await page.getByLabel("Lines of which worker").selectOption("");
    await expect.poll(() => lines.count()).toBeGreaterThan(texts.length);
  });
});
