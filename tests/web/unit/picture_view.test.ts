import { describe, expect, it } from "vitest";
import * as view from "../../../master/web/src/picture/view";

const screen = { width: 801, height: 600 };
const picture = { width: 640, height: 480 };

/// Evenly over all zooms, places and points, the same each time.
function* samples(): Generator<{ v: view.View; s: view.Point }> {
  for (let i = 0; i < 500; ++i) {
    const part = (step: number): number => (i * step) % 1;
    const zoom = view.limitedZoom(view.smallestZoom * 2 ** (14 * part(0.618)));
    yield {
      v: { zoom, x: 640 * part(0.755), y: 480 * part(0.57) },
      s: { x: 801 * part(0.413), y: 600 * part(0.289) },
    };
  }
}

describe("a view", () => {
  it("takes a screen's point to the picture and back to itself", () => {
    for (const { v, s } of samples()) {
      const back = view.toScreen(v, screen, view.toPicture(v, screen, s));
      expect(back.x).toBeCloseTo(s.x, 6);
      expect(back.y).toBeCloseTo(s.y, 6);
    }
  });

  it("keeps what is under the pointer when it zooms, but for the rounding to whole screen pixels", () => {
    for (const { v, s } of samples()) {
      const p = view.toPicture(v, screen, s);
      const moved = view.toScreen(view.zoomedAt(v, screen, s, 1.331), screen, p);
      expect(Math.abs(moved.x - s.x)).toBeLessThanOrEqual(0.5 + 1e-6);
      expect(Math.abs(moved.y - s.y)).toBeLessThanOrEqual(0.5 + 1e-6);
    }
  });

  it("has its picture on whole screen pixels when enlarged", () => {
    for (const { v } of samples()) {
      const { x, y } = view.originOf(v, screen);
      if (v.zoom >= 1) expect([x % 1, y % 1].map(Math.abs)).toEqual([0, 0]);
    }
  });

  it("follows the hand", () => {
    const before = { zoom: 0.5, x: 100, y: 100 };
    const after = view.panned(before, { x: 30, y: -8 });
    const [a, b] = [before, after].map((v) => view.toScreen(v, screen, { x: 7, y: 9 }));
    expect(b!.x - a!.x).toBeCloseTo(30);
    expect(b!.y - a!.y).toBeCloseTo(-8);
  });

  it("never leaves less than 50 pixels of the picture on the screen", () => {
    for (const { v } of samples()) {
      const far = view.kept({ ...v, x: 1e6, y: -1e6 }, screen, picture);
      const corner = view.toScreen(far, screen, { x: picture.width, y: 0 });
      const visible = Math.min(50, picture.width * far.zoom);
      expect(corner.x).toBeGreaterThanOrEqual(visible - 0.51);
      const visibleTall = Math.min(50, picture.height * far.zoom);
      expect(corner.y).toBeLessThanOrEqual(screen.height - visibleTall + 0.51);
    }
  });

  it("is not moved by the limit while enough is visible", () => {
    const v = { zoom: 2, x: 300, y: 200 };
    expect(view.kept(v, screen, picture)).toEqual(v);
  });

  it("shows all of the picture when fitted, enlarged by whole numbers", () => {
    expect(view.fitted({ width: 1400, height: 1000 }, picture)).toEqual({ zoom: 2, x: 320, y: 240 });
    const small = view.fitted({ width: 320, height: 1000 }, picture);
    expect(small.zoom).toBe(0.5);
  });

  it("has the pixel that is to be seen on the screen, and does not move for one that is", () => {
    for (const { v } of samples()) {
      const moved = view.showing(v, screen, { x: 633, y: 2 });
      const centre = view.toScreen(moved, screen, { x: 633.5, y: 2.5 });
      expect(centre.x).toBeGreaterThanOrEqual(-1);
      expect(centre.x).toBeLessThanOrEqual(screen.width + 1);
      expect(view.showing(moved, screen, { x: 633, y: 2 })).toEqual(moved);
    }
  });

  it("shows the same place as large in another resolution", () => {
    const v = { zoom: 4, x: 100, y: 60 };
    const carried = view.carried(v, picture, { width: 320, height: 240 });
    expect(carried).toEqual({ zoom: 8, x: 50, y: 30 });
    expect(view.carried(carried, { width: 320, height: 240 }, picture)).toEqual(v);
  });

  it("is read from the page's address as it was written", () => {
    for (const { v } of samples()) {
      const read = view.viewIn(view.queryOf(v))!;
      expect(read.zoom / v.zoom).toBeCloseTo(1, 4);
      expect(read.x).toBeCloseTo(v.x, 1);
      expect(read.y).toBeCloseTo(v.y, 1);
    }
  });

  it("is not read from what is none", () => {
    for (const query of [
      {},
      { z: "2" },
      { z: "0", c: "1,2" },
      { z: "x", c: "1,2" },
      { z: "2", c: "1" },
      { z: "2", c: ",2" },
    ])
      expect(view.viewIn(query as Record<string, string>)).toBeNull();
  });
});

describe("a zoom", () => {
  it("stays between a 32nd and 512 times, and is 1 within one percent of it", () => {
    expect(view.limitedZoom(1e-9)).toBe(1 / 32);
    expect(view.limitedZoom(1e9)).toBe(512);
    expect(view.limitedZoom(1.0099)).toBe(1);
    expect(view.limitedZoom(0.9901)).toBe(1);
    expect(view.limitedZoom(1.02)).toBe(1.02);
  });

  it("is told in percent", () => {
    expect(view.zoomText(1)).toBe("100 %");
    expect(view.zoomText(1 / 32)).toBe("3.1 %");
    expect(view.zoomText(512)).toBe("51200 %");
  });
});

describe("the pixel at a point", () => {
  it("is the one whose square has it, and none outside", () => {
    expect(view.pixelAt({ x: 0, y: 0 }, picture)).toEqual({ x: 0, y: 0 });
    expect(view.pixelAt({ x: 639.99, y: 479.99 }, picture)).toEqual({ x: 639, y: 479 });
    expect(view.pixelAt({ x: 640, y: 0 }, picture)).toBeNull();
    expect(view.pixelAt({ x: -0.01, y: 0 }, picture)).toBeNull();
  });
});
