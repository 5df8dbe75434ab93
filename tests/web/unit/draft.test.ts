import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { page } from "../../../master/web/src/app/route";
import { selectedId } from "../../../master/web/src/app/state";
import type { Job } from "../../../master/web/src/app/types";
import {
  change,
  checked,
  declared,
  faults,
  followScript,
  form,
  prefill,
  refusal,
  scenes,
  submit,
  takeFile,
} from "../../../master/web/src/jobs/draft";
import { emptyForm } from "../../../master/web/src/jobs/submission";

interface Asked {
  path: string;
  body: Record<string, unknown>;
  answer: (status: number, body: unknown) => Promise<void>;
}
let asked: Asked[]; // of the master, oldest first
let stop: () => void;

const type = (text: string) => change({ source: "script", script: { name: "my.lua", text } });
const flush = () => vi.advanceTimersByTimeAsync(0);
const scriptWith = (name: string) => ({
  parameters: [{ name, type: "int", default: "1", help: "", choices: [], min: null, max: null }],
  image: { width: null, height: null, spp: null },
  animation: null,
});

beforeEach(() => {
  vi.useFakeTimers();
  asked = [];
  vi.stubGlobal("fetch", (path: string, init: RequestInit) => {
    return new Promise<Response>((resolve) => {
      const answer = (status: number, body: unknown) => {
        resolve(new Response(JSON.stringify(body), { status }));
        return flush().then(() => undefined);
      };
      asked.push({ path, body: JSON.parse(init.body as string) as Record<string, unknown>, answer });
    });
  });
  form.value = emptyForm();
  checked.value = null;
  stop = followScript();
});
afterEach(() => {
  stop();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

describe("a script that is typed", () => {
  it("is told to the master once, when typing pauses", () => {
    for (const text of ["s", "sc", "scene"]) {
      type(text);
      vi.advanceTimersByTime(499);
    }
    expect(asked).toEqual([]);
    vi.advanceTimersByTime(1);
    expect(asked.map(({ path, body }) => [path, body])).toEqual([
      ["/api/v1/scripts", { name: "my.lua", script: "scene" }],
    ]);
  });

  it("declares what the master found in it", async () => {
    type("scene");
    vi.advanceTimersByTime(500);
    await asked[0]!.answer(200, scriptWith("depth"));
    expect(declared.value.parameters.map(({ name }) => name)).toEqual(["depth"]);
  });

  it("is wrong in the master's words", async () => {
    type("scen");
    vi.advanceTimersByTime(500);
    await asked[0]!.answer(422, { error: "my.lua:1: no scene is returned" });
    expect(checked.value).toEqual({ text: "scen", fault: "my.lua:1: no scene is returned" });
    expect(declared.value.parameters).toEqual([]);
  });

  it("is not described by the answer to an older text", async () => {
    type("old");
    vi.advanceTimersByTime(500);
    type("new");
    vi.advanceTimersByTime(500);
    await asked[1]!.answer(200, scriptWith("new"));
    await asked[0]!.answer(200, scriptWith("old"));
    expect(declared.value.parameters.map(({ name }) => name)).toEqual(["new"]);
  });
});

describe("a file", () => {
  it("that is too large is refused without being read", async () => {
    const text = vi.fn();
    await takeFile({ name: "big.lua", size: 200 * 1024 * 1024, text } as unknown as File);
    expect(text).not.toHaveBeenCalled();
    expect(refusal.value).toContain("200 MB");
    expect(form.value.script.text).toBe("");
  });
});

describe("submitting", () => {
  it("shows the new job and begins a new form", async () => {
    change({ scene: "circus", name: "mine" });
    page.value = "submit";
    const sent = submit();
    await asked[0]!.answer(201, { id: 7, name: "mine" });
    await sent;
    expect(asked[0]).toMatchObject({ path: "/api/v1/jobs", body: { scene_name: "circus", name: "mine" } });
    expect([page.value, selectedId.value, form.value]).toEqual(["jobs", 7, emptyForm()]);
  });

  it("that the master refuses keeps the form, with the reason beside it", async () => {
    change({ scene: "circus", name: "mine" });
    page.value = "submit";
    const sent = submit();
    await asked[0]!.answer(422, { error: "there is no scene circus" });
    await sent;
    expect([page.value, refusal.value, form.value.name]).toEqual([
      "submit",
      "there is no scene circus",
      "mine",
    ]);
  });
});

describe("a scene", () => {
  it("that the master does not offer must be chosen anew", () => {
    change({ scene: "gone" });
    expect(faults.value).toEqual({});
    scenes.value = [];
    expect(faults.value.source).toBe("Choose a scene.");
    scenes.value = null;
  });
});

describe("a clone", () => {
  const still = { first: 0, last: 0, step: 1, total: 1, sent: 1, done: 0, current: 0 };
  const job = (id: number, name: string): Job =>
    ({ id, name, priority: 5, parameters: {}, frames: still, settings: { ...emptyForm().switches } }) as Job;

  it("is filled in once, so that changes are not lost", () => {
    prefill(job(9, "flake"));
    change({ name: "changed" });
    prefill(job(9, "flake"));
    expect(form.value.name).toBe("changed");
    prefill(job(10, "circus"));
    expect(form.value.name).toBe("circus");
  });

  it("leaves nothing behind in the next new job, where what was typed stays", () => {
    prefill(job(9, "flake"));
    prefill(null);
    expect(form.value).toEqual(emptyForm());
    change({ name: "typed" });
    prefill(null);
    expect(form.value.name).toBe("typed");
  });
});
