import { describe, expect, it } from "vitest";
import { filter, match } from "../../../master/web/src/app/fuzzy";

const entries = [
  "Show the picture",
  "Show map: Depth",
  "Zoom in",
  "Zoom out",
  "7 sphere_flake (done)",
  "Pause or resume the job",
];
const found = (query: string) => filter(query, entries, (entry) => entry).map(({ entry }) => entry);

describe("finding by letters", () => {
  it("takes letters in their order, whatever their case", () => {
    expect(match("zin", "Zoom in")?.places).toEqual([0, 5, 6]);
    expect(match("niz", "Zoom in")).toBeNull();
  });
  it("puts beginnings of words and runs first", () => {
    expect(found("depth")[0]).toBe("Show map: Depth");
    expect(found("zo")[0]).toBe("Zoom in");
    expect(found("sf")[0]).toBe("7 sphere_flake (done)");
    expect(found("resume")[0]).toBe("Pause or resume the job");
  });
  it("finds the best place of the first letter", () => expect(match("in", "pin in")?.places).toEqual([4, 5]));
  it("ignores blanks in what is asked for", () => expect(found("zoom out")).toEqual(["Zoom out"]));
  it("shows all in their order while nothing is asked for", () => expect(found(" ")).toEqual(entries));
  it("finds nothing when a letter is missing", () => expect(found("qqq")).toEqual([]));
});
