import { beforeEach, describe, expect, it } from "vitest";
import { startLive, type LiveClient, type News, type Socket } from "../../../master/web/src/app/live_client";
import type { Watch } from "../../../master/web/src/app/types";

class FakeSocket implements Socket {
  binaryType = "";
  sent: unknown[] = [];
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: (() => void) | null = null;
  send(text: string) {
    this.sent.push(JSON.parse(text));
  }
  close() {
    this.onclose?.();
  }
  tell(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

const silence = 15_000; // milliseconds, after which the master is asked whether it is there

let sockets: FakeSocket[];
let pauses: number[]; // asked for so far
let timers: { due: number; run: () => void }[];
let time: number;
let heard: unknown[][];
let reachable: boolean;

/// Lets the time pass, running what is due in its order.
function pass(milliseconds: number) {
  time += milliseconds;
  for (const timer of timers.filter((one) => one.due <= time)) {
    timers = timers.filter((one) => one !== timer);
    timer.run();
  }
}
const last = () => sockets[sockets.length - 1]!;
const names = () => heard.map(([name]) => name);

const watch = (job: number): Watch => ({ job, layer: "picture", reduce: "majority", compat: false });

function start(): LiveClient {
  const hear =
    (name: keyof News) =>
    (...told: unknown[]) =>
      void heard.push([name, ...told]);
  return startLive(
    {
      connect() {
        sockets.push(new FakeSocket());
        return last();
      },
      answers: () => Promise.resolve(reachable),
      after(milliseconds, run) {
        if (milliseconds < silence) pauses.push(milliseconds);
        const timer = { due: time + milliseconds, run };
        timers.push(timer);
        return () => void (timers = timers.filter((one) => one !== timer));
      },
    },
    {
      opened: hear("opened"),
      lost: hear("lost"),
      state: hear("state"),
      log: hear("log"),
      layer: hear("layer"),
      tile: hear("tile"),
      malformed: hear("malformed"),
    },
  );
}

beforeEach(() => {
  sockets = [];
  pauses = [];
  timers = [];
  time = 0;
  heard = [];
  reachable = true;
});

describe("what is watched", () => {
  it("is sent on opening, not before", () => {
    const client = start();
    client.watch([watch(1)]);
    expect(last().sent).toEqual([]);
    last().onopen!();
    expect(last().sent).toEqual([{ watch: [watch(1)] }]);
  });

  it("is sent again when it changes, replacing the set, and only then", () => {
    const client = start();
    last().onopen!();
    client.watch([watch(1), watch(2)]);
    client.watch([watch(1), watch(2)]);
    client.watch([watch(3)]);
    expect(last().sent).toEqual([{ watch: [] }, { watch: [watch(1), watch(2)] }, { watch: [watch(3)] }]);
  });

  it("is sent again after the connection was lost, as it is by then", () => {
    const client = start();
    last().onopen!();
    client.watch([watch(1)]);
    last().close();
    client.watch([watch(2)]);
    pass(250);
    last().onopen!();
    expect(sockets).toHaveLength(2);
    expect(last().sent).toEqual([{ watch: [watch(2)] }]);
  });
});

describe("a lost connection", () => {
  it("is tried again after pauses that double from 0.25 s to 5 s", () => {
    start();
    for (let i = 0; i < 7; ++i) {
      last().close();
      pass(pauses[pauses.length - 1]!);
    }
    expect(pauses).toEqual([250, 500, 1000, 2000, 4000, 5000, 5000]);
    expect(sockets).toHaveLength(8);
  });

  it("is not tried before the pause is over", () => {
    start();
    last().close();
    pass(249);
    expect(sockets).toHaveLength(1);
    pass(1);
    expect(sockets).toHaveLength(2);
  });

  it("begins with the short pause again once it was open", () => {
    start();
    last().close();
    pass(250);
    last().onopen!();
    last().close();
    expect(pauses).toEqual([250, 250]);
    expect(names()).toEqual(["lost", "opened", "lost"]);
  });

  it("is tried at once when asked, and then not a second time", () => {
    const client = start();
    last().close();
    client.retry();
    pass(10_000);
    expect(sockets).toHaveLength(2);
    client.retry();
    expect(sockets).toHaveLength(2);
  });
});

describe("a long silence", () => {
  it("is no loss while the master answers", async () => {
    start();
    last().onopen!();
    for (let i = 0; i < 3; ++i) {
      pass(silence);
      await Promise.resolve();
    }
    expect(names()).toEqual(["opened"]);
  });

  it("is a loss when it does not, and the old connection is not heard any more", async () => {
    start();
    const old = last();
    old.onopen!();
    reachable = false;
    pass(silence);
    await Promise.resolve();
    old.tell({ type: "log", lines: [] });
    expect(names()).toEqual(["opened", "lost"]);
    pass(250);
    last().onopen!();
    expect(sockets).toHaveLength(2);
    expect(names()).toEqual(["opened", "lost", "opened"]);
  });

  it("is looked for as long as nothing is heard", async () => {
    start();
    last().onopen!();
    reachable = false;
    last().tell({ type: "log", lines: [] });
    pass(silence);
    await Promise.resolve();
    expect(names()).toEqual(["opened", "log"]);
    pass(silence);
    await Promise.resolve();
    expect(names()).toEqual(["opened", "log", "lost"]);
  });
});

describe("messages", () => {
  it("are told in their order", () => {
    start();
    last().onopen!();
    last().tell({ type: "state", revision: 4, jobs: [], workers: [] });
    last().tell({ type: "layer", watch: 0, id: 3, state: "making" });
    const tile = new ArrayBuffer(36);
    const view = new DataView(tile);
    view.setUint32(0, 0x31544652, true);
    [3, 0, 0, 1, 1].forEach((value, i) => view.setUint32(4 + 4 * i, value, true));
    view.setUint16(24, 1, true);
    view.setUint8(26, 1);
    view.setUint8(27, 1);
    last().onmessage!({ data: tile });
    expect(names()).toEqual(["opened", "state", "layer", "tile"]);
    expect(last().binaryType).toBe("arraybuffer");
  });

  it("of the log are all the kept ones first, then new ones, on each connection", () => {
    start();
    const anew = () => heard.filter(([name]) => name === "log").map(([, , first]) => first);
    last().tell({ type: "log", lines: [] });
    last().tell({ type: "log", lines: [] });
    last().close();
    pass(250);
    last().tell({ type: "log", lines: [] });
    expect(anew()).toEqual([true, false, true]);
  });

  it("that make no sense are counted and change nothing", () => {
    start();
    last().onopen!();
    for (const data of [
      "{",
      "null",
      "7",
      '{"type":"state","jobs":3}',
      '{"type":"news"}',
      '{"type":"log"}',
      '{"tile":1}',
      new ArrayBuffer(8),
    ])
      last().onmessage!({ data });
    last().tell({ type: "state", jobs: [], workers: [] });
    expect(names()).toEqual(["opened", ...Array<string>(8).fill("malformed"), "state"]);
  });
});
