import { computed } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { duration, percent } from "../app/format";
import { isAnimation } from "../app/frames";
import { openJob } from "../app/route";
import { jobs, link, selectedId, selectedJob } from "../app/state";
import type { Job, JobState } from "../app/types";
import { filter } from "./filter";
import { listed, step } from "./job_actions";

const states: JobState[] = ["running", "waiting", "paused", "done", "failed", "cancelled"];
const counts = computed(() => {
  const found = new Map<JobState, number>();
  for (const job of jobs.value) found.set(job.state, (found.get(job.state) ?? 0) + 1);
  return found;
});

/// The queue in its order, then the history.
export function JobList() {
  const { queue, history } = listed.value;
  // The row of a new job comes later than its choice.
  useEffect(() => {
    document.getElementById(`job-${selectedId.value}`)?.scrollIntoView({ block: "nearest" });
  }, [selectedJob.value?.id]);
  return (
    <section class="job-list" aria-label="Job list">
      <FilterBar />
      <div
        id="job-list"
        role="listbox"
        aria-label="Jobs"
        tabIndex={0}
        aria-activedescendant={selectedId.value === null ? undefined : `job-${selectedId.value}`}
        onKeyDown={moveByKey}
      >
        {queue.length > 0 && <Rows title="Queue" jobs={queue} />}
        {history.length > 0 && <Rows title="History" jobs={history} />}
        {queue.length + history.length === 0 && <Nothing />}
      </div>
    </section>
  );
}

function moveByKey(event: KeyboardEvent) {
  const moves: Record<string, number> = {
    ArrowUp: -1,
    ArrowDown: 1,
    PageUp: -10,
    PageDown: 10,
    Home: -1e9,
    End: 1e9,
  };
  const steps = moves[event.key];
  if (steps === undefined || event.ctrlKey || event.altKey) return;
  event.preventDefault();
  step(steps);
}

function FilterBar() {
  return (
    <div class="filter-bar">
      <input
        type="search"
        placeholder="Filter jobs"
        aria-label="Filter jobs by name or number"
        value={filter.value.text}
        onInput={(event) => (filter.value = { ...filter.value, text: event.currentTarget.value })}
      />
      <select
        aria-label="Filter jobs by state"
        value={filter.value.state}
        onChange={(event) =>
          (filter.value = { ...filter.value, state: event.currentTarget.value as JobState | "all" })
        }
      >
        <option value="all">all {jobs.value.length}</option>
        {states.map((state) => (
          <option key={state} value={state}>
            {state} {counts.value.get(state) ?? 0}
          </option>
        ))}
      </select>
    </div>
  );
}

function Rows({ title, jobs: rows }: { title: string; jobs: Job[] }) {
  return (
    <div role="group" aria-label={title}>
      <h3 role="presentation">
        {title} <span>{rows.length}</span>
      </h3>
      {rows.map((job) => (
        <JobRow key={job.id} job={job} chosen={job.id === selectedId.value} />
      ))}
    </div>
  );
}

/// The same tree as long as its job is the same: hundreds of rows stay cheap.
function JobRow({ job, chosen }: { job: Job; chosen: boolean }) {
  return useMemo(
    () => (
      <div
        id={`job-${job.id}`}
        role="option"
        aria-selected={chosen}
        class={`job ${job.state}`}
        onClick={() => openJob(job.id)}
      >
        <span class={`state-dot ${job.state}`} title={job.state} />
        <span class="name">{job.name}</span>
        <span class="quiet">#{job.id}</span>
        <span class="how-far">
          <HowFar job={job} />
        </span>
        {!["done", "failed", "cancelled"].includes(job.state) && (
          <progress max={job.pixels_total} value={job.pixels_done} aria-label="Rendered" />
        )}
      </div>
    ),
    [job, chosen],
  );
}

function HowFar({ job }: { job: Job }) {
  const share = `${percent(job.pixels_done, job.pixels_total)} %`;
  const done = isAnimation(job) ? `${job.frames.done}/${job.frames.total} frames, ${share}` : share;
  switch (job.state) {
    case "running":
      return <>{job.eta_seconds === null ? done : `${done}, ${duration(job.eta_seconds)} left`}</>;
    case "waiting":
    case "paused":
      return <>{job.pixels_done > 0 ? `${job.state}, ${done}` : job.state}</>;
    case "done":
      return <>{duration(job.elapsed_seconds)}</>;
    case "failed":
    case "cancelled":
      return <>{job.state}</>;
  }
}

function Nothing() {
  if (jobs.value.length > 0) return <p class="quiet">No job fits the filter.</p>;
  if (link.value !== "open") return null;
  return (
    <p class="quiet">
      No jobs yet. <a href="#/submit">Submit the first</a>, or{" "}
      <code>rayfarm submit scene.lua -o picture.png</code>.
    </p>
  );
}
