import { selectedJob } from "../app/state";
import { openJob } from "../app/route";
import type { Job } from "../app/types";
import { reference, setReference } from "./compare";
import { changesBetween, historyLength, pinned, results, togglePin, type Change } from "./history";
import { Section } from "./Section";

export function Changes({ changes, none }: { changes: Change[]; none: string }) {
  if (changes.length === 0) return <span class="quiet">{none}</span>;
  return (
    <span class="changes">
      {changes.map((change) => (
        <span key={change.name} title={`${change.name}: ${change.from} → ${change.to}`}>
          {change.name} <b>{change.to}</b>
        </span>
      ))}
    </span>
  );
}

function Result({ job, slot }: { job: Job; slot: number }) {
  const current = selectedJob.value!;
  const isCurrent = job.id === current.id;
  const isReference = job.id === reference.value?.id;
  const isPinned = pinned.value.includes(job.id);
  return (
    <li aria-current={isCurrent ? "true" : undefined} data-job={job.id}>
      <button class="plain result" title={`Show job ${job.id} (${slot})`} onClick={() => openJob(job.id)}>
        <span class="slot">{slot <= 5 ? slot : ""}</span>
        <span class="id">#{job.id}</span>
        {isCurrent ? (
          <span class="quiet">shown</span>
        ) : (
          <Changes changes={changesBetween(current, job)} none="same settings" />
        )}
      </button>
      <button
        class="plain"
        aria-pressed={isPinned}
        aria-label={`Keep job ${job.id} up to date`}
        title="Keep up to date while others are shown"
        onClick={() => togglePin(job.id)}
      >
        pin
      </button>
      <button
        class="plain"
        aria-pressed={isReference}
        aria-label={`Compare with job ${job.id}`}
        title={`Compare with this (Shift+${slot})`}
        onClick={() => setReference(isReference ? null : job.id)}
      >
        ref
      </button>
    </li>
  );
}

/// The last results of the scene, with what is other about them than about the one that is shown.
export function HistoryPanel() {
  if (!selectedJob.value) return null;
  const length = (
    <label
      class="history-length"
      title="How many results are listed"
      onClick={(event) => event.stopPropagation()}
    >
      last
      <input
        type="number"
        min={5}
        max={50}
        value={historyLength.value}
        onChange={(event) =>
          (historyLength.value = Math.min(
            50,
            Math.max(5, Math.round(Number(event.currentTarget.value)) || 5),
          ))
        }
      />
    </label>
  );
  return (
    <Section title="History" aside={length}>
      <ol class="results">
        {results.value.map((job, i) => (
          <Result key={job.id} job={job} slot={i + 1} />
        ))}
      </ol>
    </Section>
  );
}
