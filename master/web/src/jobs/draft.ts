// The job that is being written: kept while other pages are shown, gone when it was submitted.
import { computed, effect, signal } from "@preact/signals";
import { ApiError, getJson, postJson } from "../app/api";
import { openJob } from "../app/route";
import { tell } from "../app/state";
import type { Job, SceneEntry } from "../app/types";
import {
  bodyOf,
  emptyForm,
  faultsOf,
  fileFault,
  formOf,
  nothingDeclared,
  type Declared,
  type Form,
} from "./submission";

export const form = signal<Form>(emptyForm());
/// The master's scenes, once it told them; or why it did not.
export const scenes = signal<SceneEntry[] | null>(null);
export const scenesFault = signal("");

type Checked = { text: string; declared: Declared } | { text: string; fault: string } | null;
/// What the master says about the script as it is now.
export const checked = signal<Checked>(null);
/// Why the last file was not taken, or what the master said to the last submission.
export const refusal = signal("");
export const sending = signal(false);

export const declared = computed<Declared>(() => {
  if (form.value.source === "farm")
    return scenes.value?.find((one) => one.name === form.value.scene) ?? nothingDeclared;
  const script = checked.value;
  return form.value.source === "script" && script && "declared" in script ? script.declared : nothingDeclared;
});
export const faults = computed(() => {
  const offered = scenes.value?.some((one) => one.name === form.value.scene) ?? true;
  return faultsOf(offered ? form.value : { ...form.value, scene: "" }, declared.value);
});

let prefilledFrom: number | null = null;
/// Begins with a job's settings, or empty after those of another; once, so that what was changed since is kept.
export function prefill(job: Job | null): void {
  const from = job?.id ?? null;
  if (from === prefilledFrom) return;
  prefilledFrom = from;
  form.value = job ? formOf(job) : emptyForm();
}

export const change = (part: Partial<Form>): void => void (form.value = { ...form.value, ...part });

export async function loadScenes(): Promise<void> {
  try {
    scenes.value = (await getJson<{ scenes: SceneEntry[] }>("/scenes")).scenes;
    scenesFault.value = "";
  } catch (error) {
    scenesFault.value = wordsOf(error);
  }
}

const wordsOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/// Reads a script from a file, unless its name or size already say no.
export async function takeFile(file: File): Promise<void> {
  const fault = fileFault(file);
  refusal.value = fault ?? "";
  if (fault) return;
  change({ source: "script", script: { name: file.name, text: await file.text() } });
}

const typingPause = 500; // milliseconds

async function check(script: Form["script"]): Promise<void> {
  let result: Checked;
  try {
    const answer = await postJson<Declared>("/scripts", {
      name: script.name || "pasted.lua",
      script: script.text,
    });
    result = { text: script.text, declared: { ...nothingDeclared, ...answer } };
  } catch (error) {
    result = { text: script.text, fault: wordsOf(error) };
  }
  if (form.value.script.text === script.text) checked.value = result;
}

const script = computed(() => (form.value.source === "script" ? form.value.script : null));

/// While the form is shown, each new text of the script is told to the master once typing pauses.
export function followScript(): () => void {
  return effect(() => {
    const current = script.value;
    if (!current || current.text.trim() === "" || checked.peek()?.text === current.text) return;
    checked.value = null;
    const timer = setTimeout(() => void check(current), typingPause);
    return () => clearTimeout(timer);
  });
}

export async function submit(): Promise<void> {
  sending.value = true;
  refusal.value = "";
  try {
    const job = await postJson<Job>("/jobs", bodyOf(form.value, declared.value));
    form.value = emptyForm();
    prefilledFrom = null;
    tell(`Job ${job.id} (${job.name}) was submitted.`);
    openJob(job.id);
  } catch (error) {
    refusal.value = wordsOf(error);
    if (!(error instanceof ApiError)) throw error;
  } finally {
    sending.value = false;
  }
}
