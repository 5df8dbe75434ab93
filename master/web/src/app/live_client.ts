// The conversation over the WebSocket, apart from the browser: connects, says what is watched, tells the news,
// and begins again when the connection is lost.
import { decodeTile } from "./tile";
import type { Job, LayerMessage, LogLine, TileMessage, Watch, Worker } from "./types";

/// What is used of a WebSocket.
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  send(text: string): void;
  close(): void;
}

export interface Surroundings {
  connect(): Socket;
  /// Runs it later; the result takes that back.
  after(milliseconds: number, run: () => void): () => void;
  /// Whether the master answers another request; asked when it has been silent for long.
  answers(): Promise<boolean>;
}

export interface News {
  opened(): void;
  lost(): void;
  state(jobs: Job[], workers: Worker[]): void;
  /// `anew`: the first lines of a connection, all that the master keeps.
  log(lines: LogLine[], anew: boolean): void;
  layer(message: LayerMessage): void;
  tile(message: TileMessage): void;
  malformed(): void;
}

const shortestPause = 250; // milliseconds, doubled after each failure
const longestPause = 5000;
const longSilence = 15_000; // milliseconds; a master that vanished without a word closes nothing

export interface LiveClient {
  /// Asks for exactly these layers from now on, also after the connection was lost and found again.
  watch(list: readonly Watch[]): void;
  /// Tries at once instead of after the pause.
  retry(): void;
}

export function startLive(around: Surroundings, news: News): LiveClient {
  let watched: readonly Watch[] = [];
  let socket: Socket | null = null; // the last one made
  let isOpen = false;
  let pause = shortestPause;
  let cancelPause: (() => void) | null = null;
  let heard = false; // since the last look

  const send = () => socket?.send(JSON.stringify({ watch: watched }));

  function lose(made: Socket): void {
    if (made !== socket || cancelPause) return;
    isOpen = false;
    cancelPause = around.after(pause, connect);
    pause = Math.min(2 * pause, longestPause);
    news.lost();
  }

  /// Each long silence is looked into, as long as this is the connection.
  function listenFor(made: Socket): void {
    heard = false;
    around.after(longSilence, () => {
      if (made !== socket || !isOpen) return;
      if (heard) return listenFor(made);
      void around.answers().then((alive) => {
        if (alive) return listenFor(made);
        lose(made);
        made.close();
      });
    });
  }

  function connect(): void {
    cancelPause = null;
    const made = (socket = around.connect());
    let anew = true;
    made.binaryType = "arraybuffer";
    made.onopen = () => {
      isOpen = true;
      pause = shortestPause;
      news.opened();
      send();
      listenFor(made);
    };
    made.onclose = () => lose(made);
    made.onmessage = ({ data }) => {
      if (made !== socket || cancelPause) return; // given up already
      heard = true;
      const told = read(data);
      if (!told) news.malformed();
      else if ("tile" in told) news.tile(told.tile);
      else if (told.type === "state") news.state(told.jobs, told.workers);
      else if (told.type === "layer") news.layer(told);
      else {
        news.log(told.lines, anew);
        anew = false;
      }
    };
  }

  connect();
  return {
    watch(list) {
      if (JSON.stringify(list) === JSON.stringify(watched)) return;
      watched = list;
      if (isOpen) send();
    },
    retry() {
      if (!cancelPause) return;
      cancelPause();
      connect();
    },
  };
}

type Told =
  | { tile: TileMessage }
  | { type: "state"; jobs: Job[]; workers: Worker[] }
  | { type: "log"; lines: LogLine[] }
  | LayerMessage;

function read(data: unknown): Told | null {
  try {
    if (data instanceof ArrayBuffer) return { tile: decodeTile(data) };
    const message = JSON.parse(String(data)) as Told;
    if ("tile" in message) return null;
    if (message.type === "state")
      return Array.isArray(message.jobs) && Array.isArray(message.workers) ? message : null;
    if (message.type === "log") return Array.isArray(message.lines) ? message : null;
    return message.type === "layer" && typeof message.id === "number" ? message : null;
  } catch {
    return null;
  }
}
