import { describe, expect, it } from "vitest";
import type { Job, Parameter } from "../../../master/web/src/app/types";
import {
  bodyOf,
  emptyForm,
  faultsOf,
  fileFault,
  formOf,
  framesOf,
  lastFrame,
  nothingDeclared,
  parameterFault,
  type Declared,
  type Form,
} from "../../../master/web/src/jobs/submission";

const parameter = (type: Parameter["type"], more: Partial<Parameter> = {}): Parameter => ({
  name: "p",
  type,
  default: "",
  help: "",
  choices: [],
  min: null,
  max: null,
  ...more,
});
const ready: Form = { ...emptyForm(), scene: "circus" };
const withNumbers = (numbers: Partial<Form["numbers"]>, more: Partial<Form> = {}): Form => ({
  ...ready,
  ...more,
  numbers: { ...ready.numbers, ...numbers },
});

describe("a parameter", () => {
  it("left empty is the scene's business", () =>
    expect(parameterFault(parameter("int", { min: 1 }), "")).toBeNull());
  it.each(["1.5", "x", "1e2", "0x10", "Infinity"])("that is a whole number is not %s", (text) =>
    expect(parameterFault(parameter("int"), text)).toBe(`p must be a whole number, is "${text}".`),
  );
  it.each(["-3", "0", "12"])("that is a whole number may be %s", (text) =>
    expect(parameterFault(parameter("int"), text)).toBeNull(),
  );
  it.each(["0.5", "1e-3", "-2"])("that is a number may be %s", (text) =>
    expect(parameterFault(parameter("number"), text)).toBeNull(),
  );
  it("keeps its limits", () => {
    const limited = parameter("number", { min: 0.1, max: 10 });
    expect([limited].map((one) => parameterFault(one, "0.05"))).toEqual(["p must be 0.1 or more, is 0.05."]);
    expect(parameterFault(limited, "11")).toBe("p must be 10 or less, is 11.");
    expect(parameterFault(limited, "10")).toBeNull();
  });
  it("of choices is one of them", () => {
    const choice = parameter("choice", { choices: ["glass", "mirror"] });
    expect(parameterFault(choice, "wood")).toBe('p must be glass or mirror, is "wood".');
    expect(parameterFault(choice, "glass")).toBeNull();
  });
});

describe("the form", () => {
  const faults = (form: Form, declared: Declared = nothingDeclared) => faultsOf(form, declared);
  it("can be sent as soon as there is a scene", () => {
    expect(Object.keys(faults(emptyForm()))).toEqual(["source"]);
    expect(Object.keys(faults({ ...emptyForm(), source: "script" }))).toEqual(["source"]);
    expect(faults(ready)).toEqual({});
  });
  it("keeps the master's limits", () => {
    expect(faults(withNumbers({ width: "0" })).width).toBe("Width must be 1 or more, is 0.");
    expect(faults(withNumbers({ width: "60001" })).width).toContain("60\u202f000 or less");
    expect(faults(withNumbers({ spp: "1.5" })).spp).toContain("a whole number");
    expect(faults(withNumbers({ min_importance: "2" })).min_importance).toContain("1 or less");
    expect(faults(withNumbers({ priority: "100" })).priority).toContain("99 or less");
  });
  it("counts megapixels, also with the scene's own width", () => {
    const declared: Declared = { ...nothingDeclared, image: { width: 50_000, height: null, spp: null } };
    expect(faults(withNumbers({ width: "25000", height: "20000" }))).toEqual({});
    expect(faults(withNumbers({ height: "10001" }), declared).height).toContain("500 megapixels");
  });
  it.each(["jitter", "regular", "adapt1"])("wants a square number of samples for %s", (sampler) => {
    expect(faults(withNumbers({ spp: "15" }, { sampler })).spp).toContain("9 or 16");
    expect(faults(withNumbers({ spp: "16" }, { sampler }))).toEqual({});
    expect(faults(withNumbers({ spp: "" }, { sampler }))).toEqual({});
    expect(faults(withNumbers({ spp: "15" }, { sampler: "sobol" }))).toEqual({});
  });
  it("refuses a pasted script that is too long", () =>
    expect(
      faults({ ...ready, source: "script", script: { name: "", text: "x".repeat(1024 * 1024 + 1) } }).source,
    ).toContain("1 MB"));
});

describe("what is sent", () => {
  it("is no more than what was filled in", () => {
    expect(bodyOf(ready, nothingDeclared)).toEqual({
      scene_name: "circus",
      parameters: {},
      settings: { shadows: true, reflections: true, refractions: true },
    });
  });
  it("has parameters as texts, those that the scene declares", () => {
    const declared: Declared = {
      ...nothingDeclared,
      parameters: [parameter("int", { name: "depth" }), parameter("int", { name: "n" })],
    };
    const body = bodyOf({ ...ready, parameters: { depth: "6", n: "", other: "1" } }, declared);
    expect(body.parameters).toEqual({ depth: "6" });
  });
  it("has a script with its name", () => {
    const body = bodyOf(
      { ...ready, source: "script", script: { name: "my.lua", text: "camera{}" } },
      nothingDeclared,
    );
    expect(body).toMatchObject({ script: "camera{}", script_name: "my.lua" });
    expect(body).not.toHaveProperty("scene_name");
  });
  it("has settings as numbers, and priority, name and hold beside them", () => {
    const body = bodyOf(
      withNumbers(
        { width: "320", min_importance: "0.1", priority: "7" },
        { name: " x ", hold: true, sampler: "jitter" },
      ),
      nothingDeclared,
    );
    expect(body).toMatchObject({
      name: "x",
      priority: 7,
      hold: true,
      settings: { width: 320, min_importance: 0.1, sampler: "jitter" },
    });
    expect(body.settings).not.toHaveProperty("priority");
  });
});

describe("a cloned job", () => {
  const settings = {
    width: 320,
    height: 200,
    spp: 9,
    sampler: "jitter",
    seed: 5,
    frame: 2,
    max_depth: 3,
    min_importance: 0.25,
    shadows: true,
    reflections: false,
    refractions: true,
  };
  const job = {
    id: 7,
    name: "flake",
    state: "done",
    priority: 60,
    parameters: { depth: "6" },
    settings,
    frames: { first: 0, last: 0, step: 1, total: 1, sent: 1, done: 0, current: 0 },
  } as unknown as Job;
  it("has the same settings and scene until they are changed", () => {
    const form = formOf(job);
    expect(faultsOf(form, nothingDeclared)).toEqual({});
    expect(bodyOf(form, nothingDeclared)).toEqual({ scene_of: 7, name: "flake", priority: 60, settings });
  });
  it("that ended badly is made of the master's scene of its name, with its parameters", () => {
    const declared: Declared = { ...nothingDeclared, parameters: [parameter("int", { name: "depth" })] };
    const body = bodyOf(formOf({ ...job, state: "cancelled" }), declared);
    expect(body).toMatchObject({ scene_name: "flake", parameters: { depth: "6" }, settings });
    expect(body).not.toHaveProperty("scene_of");
  });
});

describe("a file", () => {
  it("of 200 MB is refused by its size", () =>
    expect(fileFault({ name: "big.lua", size: 200 * 1024 * 1024 })).toBe(
      "big.lua has 200 MB; a script has 1 MB at most.",
    ));
  it("of 1 MB is taken", () => expect(fileFault({ name: "my.LUA", size: 1024 * 1024 })).toBeNull());
  it("that is no script is refused", () =>
    expect(fileFault({ name: "cat.png", size: 9 })).toBe("cat.png is no .lua file."));
});

describe("the frames of an animation", () => {
  const animated: Declared = { ...nothingDeclared, animation: { start: 1, stop: 3, fps: 10 } };
  const faultOf = (frames: string, declared = animated) => faultsOf({ ...ready, frames }, declared).frames;
  it.each(["", "0-20", " 3 - 9 : 2 ", "20-20"])("may be written as '%s'", (text) =>
    expect(faultOf(text)).toBeUndefined(),
  );
  it.each(["x", "1", "1-", "-1", "1-2:", "1.5-2", "0-99999999999"])("are not '%s'", (text) =>
    expect(faultOf(text)).toContain("written as 0-99"),
  );
  it("are those that the scene has", () => {
    expect(lastFrame(animated.animation!)).toBe(20);
    expect(lastFrame({ start: 0, stop: 0.29, fps: 100 })).toBe(29); // though 0.29 * 100 is less
    expect(faultOf("0-21")).toBe("The animation's last frame is 20.");
    expect(faultOf("4-3")).toBe("The first frame comes after the last.");
    expect(faultOf("0-4:0")).toBe("The step must be 1 or more.");
    expect(faultOf("0-4", nothingDeclared)).toContain("no animation");
  });
  it("are sent as numbers", () => {
    expect(framesOf("3-9:2")).toEqual({ first: 3, last: 9, step: 2 });
    expect(bodyOf({ ...ready, frames: "0-20" }, animated).frames).toEqual({ first: 0, last: 20, step: 1 });
    expect(bodyOf(ready, animated)).not.toHaveProperty("frames");
  });
});
