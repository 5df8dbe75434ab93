// A master that asks everybody who they are.
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm } from "../support/farm";

let farm: Farm;
let app: App;
let page: Page;

beforeAll(async () => {
  farm = await Farm.start({ closed: true });
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

const wanted = () => page.getByRole("heading", { name: "This farm wants a login" });
const connected = () => page.getByRole("img", { name: "connected" });
const field = () => page.getByLabel("Token");

interface Made {
  id: string;
  token: string;
  link?: string;
}
const made = async (...options: string[]): Promise<Made> =>
  JSON.parse(await farm.rayfarm("token", "new", ...options, "--json")) as Made;

describe("a browser that the master does not know", () => {
  it("is asked for a token, told of a wrong one, and let in with a good one until that is revoked", async () => {
    await wanted().waitFor();
    await screenshot(page, "login");
    await field().fill("hello");
    await page.keyboard.press("Enter");
    await page.getByRole("alert").getByText("this token is not good").waitFor();

    const { id, token } = await made("--role", "viewer");
    await field().fill(token);
    await page.keyboard.press("Enter");
    await wanted().waitFor({ state: "detached" });
    await connected().waitFor();
    expect(await page.evaluate(() => document.cookie)).toBe(""); // no script sees it
    await page.reload();
    await connected().waitFor();

    await farm.rayfarm("token", "revoke", id);
    await wanted().waitFor();
  });

  it("is somebody once it has opened a login link, until it logs out", async () => {
    await wanted().waitFor();
    const { link } = await made("--role", "artist", "--name", "Ann", "--link");
    for (let i = 0; i < 3; ++i) expect((await page.request.get(link!)).ok()).toBe(true); // as a chat program does
    await page.goto(link!);
    await connected().waitFor();
    expect(page.url()).not.toContain("login"); // nor in the history
    expect(await wanted().count()).toBe(0);

    const leave = page.getByRole("button", { name: "Log out" });
    expect(await leave.getAttribute("title")).toBe("You are Ann, artist");
    await leave.click();
    await wanted().waitFor();
    expect(await leave.count()).toBe(0);
    await page.goto(link!); // it was good once
    await page.getByRole("alert").getByText("this login link is not good").first().waitFor();
    await wanted().waitFor();
  });

  it("begins with a login link as well", async () => {
    const { link } = await made("--role", "viewer", "--link");
    const other = await openApp(link!);
    await other.page.getByRole("img", { name: "connected" }).waitFor();
    expect(other.complaints).toEqual([]);
    await other.close();
  });
});

describe("a browser that the master lets in anyway", () => {
  it("has nothing to log out of", async () => {
    const open = await Farm.start();
    const other = await openApp(open.url);
    await other.page.getByRole("img", { name: "connected" }).waitFor();
    expect(await other.page.getByRole("button", { name: "Log out" }).count()).toBe(0);
    await other.close();
    await open.stop();
  });
});
