// The WebSocket that brings news: jobs, workers, log, and the tiles of the layers that are watched.
import { batch } from "@preact/signals";
import { getJson, urlOf } from "./api";
import { hear } from "./clock";
import { startLive, type LiveClient, type News, type Socket } from "./live_client";
import { reconcile } from "./reconcile";
import { jobs, link, log, loginWanted, lostSince, malformed, maps, tellError, workers } from "./state";
import type { LayerMessage, LogLine, MapEntry, TileMessage, Watch } from "./types";

export interface LayerListener {
  layer(message: LayerMessage): void;
  tile(message: TileMessage): void;
}

const listeners = new Set<LayerListener>();
let watched: readonly Watch[] = [];
let client: LiveClient | null = null;

/// Asks for exactly these layers from now on (at most 8), also after the connection was lost and found again.
export function watch(list: Watch[]): void {
  watched = list;
  client?.watch(list);
}
export const watches = (): readonly Watch[] => watched;

export function listen(listener: LayerListener): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export const retry = (): void => client?.retry();

const mostLines = 2000; // of the log

function withLines(old: LogLine[], lines: LogLine[]): LogLine[] {
  const last = old[old.length - 1]?.number ?? -1;
  return [...old, ...lines.filter((line) => line.number > last)].slice(-mostLines);
}

const news: News = {
  opened() {
    link.value = "open";
    lostSince.value = null;
    loginWanted.value = false;
    getJson<{ maps: MapEntry[] }>("/maps").then((answer) => (maps.value = answer.maps), tellError);
  },
  lost() {
    link.value = "lost";
    lostSince.value ??= Date.now();
    getJson("/maps").catch(() => {}); // a WebSocket is not told why it is refused: this tells whether it is the login
  },
  state(newJobs, newWorkers) {
    batch(() => {
      const time = Date.now();
      hear(newJobs, time);
      hear(newWorkers, time);
      jobs.value = reconcile(jobs.value, newJobs, (job) => job.id);
      workers.value = reconcile(workers.value, newWorkers, (worker) => worker.name);
    });
  },
  log(lines, anew) {
    hear(lines, Date.now());
    log.value = anew ? lines : withLines(log.value, lines);
  },
  layer(message) {
    for (const listener of listeners) listener.layer(message);
  },
  tile(message) {
    for (const listener of listeners) listener.tile(message);
  },
  malformed() {
    ++malformed.value;
  },
};

export function goLive(): void {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  client = startLive(
    {
      connect: () => new WebSocket(`${scheme}://${location.host}/api/v1/live`) as unknown as Socket,
      after(milliseconds, run) {
        const timer = setTimeout(run, milliseconds);
        return () => clearTimeout(timer);
      },
      answers: () =>
        fetch(urlOf("/maps"), { signal: AbortSignal.timeout(5000) }).then(
          () => true,
          () => false,
        ),
    },
    news,
  );
  client.watch(watched);
}
