import { beforeEach, describe, expect, it, vi } from "vitest";
import type { LayerListener } from "../../../master/web/src/app/live";
import type { LayerMessage, TileMessage, Watch } from "../../../master/web/src/app/types";

let listener: LayerListener;
let watched: Watch[] = [];
vi.mock("../../../master/web/src/app/live", () => ({
  listen: (added: LayerListener) => {
    listener = added;
    return () => undefined;
  },
  watch: (list: Watch[]) => (watched = list),
  watches: () => watched,
}));
const { entryOf, startStore, surplus, want } = await import("../../../master/web/src/picture/store");
const { link } = await import("../../../master/web/src/app/state");

let lastJob = 0;
let watches: Watch[] = [];
const layer = (watch: number, id: number, change: Partial<LayerMessage> = {}): LayerMessage => ({
  type: "layer",
  watch,
  id,
  job: watched[watch]!.job,
  layer: watched[watch]!.layer,
  width: 2,
  height: 1,
  step: 1,
  channels: 1,
  state: "making",
  progress: 0,
  message: "",
  range: null,
  ...change,
});
const tile = (id: number, value: number): TileMessage => ({
  id,
  x: 0,
  y: 0,
  width: 2,
  height: 1,
  stride: 1,
  channels: 1,
  values: Float32Array.of(value, value),
});
const valueOf = (watch: Watch): number | undefined => entryOf(watch).data?.at(0, 0)?.[0];

startStore();
beforeEach(() => {
  link.value = "open";
  watches = [1, 2].map(() => ({ job: ++lastJob, layer: "depth", reduce: "majority", compat: false }));
  want(watches);
});

describe("the store of layers", () => {
  it("asks for what is wanted, the first eight, each once", () => {
    const many = Array.from({ length: 12 }, (_, i): Watch => ({ ...watches[0]!, job: 1000 + i }));
    want([many[0]!, ...many]);
    expect(watched.map((w) => w.job)).toEqual([1000, 1001, 1002, 1003, 1004, 1005, 1006, 1007]);
  });

  it("gives each layer its own tiles", () => {
    listener.layer(layer(0, 31));
    listener.layer(layer(1, 32));
    listener.tile(tile(32, 5));
    listener.tile(tile(31, 4));
    listener.tile(tile(99, 6));
    expect(watches.map(valueOf)).toEqual([4, 5]);
  });

  it("keeps a finished layer without asking again", () => {
    listener.layer(layer(0, 41));
    listener.tile(tile(41, 4));
    listener.layer(layer(0, 41, { state: "done", progress: 1 }));
    want([watches[1]!]);
    want(watches);
    expect(watched).toEqual([watches[1]]);
    expect(valueOf(watches[0]!)).toBe(4);
  });

  it("asks again for an unfinished one, and shows what it has until it begins anew", () => {
    listener.layer(layer(0, 51));
    listener.tile(tile(51, 4));
    want([watches[1]!]);
    want(watches);
    expect(watched).toEqual(watches);
    listener.layer(layer(0, 52));
    expect(valueOf(watches[0]!)).toBe(4);
    listener.tile(tile(51, 7));
    expect(valueOf(watches[0]!)).toBe(4);
    listener.tile(tile(52, 8));
    expect(valueOf(watches[0]!)).toBe(8);
  });

  it("takes numbers of a new connection for new layers", () => {
    listener.layer(layer(0, 61));
    listener.layer(layer(1, 62));
    link.value = "lost";
    link.value = "open";
    listener.tile(tile(61, 1));
    expect(valueOf(watches[0]!)).toBeUndefined();
    listener.layer(layer(1, 61));
    listener.tile(tile(61, 9));
    expect(watches.map(valueOf)).toEqual([undefined, 9]);
  });

  it("begins anew when the layer has another size", () => {
    listener.layer(layer(0, 71));
    listener.tile(tile(71, 4));
    listener.layer(layer(0, 72, { width: 3 }));
    expect(entryOf(watches[0]!).data).toMatchObject({ width: 3, begun: false });
  });

  it("finds the layer by job and name when the list has changed since it was numbered", () => {
    const before = layer(1, 81);
    want([watches[1]!, watches[0]!]);
    listener.layer(before);
    listener.tile(tile(81, 3));
    expect(watches.map(valueOf)).toEqual([undefined, 3]);
  });
});

describe("what is let go when there are too many bytes", () => {
  const all = [3, 1, 2, 4].map((used) => ({ bytes: 100, used, wanted: used === 1 }));
  it("is the longest unwanted, as much as needed, and nothing that is wanted", () => {
    expect(surplus(all, 400)).toEqual([]);
    expect(surplus(all, 399).map((each) => each.used)).toEqual([2]);
    expect(surplus(all, 250).map((each) => each.used)).toEqual([2, 3]);
    expect(surplus(all, 0).map((each) => each.used)).toEqual([2, 3, 4]);
  });
});

describe("after the connection was lost", () => {
  const finish = (id: number, value: number) => {
    listener.layer(layer(0, id, { state: "done", progress: 1 }));
    listener.tile(tile(id, value));
    want(watches);
  };

  it("what was finished is asked for again: this may be another master with another job of that number", () => {
    finish(71, 1);
    expect(watched).toEqual([watches[1]]);
    link.value = "lost";
    link.value = "open";
    expect(watched).toEqual(watches);
    finish(71, 2);
    expect(valueOf(watches[0]!)).toBe(2);
  });

  it("a layer that was missing has its own shape when it comes", () => {
    listener.layer(layer(0, 72, { width: 0, height: 0, state: "failed", message: "there is no job 1" }));
    listener.layer(layer(0, 72));
    listener.tile(tile(72, 3));
    expect(valueOf(watches[0]!)).toBe(3);
  });
});
