// Requests to the master. Every failure is an ApiError in words for people.
import { loginWanted } from "./state";

export class ApiError extends Error {
  constructor(
    readonly status: number, // 0: no answer at all
    message: string,
  ) {
    super(message);
  }
}

const base = "/api/v1";

async function request(path: string, init: RequestInit): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(base + path, init);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new ApiError(0, "The master does not answer; is it running?");
  }
  if (response.ok) return response;
  if (response.status === 401) loginWanted.value = true;
  let words = `${response.status} ${response.statusText}`;
  try {
    const body = (await response.json()) as { error?: string };
    if (body.error) words = body.error;
  } catch {
    // no JSON: the status must do
  }
  throw new ApiError(response.status, words);
}

export async function getJson<T>(path: string, signal?: AbortSignal): Promise<T> {
  const response = await request(path, signal ? { signal } : {});
  return (await response.json()) as T;
}

export async function getBlob(path: string): Promise<Blob> {
  return (await request(path, {})).blob();
}

export async function remove(path: string): Promise<void> {
  await request(path, { method: "DELETE" });
}

export async function postJson<T>(path: string, body: unknown = {}): Promise<T> {
  const response = await request(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  });
  return (await response.json()) as T;
}

/// Asks again while the master is making it (202); tells how far it is, 0 to 1.
export async function getMade(
  path: string,
  progress: (share: number) => void,
  signal?: AbortSignal,
): Promise<Response> {
  const joint = path.includes("?") ? "&" : "?";
  for (;;) {
    const response = await request(`${path}${joint}wait=1`, signal ? { signal } : {});
    if (response.status !== 202) return response;
    progress(((await response.json()) as { progress: number }).progress);
  }
}

export const urlOf = (path: string): string => base + path;
