// The rays of the probed pixel, asked of the master while somebody looks. One request at a time: of the pixels that the
// pointer passes meanwhile only the newest is asked for.
import { computed, effect, signal } from "@preact/signals";
import { getJson } from "../app/api";
import { frameQuery } from "../app/frames";
import { link, probed, type Pixel } from "../app/state";
import { newestWins } from "./newest";
import { ofOneScene, subject, type Subject } from "./subject";
import type { PixelTrace } from "./trace";

/// A sample by its number, all of the pixel, or the pixel's centre, which the picture did not use.
export type SampleChoice = number | "all" | "centre";
export const sampleChoice = signal<SampleChoice>(0);

export interface Question extends Subject {
  pixel: Pixel;
  sample: SampleChoice;
}

export interface Answer {
  question: Question;
  trace: PixelTrace;
  milliseconds: number; // from the request to the decoded answer
}

/// The newest; it stays while the next one is under way, and goes when that fails: rays are never those of another pixel.
export const answer = signal<Answer | null>(null);
export const asking = signal(false);
/// Why there is no newer answer, in words.
export const probeError = signal<string | null>(null);

const question = computed<Question | null>(() =>
  subject.value && probed.value
    ? { ...subject.value, pixel: probed.value, sample: sampleChoice.value }
    : null,
);

const pathOf = ({ job, frame, pixel, sample }: Question): string =>
  `/jobs/${job}/trace?x=${pixel.x}&y=${pixel.y}&sample=${sample}${frameQuery(frame, "&")}`;

async function fetchAnswer(asked: Question, signal: AbortSignal): Promise<Answer> {
  const start = performance.now();
  const trace = await getJson<PixelTrace>(pathOf(asked), signal);
  return { question: asked, trace, milliseconds: performance.now() - start };
}

/// Until the result is called. For one follower at a time. What failed is asked again when the connection to the master
/// is found again.
export function followProbe(): () => void {
  const newest = newestWins(
    fetchAnswer,
    (asked, got: Answer) => {
      answer.value = got;
      probeError.value = null;
      asking.value = question.peek() !== asked;
    },
    (asked, error) => {
      answer.value = null;
      probeError.value = error instanceof Error ? error.message : String(error);
      asking.value = question.peek() !== asked;
    },
  );
  let last: Question | null = null;
  const unfollow = effect(() => {
    const next = question.value;
    if (!ofOneScene(next, last)) {
      newest.stop();
      if (!ofOneScene(next, answer.peek()?.question)) answer.value = null;
      probeError.value = null;
    }
    last = next;
    asking.value = next !== null;
    if (next) newest.ask(next);
  });
  const retry = effect(() => {
    const failed = question.peek();
    if (link.value === "open" && failed && probeError.peek() !== null) newest.ask(failed);
  });
  return () => {
    unfollow();
    retry();
    newest.stop();
    asking.value = false;
  };
}
