import { describe, expect, it } from "vitest";
import { keyOf, type Action } from "../../../master/web/src/app/actions";
import { actionFor, type Place } from "../../../master/web/src/app/keys";

const pressed = (key: string, more: Partial<KeyboardEvent> = {}): KeyboardEvent =>
  ({
    key,
    code: "",
    ctrlKey: false,
    metaKey: false,
    altKey: false,
    shiftKey: false,
    ...more,
  }) as KeyboardEvent;

describe("a key's name", () => {
  it.each([
    [pressed("e"), "E"],
    [pressed("E", { shiftKey: true }), "Shift+E"],
    [pressed("E"), "E"], // caps lock
    [pressed("k", { ctrlKey: true }), "Ctrl+K"],
    [pressed("k", { metaKey: true }), "Ctrl+K"],
    [pressed("?", { shiftKey: true }), "?"],
    [pressed("+", { shiftKey: true }), "+"],
    [pressed(" "), "Space"],
    [pressed("ArrowLeft", { altKey: true }), "Alt+ArrowLeft"],
    [pressed("Tab", { shiftKey: true }), "Shift+Tab"],
    [pressed("1", { code: "Digit1" }), "1"],
    [pressed("!", { code: "Digit1", shiftKey: true }), "Shift+1"],
  ])("%# is what the list of actions says", (event, name) => expect(keyOf(event)).toBe(name));
});

describe("a key", () => {
  const action = (id: string, keys: string[], more: Partial<Action> = {}): Action => ({
    id,
    title: id,
    group: "General",
    keys,
    run: () => undefined,
    ...more,
  });
  const place: Place = {
    scope: null,
    takesText: false,
    takesArrows: false,
    takesPress: false,
    dialog: false,
    freeTab: false,
  };
  const all = [
    action("previous picture", ["A"]),
    action("move left", ["A"], { scope: "rays" }),
    action("palette", ["Ctrl+K"]),
    action("layer", ["ArrowLeft"]),
    action("flip", ["Space"]),
    action("panels", ["H", "Tab"]),
    action("back", ["Escape"]),
    action("never", ["N"], { enabled: () => false }),
  ];
  const id = (key: string, part: Partial<Place> = {}) => actionFor(key, { ...place, ...part }, all)?.id;

  it("means what is listed", () => {
    expect(id("A")).toBe("previous picture");
    expect(id("Z")).toBeUndefined();
    expect(id("Shift+A")).toBeUndefined();
  });
  it("in the 3D view means what it means there first", () => {
    expect(id("A", { scope: "rays" })).toBe("move left");
    expect(id("H", { scope: "rays" })).toBe("panels");
    expect(id("A", { scope: "jobs" })).toBe("previous picture");
  });
  it("in a text field writes, but for Escape and those with Ctrl", () => {
    expect(id("A", { takesText: true })).toBeUndefined();
    expect(id("Ctrl+K", { takesText: true })).toBe("palette");
    expect(id("Escape", { takesText: true })).toBe("back");
  });
  it("that a slider or a button wants is theirs", () => {
    expect(id("ArrowLeft", { takesArrows: true })).toBeUndefined();
    expect(id("Space", { takesPress: true })).toBeUndefined();
    expect(id("A", { takesPress: true, takesArrows: true })).toBe("previous picture");
  });
  it("is a dialog's while one is open", () => expect(id("Escape", { dialog: true })).toBeUndefined());
  it("named Tab moves the focus unless the pointer is in use", () => {
    expect(id("Tab")).toBeUndefined();
    expect(id("Shift+Tab", { freeTab: true })).toBeUndefined();
    expect(id("Tab", { freeTab: true })).toBe("panels");
  });
  it("of what cannot be done now does nothing", () => expect(id("N")).toBeUndefined());
});
