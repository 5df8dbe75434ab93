// The job's point cloud, fetched when it is first shown.
import { effect, signal } from "@preact/signals";
import { getMade } from "../app/api";
import { frameQuery } from "../app/frames";
import { shown } from "./options";
import { parsePly, type Cloud } from "./ply";
import { subject, type Subject } from "./subject";

export type CloudState =
  | { state: "none" }
  | { state: "making"; progress: number } // on the master, 0 to 1
  | { state: "loading"; bytes: number; total: number | null }
  | { state: "ready"; cloud: Cloud }
  | { state: "failed"; message: string };

export const cloudState = signal<CloudState>({ state: "none" });

const mostPoints = 200_000;

/// The body as it comes in; `heard` is told how much is there.
async function bodyOf(
  response: Response,
  heard: (bytes: number, total: number | null) => void,
): Promise<ArrayBuffer> {
  const length = response.headers.get("Content-Length");
  const total = length === null ? null : Number(length);
  const chunks: Uint8Array<ArrayBuffer>[] = [];
  let bytes = 0;
  const reader = response.body!.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    chunks.push(part.value);
    heard((bytes += part.value.length), total);
  }
  return new Blob(chunks).arrayBuffer();
}

async function load({ job, frame }: Subject, signal: AbortSignal): Promise<void> {
  const tell = (state: CloudState) => {
    if (!signal.aborted) cloudState.value = state;
  };
  try {
    tell({ state: "making", progress: 0 });
    const path = `/jobs/${job}/cloud.ply?points=${mostPoints}&form=binary${frameQuery(frame, "&")}`;
    const response = await getMade(path, (progress) => tell({ state: "making", progress }), signal);
    const body = await bodyOf(response, (bytes, total) => tell({ state: "loading", bytes, total }));
    tell({ state: "ready", cloud: parsePly(body) });
  } catch (error) {
    tell({ state: "failed", message: error instanceof Error ? error.message : String(error) });
  }
}

/// Of the job while it is shown, until the result is called. Hiding keeps it; another job's takes its place.
export function followCloud(): () => void {
  let controller: AbortController | null = null;
  let loaded: Subject | null = null;
  const forget = () => {
    controller?.abort();
    controller = loaded = null;
    cloudState.value = { state: "none" };
  };
  const unfollow = effect(() => {
    const which = subject.value;
    const wanted = shown.cloud.value;
    if (loaded !== null && (which !== loaded || (!wanted && cloudState.peek().state !== "ready"))) forget();
    if (!wanted || which === null || loaded === which) return;
    controller = new AbortController();
    loaded = which;
    void load(which, controller.signal);
  });
  return () => {
    unfollow();
    forget();
  };
}
