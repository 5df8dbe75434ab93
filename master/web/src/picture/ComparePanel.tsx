import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { ApiError, getJson } from "../app/api";
import { layer, selectedJob } from "../app/state";
import type { Job } from "../app/types";
import {
  comparison,
  compares,
  currentEntry,
  flipped,
  framesQuery,
  metric,
  reference,
  referenceEntry,
  setReference,
  toggleComparison,
  toggleFlip,
  wipeAt,
} from "./compare";
import { metricNames, metrics, type Errors, type Metric } from "./difference";
import { errorsBetween } from "./figures";
import { plain } from "./format";
import { Changes } from "./HistoryPanel";
import { changesBetween } from "./history";
import { Section } from "./Section";
import { useSteady } from "./steady";

interface Difference {
  rmse: number;
  mae: number;
  max: number;
  flip: number;
}

/// Of the two pictures, as the master computes it; or why it cannot.
const answer = signal<Difference | string | null>(null);

function useDifference(a: number | undefined, b: number | undefined, query: string, both: string): void {
  useEffect(() => {
    answer.value = null;
    if (a === undefined || b === undefined) return;
    const stop = new AbortController();
    getJson<Difference>(`/jobs/${a}/difference/${b}${query}`, stop.signal).then(
      (difference) => (answer.value = difference),
      (error: unknown) => {
        if (error instanceof ApiError) answer.value = error.message;
      },
    );
    return () => stop.abort();
  }, [a, b, query, both]);
}

function Figures({ figures }: { figures: [string, number][] }) {
  return (
    <table class="figures" data-comparison>
      <tbody>
        {figures.map(([title, value]) => (
          <tr key={title} data-figure={title}>
            <th scope="row">{title}</th>
            <td>{plain(value, 5)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function PictureFigures() {
  const [a, b] = [selectedJob.value, reference.value];
  useDifference(a?.id, b?.id, framesQuery.value, `${a?.state} ${b?.state}`);
  const told = answer.value;
  if (told === null) return <p class="quiet">…</p>;
  if (typeof told === "string") return <p class="bad">{told}</p>;
  return (
    <Figures
      figures={[
        ["RMSE", told.rmse],
        ["MAE", told.mae],
        ["max", told.max],
        ["ꟻLIP", told.flip],
      ]}
    />
  );
}

function MapFigures() {
  const both = (): Errors | null => {
    const [a, b] = [currentEntry.value, referenceEntry.value];
    return a && b ? errorsBetween(a, b) : null;
  };
  const errors = useSteady(
    () => [currentEntry.value?.revision.value, referenceEntry.value?.revision.value],
    both,
  );
  if (!errors) return <p class="quiet">Both maps must be there, and of one size.</p>;
  return (
    <>
      <Figures
        figures={[
          ["RMSE", errors.rmse],
          ["MAE", errors.mae],
          ["max", errors.max],
        ]}
      />
      {errors.apart > 0 && <p class="quiet">{plain(errors.apart)} values are a number in one map only.</p>}
    </>
  );
}

function Ways() {
  const isPicture = layer.value.layer === "picture";
  const fitting = metrics.filter((each) => each !== "flip" || isPicture);
  return (
    <>
      <div class="buttons">
        <button aria-pressed={flipped.value} title="Space; hold Shift to look only" onClick={toggleFlip}>
          Flip
        </button>
        <button aria-pressed={comparison.value === "wipe"} title="W" onClick={() => toggleComparison("wipe")}>
          Wipe
        </button>
        <button
          aria-pressed={comparison.value === "difference"}
          title="X"
          onClick={() => toggleComparison("difference")}
        >
          Difference
        </button>
      </div>
      {comparison.value === "wipe" && (
        <div class="line">
          <label for="compare-wipe">Wipe at</label>
          <input
            id="compare-wipe"
            type="range"
            min={0}
            max={1}
            step={0.01}
            value={wipeAt.value}
            onInput={(event) => (wipeAt.value = Number(event.currentTarget.value))}
          />
        </div>
      )}
      {comparison.value === "difference" && (
        <div class="line">
          <label for="compare-metric">Metric</label>
          <select
            id="compare-metric"
            value={metric.value}
            onChange={(event) => (metric.value = event.currentTarget.value as Metric)}
          >
            {fitting.map((each) => (
              <option key={each} value={each}>
                {metricNames[each]}
              </option>
            ))}
          </select>
        </div>
      )}
    </>
  );
}

/// The result against the reference; comes into sight when a comparison begins.
export function ComparePanel() {
  const panel = useRef<HTMLDivElement>(null);
  const [job, other] = [selectedJob.value, reference.value];
  useEffect(() => {
    if (other) panel.current?.scrollIntoView({ block: "nearest" });
  }, [other?.id, comparison.value, answer.value !== null]);
  if (!job) return null;
  return <div ref={panel}>{compares.value && other ? <Comparing job={job} other={other} /> : <NotYet />}</div>;
}

const NotYet = () => (
  <Section title="Compare">
    <p class="quiet hint">Choose a reference in the history (ref, or Shift+digit).</p>
  </Section>
);

function Comparing({ job, other }: { job: Job; other: Job }) {
  return (
    <Section title="Compare" aside={`#${job.id} with #${other.id}`}>
      <Ways />
      {layer.value.layer === "picture" ? <PictureFigures /> : <MapFigures />}
      <p class="hint">
        <span class="quiet">#{job.id} has </span>
        <Changes changes={changesBetween(other, job)} none="the same settings" />
      </p>
      <div class="buttons">
        <button title="Shift+X" onClick={() => setReference(null)}>
          No reference
        </button>
      </div>
    </Section>
  );
}
