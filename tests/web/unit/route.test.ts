import { afterEach, describe, expect, it, vi } from "vitest";
import {
  hashOf,
  isStep,
  layerIn,
  parse,
  queryOf,
  startRouting,
  type Route,
} from "../../../master/web/src/app/route";
import { selectedId } from "../../../master/web/src/app/state";

describe("an address", () => {
  it.each([
    "#/jobs",
    "#/jobs/7",
    "#/jobs/7?layer=depth&reduce=mean&z=2.5",
    "#/submit",
    "#/submit?from=7",
    "#/workers",
  ])("%s is read and written the same", (hash) => expect(hashOf(parse(hash))).toBe(hash));

  it("names page, job and view", () => {
    expect(parse("#/jobs/7?layer=depth")).toEqual({ page: "jobs", job: 7, query: { layer: "depth" } });
  });

  it.each([
    "",
    "#",
    "#/",
    "#/nowhere",
    "#/jobs/",
    "#/jobs/x",
    "#/jobs/-1",
    "#/jobs/1e3",
    "#/jobs/9999999999999999999",
  ])("that makes no sense (%s) is the jobs page", (hash) =>
    expect(parse(hash)).toEqual({ page: "jobs", job: null, query: {} }),
  );
});

describe("the layer in an address", () => {
  it.each([
    { layer: "picture", reduce: "majority", compat: false } as const,
    { layer: "depth", reduce: "mean", compat: false } as const,
    { layer: "all-rays", reduce: "majority", compat: true } as const,
  ])("%# is read as it was written", (choice) => expect(layerIn(queryOf(choice))).toEqual(choice));
  it("is left out for the picture", () => expect(queryOf(layerIn({}))).toEqual({}));
  it("has a known reduction whatever is written", () =>
    expect(layerIn({ reduce: "sum" }).reduce).toBe("majority"));
});

describe("the back button", () => {
  const to = (page: Route["page"], job: number | null = null, query = {}): Route => ({ page, job, query });
  it("undoes another page or another job, not a change of the view", () => {
    expect(isStep(to("jobs", 1), to("workers"))).toBe(true);
    expect(isStep(to("jobs", 1), to("jobs", 2))).toBe(true);
    expect(isStep(to("jobs", 1), to("jobs", 1, { layer: "depth" }))).toBe(false);
  });
  it("does not undo the first job that is shown by itself", () => {
    expect(isStep(to("jobs"), to("jobs", 1))).toBe(false);
  });
});

describe("the address", () => {
  const start = (hash: string) => {
    const at = { hash };
    const put = (_state: null, _title: string, to: string): void => void (at.hash = to);
    const browser = new EventTarget();
    vi.stubGlobal("location", at);
    vi.stubGlobal("history", { pushState: put, replaceState: put });
    vi.stubGlobal("addEventListener", browser.addEventListener.bind(browser));
    vi.stubGlobal("removeEventListener", browser.removeEventListener.bind(browser));
    vi.useFakeTimers();
    stop = startRouting();
    return { at, hashchange: () => browser.dispatchEvent(new Event("hashchange")) };
  };
  let stop: () => void;
  afterEach(() => {
    stop();
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("follows what is shown, once it comes to rest", () => {
    const { at } = start("");
    selectedId.value = 3;
    vi.runAllTimers();
    expect(at.hash).toBe("#/jobs/3");
    selectedId.value = 4; // a step that the back button undoes
    expect(at.hash).toBe("#/jobs/4");
  });

  // A link was set while the first jobs came in: the newest job was chosen then and overwrote the link unheard.
  it("that a link has set is kept until it is heard of", () => {
    const { at, hashchange } = start("#/jobs/2");
    at.hash = "#/jobs/1";
    selectedId.value = 5;
    vi.runAllTimers();
    expect(at.hash).toBe("#/jobs/1");
    hashchange();
    vi.runAllTimers();
    expect(selectedId.value).toBe(1);
    expect(at.hash).toBe("#/jobs/1");
  });
});
