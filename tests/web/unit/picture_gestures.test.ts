import { describe, expect, it } from "vitest";
import { wheelFactor } from "../../../master/web/src/picture/gestures";
import { viewAngle, type Camera } from "../../../master/web/src/picture/view_angle";

const wheel = (deltaY: number, shiftKey = false, deltaX = 0, deltaMode = 0) =>
  wheelFactor({ deltaX, deltaY, deltaMode, shiftKey });

describe("the wheel", () => {
  it("zooms by one step a notch, of whatever length browsers make it", () => {
    for (const notch of [53, 100, 120]) expect(wheel(-notch)).toBeCloseTo(1.1);
    expect(wheel(-3, false, 0, 1)).toBeCloseTo(1.1);
    expect(wheel(100)).toBeCloseTo(1 / 1.1);
  });

  it("zooms by three steps with Shift, which turns it sideways in some browsers", () => {
    expect(wheel(-100, true)).toBeCloseTo(1.331);
    expect(wheel(0, true, -100)).toBeCloseTo(1.331);
  });

  it("zooms as far in many small moves as in one large one", () => {
    expect(wheel(-10) ** 5).toBeCloseTo(wheel(-50));
  });
});

describe("the angle to the view", () => {
  const camera: Camera = {
    kind: "perspective",
    from: [0, 0, -5],
    direction: [0, 0, 1],
    up: [0, 1, 0],
    angle_deg: 90,
  };
  const film = { width: 3, height: 3 };
  const centre = { x: 1, y: 1 };

  it("is nothing for a surface that faces the camera, and a right angle for one seen from the side", () => {
    expect(viewAngle(camera, film, centre, [0, 0, -1], "world")).toBeCloseTo(0);
    expect(viewAngle(camera, film, centre, [1, 0, 0], "world")).toBeCloseTo(90);
    expect(viewAngle(camera, film, centre, [0, 0, 1], "world")).toBeCloseTo(180);
  });

  it("is seen from the pixel: to the right of the middle the ray goes to the right", () => {
    const slant = (Math.atan(2 / 3) * 180) / Math.PI;
    expect(viewAngle(camera, film, { x: 2, y: 1 }, [0, 0, -1], "world")).toBeCloseTo(slant);
    const back = [-2 / 3, 0, -1];
    expect(viewAngle(camera, film, { x: 2, y: 1 }, back, "world")).toBeCloseTo(0);
    expect(viewAngle(camera, film, { x: 1, y: 0 }, [0, -2 / 3, -1], "world")).toBeCloseTo(0);
  });

  it("is the same in the camera's axes as in the world's", () => {
    const turned: Camera = { ...camera, direction: [1, 0, 0] };
    // Looking along +x with y up, the right is -z.
    expect(viewAngle(turned, film, { x: 2, y: 0 }, [-0.6, 0, 0.8], "world")).toBeCloseTo(
      viewAngle(turned, film, { x: 2, y: 0 }, [-0.8, 0, -0.6], "camera")!,
    );
  });

  it("is none where there is nothing", () => {
    expect(viewAngle(camera, film, centre, [Infinity, Infinity, Infinity], "world")).toBeNull();
  });
});
