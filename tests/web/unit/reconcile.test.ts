import { describe, expect, it } from "vitest";
import { reconcile } from "../../../master/web/src/app/reconcile";

interface Item {
  id: number;
  name: string;
  age_seconds: number;
  settings: { width: number };
}
const item = (id: number, more: Partial<Item> = {}): Item => ({
  id,
  name: "a",
  age_seconds: 1,
  settings: { width: 4 },
  ...more,
});
const merged = (old: Item[], fresh: Item[]) => reconcile(old, fresh, (one) => one.id);

describe("a list that comes anew", () => {
  it("has the contents of the new one in its order", () => {
    const fresh = [item(3), item(1, { name: "b" })];
    expect(merged([item(1), item(2), item(3)], fresh)).toEqual(fresh);
  });
  it("keeps the object of what did not change, though it got older", () => {
    const old = [item(1), item(2)];
    const list = merged(old, [item(1, { age_seconds: 9 }), item(2, { name: "b" })]);
    expect(list[0]).toBe(old[0]);
    expect(list[1]).not.toBe(old[1]);
  });
  it("sees changes inside, and members that come or go", () => {
    const old = [item(1)];
    expect(merged(old, [item(1, { settings: { width: 5 } })])[0]).not.toBe(old[0]);
    expect(merged(old, [{ ...item(1), more: 1 } as Item])[0]).not.toBe(old[0]);
  });
});
