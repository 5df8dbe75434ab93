import { useMemo } from "preact/hooks";
import { postJson, remove } from "../app/api";
import { ageOf } from "../app/clock";
import { confirm } from "../app/confirm";
import { count, duration, short } from "../app/format";
import { link, tellError, workers } from "../app/state";
import type { Worker } from "../app/types";
import { Sparkline } from "./Sparkline";
import { rates } from "./throughput";

type Verb = "drain" | "undrain" | "ban" | "unban";

function ask(worker: Worker, verb: Verb): void {
  postJson(`/workers/${encodeURIComponent(worker.name)}/${verb}`).catch(tellError);
}

function stopDialling(worker: Worker): void {
  remove(`/workers/dial/${encodeURIComponent(worker.name)}`).catch(tellError);
}

function askToBan(worker: Worker): void {
  confirm({
    title: `Ban ${worker.name}?`,
    text: "Its connection ends and its name is refused until somebody takes the ban back. Its tiles in work go to others.",
    yes: "Ban the worker",
    run: () => ask(worker, "ban"),
  });
}

export function WorkerTable() {
  const sorted = [...workers.value].sort((a, b) =>
    a.name.localeCompare(b.name, undefined, { numeric: true }),
  );
  return (
    <div class="worker-table" tabIndex={0} role="region" aria-label="Workers">
      <table>
        <thead>
          <tr>
            <th scope="col">Worker, address</th>
            <th scope="col">State</th>
            <th scope="col" class="number">
              Threads
            </th>
            <th scope="col" class="number" title="Primary samples a second, as learnt from its deliveries">
              Samples/s
            </th>
            <th scope="col" class="number" title="What it delivered in the last minute">
              Pixels/s
            </th>
            <th scope="col" class="number">
              Tiles
            </th>
            <th scope="col" class="number">
              Pixels
            </th>
            <th scope="col" class="number">
              Here for
            </th>
            <th scope="col">Processor, version</th>
            <th scope="col" class="actions">
              <span class="out-of-sight">Actions</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {sorted.map((worker) => (
            <WorkerRow key={worker.name} worker={worker} />
          ))}
        </tbody>
      </table>
      {sorted.length === 0 && link.value === "open" && (
        <p class="quiet">
          No workers. Start one with <code>rayfarm-worker --master {location.hostname}</code>, or let the
          master dial one that listens.
        </p>
      )}
    </div>
  );
}

function WorkerRow({ worker }: { worker: Worker }) {
  const isThere = worker.state !== "dialling" && worker.state !== "banned";
  return useMemo(
    () => (
      <tr class={worker.state}>
        <th scope="row">
          {worker.name}
          <small>{worker.kind === "local" ? "in the master" : worker.address}</small>
        </th>
        <td>
          <span class={`worker-state ${worker.state}`}>{worker.state}</span>
          {worker.message && <small class="why">{worker.message}</small>}
        </td>
        <td class="number">{worker.threads || ""}</td>
        <td class="number">{worker.samples_per_second > 0 && short(worker.samples_per_second)}</td>
        <td>{isThere && <Rate name={worker.name} />}</td>
        <td class="number">{worker.tiles > 0 && count(worker.tiles)}</td>
        <td class="number">{worker.pixels > 0 && short(worker.pixels)}</td>
        <td class="number">{isThere && <Age worker={worker} />}</td>
        <td title={worker.cpu}>
          {worker.cpu}
          <small>{worker.version}</small>
        </td>
        <td class="actions">
          <Steering worker={worker} />
        </td>
      </tr>
    ),
    [worker],
  );
}

function Rate({ name }: { name: string }) {
  const values = rates.value.workers.get(name) ?? [];
  const last = values[values.length - 1] ?? 0;
  return (
    <span class="rate">
      <Sparkline values={values} label="in the last minute" />
      {short(last)}
    </span>
  );
}

function Age({ worker }: { worker: Worker }) {
  const seconds = Math.floor(ageOf(worker));
  return <>{seconds < 60 ? `${seconds} s` : duration(seconds)}</>;
}

function Steering({ worker }: { worker: Worker }) {
  const { name, state } = worker;
  if (state === "banned")
    return (
      <button onClick={() => ask(worker, "unban")} aria-label={`Take back the ban of ${name}`}>
        Unban
      </button>
    );
  if (state === "dialling")
    return (
      <button onClick={() => stopDialling(worker)} aria-label={`Stop dialling ${name}`}>
        Stop dialling
      </button>
    );
  const verb = state === "drained" ? "undrain" : "drain";
  return (
    <>
      <button
        onClick={() => ask(worker, verb)}
        aria-label={`${verb} ${name}`}
        title={verb === "drain" ? "It gets nothing more; what it holds goes to others at once" : "Work again"}
      >
        {verb === "drain" ? "Drain" : "Undrain"}
      </button>
      {worker.kind === "remote" && (
        <button onClick={() => askToBan(worker)} aria-label={`Ban ${name}`}>
          Ban
        </button>
      )}
    </>
  );
}
