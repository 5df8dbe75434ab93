import { describe, expect, it } from "vitest";
import { fieldsOf, nameOf } from "../../../master/web/src/rays/record";
import { entriesOf } from "../../../master/web/src/rays/trace";
import { closedAbove, moveOf, rowsOf } from "../../../master/web/src/rays/tree_rows";
import { edge, glass } from "./rays_traces";

const none: ReadonlySet<string> = new Set();
const one = entriesOf(glass);
const all = entriesOf(edge);

describe("the ray tree", () => {
  it("of one sample is open, of many each sample is closed", () => {
    expect(rowsOf(one, 1, none).map((row) => row.entry)).toEqual(one);
    expect(rowsOf(all, 16, none).map((row) => row.entry.id)).toEqual(edge.samples.map((_, i) => String(i)));
  });

  it("hides all that is below a closed line, and only that", () => {
    const closed = rowsOf(one, 1, new Set(["0.0"])).map((row) => row.entry.id);
    expect(closed).toEqual(one.map((entry) => entry.id).filter((id) => !id.startsWith("0.0.")));
  });

  it("is walked with the arrow keys", () => {
    const rows = rowsOf(one, 1, none);
    expect(moveOf("ArrowDown", rows, null)).toEqual({ select: "0" });
    expect(moveOf("ArrowDown", rows, "0")).toEqual({ select: "0.l0" });
    expect(moveOf("ArrowUp", rows, "0")).toEqual({ select: "0" });
    expect(moveOf("ArrowLeft", rows, "0.l0")).toEqual({ select: "0" });
    expect(moveOf("ArrowLeft", rows, "0")).toEqual({ toggle: "0" });
    expect(moveOf("ArrowRight", rows, "0")).toEqual({ select: "0.l0" });
    expect(moveOf("ArrowRight", rowsOf(one, 1, new Set(["0"])), "0")).toEqual({ toggle: "0" });
    expect(moveOf("End", rows, "0")).toEqual({ select: one.at(-1)!.id });
    expect(moveOf("Enter", rows, "0.l0")).toBeNull();
    expect(moveOf("ArrowDown", rows, one.at(-1)!.id)).toBeNull();
  });

  it("knows what has to be opened for a line to be seen", () => {
    const rows = rowsOf(one, 1, new Set(["0", "0.0"]));
    expect(closedAbove(one, rows, "0.0.0")).toEqual(["0"]);
    expect(closedAbove(one, rowsOf(one, 1, new Set(["0.0"])), "0.0.0")).toEqual(["0.0"]);
    expect(closedAbove(one, rowsOf(one, 1, none), "0.0.0")).toEqual([]);
  });
});

describe("the record", () => {
  const text = (id: string) => {
    const entry = one.find((e) => e.id === id)!;
    return Object.fromEntries(fieldsOf(entry, glass.samples[0]!).map((field) => [field.label, field.text]));
  };

  it("of a ray tells where it went, what it counts and why it ended", () => {
    expect(text("0")).toMatchObject({
      Ray: "Camera ray → bitten/bite #1",
      Origin: "0.7, 1.2, −5",
      Length: "4.32811",
      Solid: "bitten/bite #1, entering",
      Importance: "1",
      Adds: "0.511, 0.711, 1.077",
      Ended: "followed by further rays",
    });
  });

  it("of a shadow ray tells what stands between", () => {
    const blocked = one.find((entry) => entry.what === "light" && entry.light.fate === "blocked")!;
    expect(text(blocked.id)).toMatchObject({
      "Blocked by": "bitten/bite #1",
      Ended: "blocked by bitten/bite #1",
    });
  });

  it("of every line has a name and no empty field", () => {
    for (const entry of [...one, ...all]) {
      const trace = one.includes(entry) ? glass : edge;
      expect(nameOf(entry)).not.toMatch(/undefined|NaN/);
      for (const field of fieldsOf(entry, trace.samples[entry.sample]!))
        expect(field.text, field.label).not.toMatch(/^$|undefined|NaN/);
    }
  });
});
