// The layers that are looked at or were lately: their numbers, fed by the master's news, and which are asked for.
import { effect, signal, type Signal, untracked } from "@preact/signals";
import { listen, watch, watches } from "../app/live";
import { link } from "../app/state";
import type { LayerMessage, TileMessage, Watch } from "../app/types";
import { LayerData } from "./layer_data";

export interface Entry {
  readonly watch: Watch;
  /// How it stands, as last told.
  readonly message: Signal<LayerMessage | null>;
  data: LayerData | null;
  /// Grows with every change of the data.
  readonly revision: Signal<number>;
  used: number; // when it was last wanted, in steps
}

export const mostWatched = 8; // the master's limit
const mostBytes = 512 * 1024 * 1024;

const entries = new Map<string, Entry>();
const byId = new Map<number, Entry>(); // of this connection
let wanted: Entry[] = [];
let step = 0;

const keyOf = (w: Watch): string => `${w.job} ${w.frame ?? "-"} ${w.layer} ${w.reduce} ${w.compat}`;

export function entryOf(w: Watch): Entry {
  const key = keyOf(w);
  let entry = entries.get(key);
  if (!entry) {
    entry = { watch: w, message: signal(null), data: null, revision: signal(0), used: ++step };
    entries.set(key, entry);
  }
  return entry;
}

/// As told by this connection: another master may call another job by the same number.
const finished = (entry: Entry): boolean =>
  [...byId.values()].includes(entry) &&
  entry.message.peek()?.state === "done" &&
  entry.data !== null &&
  entry.data.complete;

/// From now on these are kept up to date, the first the most important; finished ones are only kept.
export function want(list: Watch[]): void {
  wanted = [...new Set(list.map(entryOf))].slice(0, mostWatched);
  for (const entry of wanted) entry.used = ++step;
  const asked = wanted.filter((entry) => !finished(entry)).map((entry) => entry.watch);
  const now = watches();
  if (asked.length !== now.length || asked.some((w, i) => keyOf(w) !== keyOf(now[i]!))) watch(asked);
  forget();
}

/// Which to let go for the bytes to be at most so many: the least recently wanted, but none that is wanted now.
export function surplus<T extends { bytes: number; used: number; wanted: boolean }>(
  all: T[],
  most: number,
): T[] {
  let bytes = all.reduce((sum, each) => sum + each.bytes, 0);
  const oldest = all.filter((each) => !each.wanted).sort((a, b) => a.used - b.used);
  return oldest.filter((each) => {
    const goes = bytes > most;
    if (goes) bytes -= each.bytes;
    return goes;
  });
}

function forget(): void {
  const all = [...entries].map(([key, entry]) => ({
    key,
    entry,
    bytes: entry.data?.bytes ?? 0,
    used: entry.used,
    wanted: wanted.includes(entry),
  }));
  for (const { key, entry } of surplus(all, mostBytes)) {
    entries.delete(key);
    forgetIds(entry);
  }
}

function forgetIds(entry: Entry): void {
  for (const [id, other] of byId) if (other === entry) byId.delete(id);
}

/// The list of watches may have changed since the master numbered it.
function entryFor(message: LayerMessage): Entry | undefined {
  const list = watches();
  const fits = (w: Watch | undefined): w is Watch =>
    w?.job === message.job && w.frame === message.frame && w.layer === message.layer;
  const named = list[message.watch];
  const found = fits(named) ? named : list.find(fits);
  return found && entryOf(found);
}

/// The layer begins, perhaps again: what is known of it is shown until it is replaced.
function begin(message: LayerMessage): Entry | undefined {
  const entry = entryFor(message);
  if (!entry) return undefined;
  forgetIds(entry);
  byId.set(message.id, entry);
  const { width, height, channels, step: apart } = message;
  if (entry.data && hasShapeOf(entry.data, message)) entry.data.outdate();
  else entry.data = new LayerData(width, height, channels, apart);
  forget();
  return entry;
}

const hasShapeOf = (data: LayerData, { width, height, channels, step: apart }: LayerMessage): boolean =>
  data.width === width && data.height === height && data.channels === channels && data.step === apart;

function takeLayer(message: LayerMessage): void {
  const known = byId.get(message.id);
  const entry = known?.data && hasShapeOf(known.data, message) ? known : begin(message);
  if (!entry) return;
  entry.message.value = message;
  entry.revision.value += 1;
}

function takeTile(tile: TileMessage): void {
  const entry = byId.get(tile.id);
  if (entry?.data?.put(tile)) entry.revision.value += 1;
}

export function startStore(): () => void {
  const stopListening = listen({ layer: takeLayer, tile: takeTile });
  const stopEffect = effect(() => {
    if (link.value === "open") return untracked(() => want(wanted.map((entry) => entry.watch)));
    byId.clear(); // a new connection numbers anew
  });
  return () => {
    stopListening();
    stopEffect();
  };
}
