// The set operations along the chosen ray. The trace tells them along each primary ray; along another they are asked
// of the master when it is chosen, one request at a time, and of those chosen meanwhile only the newest.
import { computed, effect, signal } from "@preact/signals";
import { getJson } from "../app/api";
import { frameQuery } from "../app/frames";
import { newestWins } from "./newest";
import { answer, type Question } from "./probe";
import { entries, rayEntryOf, selected } from "./selection";
import { rayNumberOf, type CsgStory, type PixelTrace, type RayEntry, type TracedSample } from "./trace";

export interface Story {
  entry: RayEntry;
  sample: TracedSample;
  csg: CsgStory;
}

/// Along the chosen ray, or else the first; the last one stays while that is under way.
export const story = signal<Story | null>(null);
/// Why there is none of the chosen ray, in words.
export const storyError = signal<string | null>(null);

type Chosen = Omit<Story, "csg"> & { probe: Question };

const pathOf = ({ entry, sample, probe: { job, frame, pixel } }: Chosen): string =>
  `/jobs/${job}/trace?x=${pixel.x}&y=${pixel.y}&sample=${sample.sample}` +
  `&story=${rayNumberOf(sample.ray, entry.ray)}${frameQuery(frame, "&")}`;

const chosenRay = computed(() => rayEntryOf(selected.value ?? entries.value[0] ?? null));
const chosen = computed<Chosen | null>(() => {
  const [got, entry] = [answer.value, chosenRay.value];
  const sample = entry && got?.trace.samples[entry.sample];
  return sample ? { entry, sample, probe: got.question } : null;
});

/// Until the result is called. For one follower at a time.
export function followStory(): () => void {
  const show = (next: Story | null, error: string | null = null): void => {
    story.value = next;
    storyError.value = error;
  };
  const newest = newestWins(
    async (asked: Chosen, stop) => (await getJson<PixelTrace>(pathOf(asked), stop)).samples[0]!.csg,
    ({ entry, sample }, csg) => show({ entry, sample, csg }),
    (_, error) => show(null, error instanceof Error ? error.message : String(error)),
  );
  const unfollow = effect(() => {
    const asked = chosen.value;
    if (asked && asked.entry.parent !== null) return newest.ask(asked);
    newest.stop();
    show(asked && { ...asked, csg: asked.sample.csg });
  });
  return () => {
    unfollow();
    newest.stop();
    show(null);
  };
}
