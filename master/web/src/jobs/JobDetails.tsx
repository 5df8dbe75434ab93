import type { ComponentChildren } from "preact";
import { ageOf } from "../app/clock";
import { ago, count, duration, many, percent } from "../app/format";
import { isAnimation } from "../app/frames";
import { Icon } from "../app/Icon";
import { openSubmit } from "../app/route";
import { jobs, link, selectedId, selectedJob, workers } from "../app/state";
import type { Counters, Job } from "../app/types";
import { cancel, isPaused, pauseOrResume, remove, setPriority } from "./job_actions";
import { hasEnded, whyWaiting } from "./order";

export function JobDetails() {
  const job = selectedJob.value;
  if (job) return <Details job={job} />;
  if (link.value === "connecting") return null;
  return <p class="job-details quiet">The master has no job {selectedId.value}, or keeps it no longer.</p>;
}

function Details({ job }: { job: Job }) {
  const why = whyWaiting(job, jobs.value, workers.value);
  return (
    <section class="job-details" aria-label={`Job ${job.id}`}>
      <header>
        <h2 title={job.name}>{job.name}</h2>
        <span class="quiet">#{job.id}</span>
        <span class={`state ${job.state}`}>{job.state}</span>
      </header>
      <Tools job={job} />
      {job.message && <p class={job.state === "failed" ? "bad" : undefined}>{job.message}</p>}
      {why && <p>{why}</p>}
      <Progress job={job} />
      <Settings job={job} />
      <Parameters parameters={job.parameters} />
      <CounterList counters={job.counters} />
    </section>
  );
}

function Tools({ job }: { job: Job }) {
  const ended = hasEnded(job);
  return (
    <div class="tools" role="toolbar" aria-label="Steer the job">
      {!ended && (
        <>
          <button title="P in the job list" onClick={() => pauseOrResume(job)}>
            <Icon name={isPaused(job) ? "play" : "pause"} /> {isPaused(job) ? "Resume" : "Pause"}
          </button>
          <button title="Delete in the job list" onClick={() => cancel(job)}>
            <Icon name="close" /> Cancel
          </button>
        </>
      )}
      <button
        title="A new job with these settings, to be changed (C in the job list)"
        onClick={() => openSubmit(job.id)}
      >
        <Icon name="copy" /> Clone
      </button>
      {ended && (
        <button title="Shift+Delete in the job list" onClick={() => remove(job)}>
          <Icon name="close" /> Remove
        </button>
      )}
    </div>
  );
}

function Row({ name, children }: { name: string; children: ComponentChildren }) {
  return (
    <>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </>
  );
}

function Progress({ job }: { job: Job }) {
  return (
    <dl>
      {isAnimation(job) && (
        <Row name="Frames">
          {job.frames.done} of {job.frames.total}
          {job.frames.sent < job.frames.total && `, ${job.frames.sent} known`}
        </Row>
      )}
      <Row name="Pixels">
        {count(job.pixels_done)} of {count(job.pixels_total)} ({percent(job.pixels_done, job.pixels_total)} %)
      </Row>
      <Row name="Rendering">
        {duration(job.elapsed_seconds)}
        {job.eta_seconds !== null && `, ${duration(job.eta_seconds)} left`}
      </Row>
      <Row name="Submitted">{ago(ageOf(job))}</Row>
      <Row name="Priority">
        <Priority job={job} />
      </Row>
      {job.tiles_given_back > 0 && (
        <Row name="Given back">
          <span title="Tiles that were not finished where they were begun: the job was paused, or a worker was drained, left, or failed">
            {many(job.tiles_given_back, "tile")}, rendered anew
          </span>
        </Row>
      )}
      {job.verify !== "none" && (
        <Row name="Verified">
          <span title="Tiles on which several had to agree, and did">
            {many(job.tiles_checked, "tile")} checked ({job.verify})
          </span>
        </Row>
      )}
      {job.tiles_doubled > 0 && (
        <Row name="Doubled">
          <span title="Near the end, idle workers render again what others are slow with; the first result is taken">
            {many(job.tiles_doubled, "tile")}
          </span>
        </Row>
      )}
      {job.tiles_shared > 0 && (
        <Row name="Shared">
          <span title="Near the end, idle threads of several workers render pieces of one tile">
            {many(job.tiles_shared, "tile")}
          </span>
        </Row>
      )}
      {job.seconds_wasted > 0 && (
        <Row name="Wasted">
          <span title="What threads spent on tiles that were given back, or that another worker had sooner">
            {duration(job.seconds_wasted)} of threads
          </span>
        </Row>
      )}
      {job.output && <Row name="Output">{job.output}</Row>}
      <Row name="Scene">
        <code title={job.scene_hash}>{job.scene_hash.slice(0, 12)}</code>
      </Row>
    </dl>
  );
}

function Priority({ job }: { job: Job }) {
  if (hasEnded(job)) return <>{job.priority}</>;
  return (
    <input
      key={`${job.id} ${job.priority}`}
      type="number"
      aria-label="Priority"
      title="0 to 99, higher goes first; + and - in the job list"
      min={0}
      max={99}
      defaultValue={String(job.priority)}
      onChange={(event) => setPriority(job, event.currentTarget.valueAsNumber)}
    />
  );
}

function Settings({ job }: { job: Job }) {
  const s = job.settings;
  const off = (["shadows", "reflections", "refractions"] as const).filter((name) => !s[name]);
  return (
    <dl>
      <Row name="Size">
        {s.width} × {s.height}
      </Row>
      <Row name="Samples">
        {s.spp} per pixel, {s.sampler}
      </Row>
      <Row name="Seed">{s.seed}</Row>
      <Row name="Frame">
        {isAnimation(job)
          ? `${job.frames.first} to ${job.frames.last}${job.frames.step > 1 ? `, in steps of ${job.frames.step}` : ""}`
          : s.frame}
      </Row>
      <Row name="Depth">
        {s.max_depth}, importance {s.min_importance}
      </Row>
      {off.length > 0 && <Row name="Without">{off.join(", ")}</Row>}
    </dl>
  );
}

function Parameters({ parameters }: { parameters: Record<string, string> }) {
  const entries = Object.entries(parameters);
  if (entries.length === 0) return null;
  return (
    <dl>
      {entries.map(([name, value]) => (
        <Row key={name} name={name}>
          {value}
        </Row>
      ))}
    </dl>
  );
}

const rays: [keyof Counters, string][] = [
  ["primary", "Primary rays"],
  ["reflected", "Reflected"],
  ["refracted", "Refracted"],
  ["shadow", "Shadow rays"],
];

function CounterList({ counters }: { counters: Counters }) {
  return (
    <dl>
      {rays.map(([key, name]) => (
        <Row key={key} name={name}>
          {count(counters[key])}
        </Row>
      ))}
      {counters.lost > 0 && (
        <Row name="Lost rays">
          <span class="warn">{count(counters.lost)}</span>
        </Row>
      )}
      {counters.bad_samples > 0 && (
        <Row name="NaN samples">
          <span class="bad">{count(counters.bad_samples)}</span>
        </Row>
      )}
    </dl>
  );
}
