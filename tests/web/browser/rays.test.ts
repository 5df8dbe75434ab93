// The rays of a pixel: the same as `rayfarm trace` tells, as a tree, in 3D and as spans.
import { createHash } from "node:crypto";
import { join } from "node:path";
import type { Page, Request } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { closeBrowser, openApp, screenshot, type App } from "../support/app";
import { Farm, sceneFolder } from "../support/farm";
import {
  decoded,
  downloaded,
  expectColor,
  nextFrame,
  placeOf,
  seen,
  showLayer,
  type Color,
  type Pixel,
} from "../support/picture";

const size = { width: 80, height: 60 };
const settings = ["--size", "80x60", "--spp", "4"];
const ball: Pixel = { x: 40, y: 30 };

interface Ray {
  kind: string;
  hit: { name: string } | null;
  lights: { fate: string }[];
  rays: Ray[];
  not_traced: unknown[];
}
interface Span {
  in: number;
  out: number | null;
}
interface Trace {
  samples: { ray: Ray; csg: { leaves: { stretches: Span[] }[]; material: Span[] } }[];
}

let farm: Farm;
let app: App;
let page: Page;
let job: number;

beforeAll(async () => {
  farm = await Farm.start();
  job = await farm.render("sphere_plane", ...settings);
});
afterAll(async () => {
  await closeBrowser();
  await farm.stop();
});
beforeEach(async () => {
  app = await openApp(farm.url);
  page = app.page;
  await showLayer(page, job);
  await page.keyboard.press("v");
  await rays().and(page.locator('[data-ready="true"]')).waitFor(); // the picture has its new size
  await nextFrame(page);
});
afterEach(async () => {
  expect(app.complaints).toEqual([]);
  await app.close();
});

const rays = () => page.locator('section[data-scope="rays"]');
const settled = (pixel: Pixel) =>
  page.locator(`section[data-scope="rays"][data-ready="true"][data-pixel="${pixel.x},${pixel.y}"]`).waitFor();

async function probe(pixel: Pixel): Promise<void> {
  const place = await placeOf(page, pixel, size);
  await page.mouse.click(place.x, place.y);
  await settled(pixel);
}

async function told(pixel: Pixel, sample = "0"): Promise<Trace> {
  const scene = join(sceneFolder, "sphere_plane.lua");
  const where = ["--pixel", `${pixel.x},${pixel.y}`, "--sample", sample];
  return JSON.parse(await farm.rayfarm("trace", scene, ...settings, ...where, "--json")) as Trace;
}
const raysIn = (ray: Ray): Ray[] => [ray, ...ray.rays.flatMap(raysIn)];
const allRays = (trace: Trace): Ray[] => trace.samples.flatMap((sample) => raysIn(sample.ray));
const saveAs = (format: string) =>
  page.getByRole("region", { name: "Rays", exact: true }).getByRole("button", { name: format, exact: true }).click();

/// How many pixels of the 3D view are about so.
async function painted(color: Color): Promise<number> {
  let found = 0;
  for (const each of (await seen(page.locator(".rays-view canvas"))).colors())
    if (each.every((value, c) => Math.abs(value - color[c]!) < 24)) ++found;
  return found;
}
const red: Color = [0xff, 0x2d, 0x2d];
const violet: Color = [0xb4, 0x67, 0xff];
const yellow: Color = [0xff, 0xd2, 0x3f];

describe("the rays of a clicked pixel", () => {
  it("are those that `rayfarm trace` tells, number for number", async () => {
    await probe(ball);
    const trace = await told(ball);
    const saved = await downloaded(page, () => saveAs("JSON"));
    expect(JSON.parse(saved.bytes.toString())).toEqual(trace);
  });

  it("are all in the tree, each with its record", async () => {
    await probe(ball);
    const all = allRays(await told(ball));
    expect(await rays().getAttribute("data-rays")).toBe(String(all.length));
    const lines = all.reduce((sum, ray) => sum + 1 + ray.lights.length + ray.not_traced.length, 0);
    const tree = page.getByRole("tree", { name: "Rays" });
    expect(await tree.getByRole("treeitem").count()).toBe(lines);
    const record = page.getByRole("region", { name: "Record of the ray" });
    const reflected = all.find((ray) => ray.kind === "reflected")!;
    await tree.getByRole("treeitem").filter({ hasText: `reflected ray → ${reflected.hit!.name}` }).hover();
    await expect.poll(() => record.innerText()).toMatch(/Reflected ray → plane #1[\s\S]*Depth\s+1/);
  });

  it("are those of all samples when all are asked for", async () => {
    await probe(ball);
    await page.getByRole("combobox", { name: /^Sample/ }).selectOption("all");
    const trace = await told(ball, "all");
    await expect.poll(() => rays().getAttribute("data-rays")).toBe(String(allRays(trace).length));
    expect(await page.getByRole("tree", { name: "Rays" }).getByRole("treeitem").count()).toBe(trace.samples.length);
  });
});

describe("the 3D view", () => {
  it("draws camera rays red and shadow rays yellow, and hides what is toggled off", async () => {
    const floor: Pixel = { x: 60, y: 50 };
    expect((await told(floor)).samples[0]!.ray.lights.some((light) => light.fate === "reached")).toBe(true);
    await page.getByRole("button", { name: "Icons", exact: true }).click(); // the lights' are yellow too
    await probe(floor);
    const [camera, shadow] = [await painted(red), await painted(yellow)];
    expect(camera).toBeGreaterThan(50);
    expect(shadow).toBeGreaterThan(50);
    await page.getByRole("button", { name: "Shadow", exact: true }).click();
    await expect.poll(() => painted(yellow)).toBeLessThan(shadow / 4);
    expect(await painted(red)).toBeGreaterThan(camera / 2);
  });

  it("looks along the primary ray when aligned, also of the next pixel", async () => {
    await probe(ball);
    const across = await painted(red);
    await page.getByRole("button", { name: "Keep aligned" }).click();
    await expect.poll(() => painted(red)).toBeLessThan(across / 4);
    await settled(ball);
    await screenshot(page, "rays-aligned");
    await probe({ x: 62, y: 50 });
    await expect.poll(() => painted(red)).toBeLessThan(across / 4);
  });

  it("marks what set operations take away, and says so", async () => {
    const optics = await farm.render("optics", ...settings);
    await showLayer(page, optics);
    await page.getByRole("button", { name: "Solids", exact: true }).click();
    await rays().getByText("what is taken away transparent").waitFor();
    await rays().and(page.locator('[data-ready="true"]')).waitFor();
    await nextFrame(page);
    await screenshot(page, "rays-subtracted");
    await page.getByRole("button", { name: "Solids", exact: true }).click();
  });

  it("names the ray that is pointed at", async () => {
    await probe(ball);
    const box = (await page.locator(".rays-view canvas").boundingBox())!;
    const tip = page.locator(".rays-tip");
    for (let share = 0; share < 1 && (await tip.count()) === 0; share += 0.01)
      await page.mouse.move(box.x + box.width * share, box.y + box.height / 2);
    expect(await tip.innerText()).toMatch(/^(camera|reflected) ray → |^light /);
    const record = page.getByRole("region", { name: "Record of the ray" });
    await expect.poll(() => record.getAttribute("data-record")).toBe(await tip.innerText());
  });

  it("shows the point cloud when it is asked for, in the surfaces' colours as a screen has them", async () => {
    await page.getByRole("button", { name: "Cloud" }).click();
    const view = page.locator(".rays-view");
    await expect.poll(async () => Number(await view.getAttribute("data-cloud"))).toBeGreaterThan(1000);
    const gold: Color = [255, 203, 89]; // 1, 0.6, 0.1 as sRGB
    await expect.poll(() => painted(gold)).toBeGreaterThan(500);
    await screenshot(page, "rays-cloud");
  });

  it("moves and turns by keys, and R goes back; the picture stays as it is", async () => {
    await probe(ball);
    await page.locator(".rays").focus();
    const look = async (): Promise<string> => {
      await settled(ball);
      await nextFrame(page);
      return createHash("sha1").update(await page.locator(".rays-view canvas").screenshot()).digest("hex");
    };
    await page.keyboard.press("r"); // a view that keys move has a frame
    const [whole, address] = [await look(), page.url()];
    for (const key of ["w", "d", "q", "+", "ArrowLeft", "ArrowUp"]) {
      await page.keyboard.press(key);
      expect(await look(), key).not.toBe(whole);
      await page.keyboard.press("r");
      await expect.poll(look, { message: key }).toBe(whole);
    }
    expect(page.url()).toBe(address);
  });

  it("is saved as it is seen", async () => {
    await probe(ball);
    const { bytes } = await downloaded(page, () => saveAs("PNG"));
    const [saved, shown] = [await decoded(page, bytes), await seen(page.locator(".rays-view canvas"))];
    expect([saved.width, saved.height]).toEqual([shown.width, shown.height]);
    for (let x = 0; x < shown.width; x += 7) expectColor(saved.at(x, shown.height / 3), shown.at(x, shown.height / 3));
  });

  it("marks the samples that stand out, unless that is toggled off", async () => {
    const many = await farm.render("sphere_plane", "--size", "80x60", "--spp", "16");
    await showLayer(page, many);
    const edge: Pixel = { x: 9, y: 20 }; // of the ball, which one sample just meets
    await probe(edge);
    expect(await painted(violet)).toBe(0);
    await page.getByRole("combobox", { name: /^Sample/ }).selectOption("all");
    await expect.poll(() => page.locator('.rays-tree [data-outlier="true"]').count()).toBe(1);
    await settled(edge);
    await expect.poll(() => painted(violet)).toBeGreaterThan(30);
    await screenshot(page, "rays-outliers");
    const saved = async () => (await downloaded(page, () => saveAs("SVG"))).bytes.toString();
    expect(await saved()).toContain("#b467ff");
    await page.getByRole("button", { name: "Outliers", exact: true }).click();
    await expect.poll(() => painted(violet)).toBe(0);
    expect(await saved()).not.toContain("#b467ff");
  });
});

describe("the span chart", () => {
  it("has a bar for each stretch inside a solid, and marks its ends in 3D", async () => {
    await probe(ball);
    const { csg } = (await told(ball)).samples[0]!;
    const stretches = csg.leaves.reduce((sum, leaf) => sum + leaf.stretches.length, csg.material.length);
    const bars = page.locator(".rays-spans g.span");
    expect(await bars.count()).toBe(stretches);
    await screenshot(page, "rays");
    const before = await painted([0x2f, 0xb8, 0xff]);
    await bars.first().focus();
    await expect.poll(() => painted([0x2f, 0xb8, 0xff])).toBeGreaterThan(before + 20);
  });

  it("is along the ray that is chosen, and is named after it", async () => {
    await probe(ball);
    const heading = page.locator(".rays-spans h3");
    expect(await heading.innerText()).toBe("Solids along the primary ray of sample 0");
    await page.getByRole("treeitem").filter({ hasText: "reflected ray → plane #1" }).click();
    await expect.poll(() => heading.innerText()).toBe("Solids along the reflected ray → plane #1 of sample 0");
    const query = `x=${ball.x}&y=${ball.y}&sample=0`;
    const [primary, reflected] = await Promise.all(
      ["", "&story=1"].map(async (story) => {
        const response = await fetch(`${farm.url}/api/v1/jobs/${job}/trace?${query}${story}`);
        return ((await response.json()) as Trace).samples[0]!.csg;
      }),
    );
    expect(reflected).not.toEqual(primary);
    const all = [...reflected!.leaves.flatMap((leaf) => leaf.stretches), ...reflected!.material];
    expect(await page.locator(".rays-spans g.span").count()).toBe(all.length);
    const view = async () => (await page.locator(".rays-view canvas").screenshot()).toString("base64");
    const before = await view();
    await page.locator(".rays-spans g.span").first().focus(); // its end is marked on the ray
    await expect.poll(async () => (await view()) !== before).toBe(true);
    await screenshot(page, "rays-reflected");
  });
});

describe("a probed pixel", () => {
  it("is carried to a result of the same size, and dropped at one that has no such pixel", async () => {
    const small = await farm.render("sphere_plane", "--size", "40x30", "--spp", "4");
    await probe(ball);
    await showLayer(page, small);
    await page.getByText("Click a pixel of the picture: its rays are shown here.").waitFor();
    expect(await rays().getByRole("alert").count()).toBe(0);
    expect(await rays().getAttribute("data-rays")).toBe("0");
    await showLayer(page, job);
    await settled(ball);
  });
});

describe("dragging over the picture", () => {
  it("asks for one pixel at a time and ends at the last", async () => {
    await probe(ball);
    let [underWay, most, asked] = [0, 0, 0];
    const isTrace = (request: Request): boolean => request.url().includes("/trace?");
    page.on("request", (request) => {
      if (!isTrace(request)) return;
      ++asked;
      most = Math.max(most, ++underWay);
    });
    const end = (request: Request): void => void (isTrace(request) && --underWay);
    page.on("requestfinished", end);
    page.on("requestfailed", end);
    await page.keyboard.down("Control");
    await page.mouse.down();
    const last: Pixel = { x: 70, y: 55 };
    const to = await placeOf(page, last, size);
    await page.mouse.move(to.x, to.y, { steps: 60 });
    await page.mouse.up();
    await page.keyboard.up("Control");
    await settled(last);
    expect(asked).toBeGreaterThan(0);
    expect(most).toBe(1);
  });
});

describe("an outline of the rays", () => {
  it("is saved as SVG with as many lines as are shown, at least", async () => {
    await probe(ball);
    const shown = Number(await rays().getAttribute("data-segments"));
    const svg = (await downloaded(page, () => saveAs("SVG"))).bytes.toString();
    expect(svg).toMatch(/^<(\?xml|svg)/);
    expect(svg.match(/<(line|path|polyline)/g)!.length).toBeGreaterThanOrEqual(shown);
  });
});
