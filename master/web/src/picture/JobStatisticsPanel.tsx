import { signal } from "@preact/signals";
import { getJson } from "../app/api";
import { count, duration } from "../app/format";
import { frameQuery, shownFrame } from "../app/frames";
import { selectedId, selectedJob, tellError } from "../app/state";
import { plain } from "./format";
import { hitsByName, titlesOf, type JobStatistics } from "./job_statistics";
import { Section } from "./Section";

const told = signal<{ job: number; frame: number | null; statistics: JobStatistics } | null>(null);
const asking = signal(false);

/// Until the detail is there too, or another frame is chosen.
async function ask(job: number, frame: number | null): Promise<void> {
  asking.value = true;
  try {
    for (
      let path = `/jobs/${job}/statistics${frameQuery(frame, "?")}`;
      selectedId.value === job && shownFrame.value === frame;
      path = `/jobs/${job}/statistics?wait=1${frameQuery(frame, "&")}`
    ) {
      const statistics = await getJson<JobStatistics>(path);
      told.value = { job, frame, statistics };
      if (statistics.detail.state !== "making") return;
    }
  } finally {
    asking.value = false;
  }
}

function CounterTable({ statistics }: { statistics: JobStatistics }) {
  return (
    <table class="figures">
      <thead>
        <tr>
          <th scope="col">rays</th>
          <th scope="col">total</th>
          <th scope="col">a pixel</th>
        </tr>
      </thead>
      <tbody>
        {titlesOf(statistics.counters).map(([name, title]) => (
          <tr key={name} data-counter={name}>
            <th scope="row">{title}</th>
            <td>{count(statistics.counters[name]!)}</td>
            <td>{plain(statistics.mean_per_pixel[name] ?? 0, 3)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/// What a ray of each kind was tested against, in the mean.
function TestsTable({ tests }: { tests: NonNullable<JobStatistics["detail"]["tests"]> }) {
  const kinds = Object.keys(tests);
  return (
    <table class="figures">
      <thead>
        <tr>
          <th scope="col">tests a ray</th>
          {kinds.map((kind) => (
            <th key={kind} scope="col">
              {kind}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {["boxes", "leaves", "crossings"].map((what) => (
          <tr key={what} data-tests={what}>
            <th scope="row">{what}</th>
            {kinds.map((kind) => (
              <td key={kind}>{plain(tests[kind]![`${what}_per_ray`] ?? 0, 3)}</td>
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Detail({ statistics }: { statistics: JobStatistics }) {
  const { detail } = statistics;
  if (detail.state === "unavailable")
    return <p class="quiet">{detail.message || "Hits and tests of this job cannot be counted any more."}</p>;
  if (detail.state === "making")
    return <progress max={1} value={detail.progress ?? 0} aria-label="Hits and tests being counted" />;
  const hits = hitsByName(detail.hits ?? []);
  const most = hits[0]?.hits ?? 1;
  return (
    <>
      {detail.tests && <TestsTable tests={detail.tests} />}
      <h4>Hits by solid</h4>
      <ul class="hits">
        {hits.slice(0, 40).map((each) => (
          <li key={each.name} title={each.solids > 1 ? `${each.solids} solids` : undefined}>
            <span class="hit-bar" style={{ width: `${(100 * each.hits) / most}%` }} />
            <span class="name">
              {each.name}
              {each.solids > 1 && <span class="quiet"> × {each.solids}</span>}
            </span>
            <span class="number">{count(each.hits)}</span>
          </li>
        ))}
      </ul>
    </>
  );
}

const phaseNames: Record<string, string> = { threads: "on all threads", wasted: "in vain" };

/// What the job cost, counted exactly; asked for on demand.
export function JobStatisticsPanel() {
  const job = selectedJob.value;
  if (!job) return null;
  const statistics = told.value?.job === job.id && told.value.frame === shownFrame.value ? told.value.statistics : null;
  return (
    <Section title="Statistics of the job">
      <div class="buttons">
        <button disabled={asking.value} onClick={() => void ask(job.id, shownFrame.value).catch(tellError)}>
          {statistics ? "Count again" : "Count"}
        </button>
      </div>
      {statistics && (
        <>
          <CounterTable statistics={statistics} />
          <table class="figures">
            <tbody>
              <tr>
                <th scope="row">samples a pixel</th>
                <td>{plain(statistics.samples_per_pixel, 4)}</td>
              </tr>
              {Object.entries(statistics.seconds).map(([phase, seconds]) => (
                <tr key={phase}>
                  <th scope="row">{phaseNames[phase] ?? phase}</th>
                  <td>{duration(seconds)}</td>
                </tr>
              ))}
              {statistics.rays_wasted !== undefined && (
                <tr>
                  <th scope="row">rays in vain</th>
                  <td>{count(statistics.rays_wasted)}</td>
                </tr>
              )}
            </tbody>
          </table>
          <Detail statistics={statistics} />
        </>
      )}
    </Section>
  );
}
