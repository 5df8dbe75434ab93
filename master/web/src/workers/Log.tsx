import { computed, signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { timeOf } from "../app/clock";
import { timeOfDay } from "../app/format";
import { log, workers } from "../app/state";
import type { LogLine } from "../app/types";

const worker = signal(""); // "": all
const warnings = signal(false);
const follows = signal(true);

const lines = computed(() =>
  log.value.filter(
    (line) => (worker.value === "" || line.worker === worker.value) && (!warnings.value || line.warning),
  ),
);
const names = computed(() => {
  const all = new Set(
    [...workers.value, ...log.value.map((line) => ({ name: line.worker }))].map((one) => one.name),
  );
  all.delete("");
  return [...all].sort((a, b) => a.localeCompare(b, undefined, { numeric: true }));
});

/// What happened on the farm; follows the end unless it is scrolled up.
export function Log() {
  const list = useRef<HTMLOListElement>(null);
  const toEnd = () => list.current?.scrollTo({ top: list.current.scrollHeight });
  useLayoutEffect(() => {
    if (follows.value) toEnd();
  }, [lines.value]);
  useEffect(() => {
    const sized = new ResizeObserver(() => follows.peek() && toEnd());
    sized.observe(list.current!);
    return () => sized.disconnect();
  }, []);
  return (
    <section class="log" aria-label="Log">
      <header>
        <h2>Log</h2>
        <select
          aria-label="Lines of which worker"
          value={worker.value}
          onChange={(event) => (worker.value = event.currentTarget.value)}
        >
          <option value="">all workers</option>
          {names.value.map((name) => (
            <option key={name}>{name}</option>
          ))}
        </select>
        <label>
          <input
            type="checkbox"
            checked={warnings.value}
            onChange={(event) => (warnings.value = event.currentTarget.checked)}
          />
          warnings only
        </label>
        <button class="plain" hidden={follows.value} onClick={toEnd}>
          Follow the end
        </button>
      </header>
      <ol
        ref={list}
        role="log"
        aria-live="off"
        aria-label="Lines"
        tabIndex={0}
        onScroll={({ currentTarget: at }) =>
          (follows.value = at.scrollHeight - at.scrollTop - at.clientHeight < 8)
        }
      >
        {lines.value.map((line) => (
          <Line key={line.number} line={line} />
        ))}
      </ol>
    </section>
  );
}

function Line({ line }: { line: LogLine }) {
  return useMemo(
    () => (
      <li class={line.warning ? "warn" : undefined}>
        <time>{timeOfDay(timeOf(line))}</time>
        <span class="quiet">{line.worker}</span>
        <span>
          {line.warning && <span class="out-of-sight">Warning: </span>}
          {line.text}
        </span>
      </li>
    ),
    [line],
  );
}
