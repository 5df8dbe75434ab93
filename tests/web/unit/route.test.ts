import { describe, expect, it } from "vitest";
import { hashOf, isStep, layerIn, parse, queryOf, type Route } from "../../../master/web/src/app/route";

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
