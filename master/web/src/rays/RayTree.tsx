import { computed, effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { plain as short } from "../picture/format";
import { cssOf } from "./color";
import { outlierRule } from "./outliers";
import { answer } from "./probe";
import { nameOf } from "./record";
import { entries, entryOf, hover, hovered, select, selected, spread } from "./selection";
import type { Entry, TracedSample } from "./trace";
import { StrokeSample } from "./Toolbar";
import { closedAbove, moveOf, rowsOf, type Toggled, type TreeRow } from "./tree_rows";

const rowHeight = 20;
const toggled = signal<Toggled>(new Set());
const samples = computed<readonly TracedSample[]>(() => answer.value?.trace.samples ?? []);
const rows = computed(() => rowsOf(entries.value, samples.value.length, toggled.value));

function flip(ids: readonly string[]): void {
  const next = new Set(toggled.value);
  for (const id of ids) if (!next.delete(id)) next.add(id);
  toggled.value = next;
}

function key(event: KeyboardEvent): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const handled = ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight", "Home", "End", "Enter", " "].includes(
    event.key,
  );
  if (!handled) return;
  event.preventDefault();
  const move = moveOf(event.key, rows.value, selected.value?.id ?? null);
  if (!move) return;
  if ("select" in move) select(move.select);
  else flip([move.toggle]);
}

const strokeOf = { primary: "camera", reflected: "reflected", refracted: "refracted" } as const;

function Mark({ entry }: { entry: Entry }) {
  if (entry.what === "ray") return <StrokeSample stroke={strokeOf[entry.ray.kind]} missed={!entry.ray.hit} />;
  if (entry.what === "untraced") return <span class="no-stroke">×</span>;
  const { fate } = entry.light;
  if (fate === "reached") return <StrokeSample stroke="shadow" />;
  if (fate === "blocked") return <StrokeSample stroke="blocked" />;
  return <span class="no-stroke">·</span>;
}

function Name({ entry }: { entry: Entry }) {
  const sample = samples.value[entry.sample];
  if (entry.level > 0 || samples.value.length < 2 || !sample) return <>{nameOf(entry)}</>;
  return (
    <>
      <b>{sample.sample}</b> {nameOf(entry)}
    </>
  );
}

const isOutlier = (entry: Entry): boolean => entry.level === 0 && spread.value.outliers[entry.sample] === true;

function OutlierBadge() {
  const { mean, deviation } = spread.value;
  const title = `An outlier: ${outlierRule} (mean ${short(mean)}, deviation ${short(deviation)})`;
  return (
    <em class="outlier" title={title}>
      outlier
    </em>
  );
}

function Value({ entry }: { entry: Entry }) {
  if (entry.what === "untraced") return <span class="value quiet">{short(entry.untraced.weight, 2)}</span>;
  const color = entry.what === "ray" ? entry.ray.color : entry.light.color;
  return (
    <>
      {entry.what === "ray" && (
        <span class="value quiet" title="Importance">
          {short(entry.ray.importance, 2)}
        </span>
      )}
      <span
        class="rays-patch"
        style={{ background: cssOf(color) }}
        title={`Colour ${color.map((c) => short(c, 3)).join(", ")}`}
      />
    </>
  );
}

function TreeLine({ row }: { row: TreeRow }) {
  const { entry, parent, open } = row;
  const { id, level } = entry;
  return (
    <div
      id={`ray-${id}`}
      class={`tree-row ${entry.what} ${hovered.value?.id === id ? "hovered" : ""}`}
      role="treeitem"
      aria-level={level + 1}
      aria-expanded={parent ? open : undefined}
      aria-selected={selected.value?.id === id}
      data-entry={id}
      data-outlier={isOutlier(entry) ? "true" : undefined}
      style={{ paddingLeft: `${4 + 12 * level}px`, height: `${rowHeight}px` }}
      onPointerEnter={() => hover(id)}
      onPointerLeave={() => hover(null)}
      onClick={() => select(id)}
      onDblClick={() => parent && flip([id])}
    >
      <span class="twisty" onClick={() => flip(parent ? [id] : [])}>
        {parent ? (open ? "▾" : "▸") : ""}
      </span>
      <Mark entry={entry} />
      <span class="name">
        <Name entry={entry} />
      </span>
      {isOutlier(entry) && <OutlierBadge />}
      <Value entry={entry} />
    </div>
  );
}

/// Opens what hides the selected line and brings it into sight.
function followSelection(list: HTMLElement): () => void {
  return effect(() => {
    const id = selected.value?.id;
    if (id === undefined) return;
    const closed = closedAbove(entries.peek(), rows.peek(), id);
    if (closed.length > 0) flip(closed);
    const top = rows.peek().findIndex((row) => row.entry.id === id) * rowHeight;
    if (top < list.scrollTop) list.scrollTop = top;
    else if (top + rowHeight > list.scrollTop + list.clientHeight)
      list.scrollTop = top + rowHeight - list.clientHeight;
  });
}

const scrolled = signal(0);
const height = signal(600);

/// All rays as a tree; only the lines in sight are in the page.
export function RayTree() {
  const list = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = list.current!;
    const observer = new ResizeObserver(() => (height.value = element.clientHeight));
    observer.observe(element);
    const unfollow = followSelection(element);
    return () => {
      observer.disconnect();
      unfollow();
    };
  }, []);
  const first = Math.max(0, Math.floor(scrolled.value / rowHeight) - 5);
  const seen = rows.value.slice(first, first + Math.ceil(height.value / rowHeight) + 10);
  const active = selected.value && entryOf(selected.value.id);
  const many = spread.value.outliers.filter(Boolean).length;
  return (
    <section class="rays-tree" aria-label="Ray tree">
      <div
        ref={list}
        class="tree-list"
        role="tree"
        tabIndex={0}
        aria-label="Rays"
        aria-activedescendant={active ? `ray-${active.id}` : undefined}
        onKeyDown={key}
        onScroll={(event) => (scrolled.value = event.currentTarget.scrollTop)}
      >
        <div style={{ height: `${rows.value.length * rowHeight}px` }}>
          <div style={{ transform: `translateY(${first * rowHeight}px)` }}>
            {seen.map((row) => (
              <TreeLine key={row.entry.id} row={row} />
            ))}
          </div>
        </div>
      </div>
      {samples.value.length > 1 && (
        <p class="tree-foot quiet" title={outlierRule}>
          {many === 0 ? "No outliers" : many === 1 ? "1 outlier" : `${many} outliers`}: {"> 2 σ"} of
          luminance, σ = {short(spread.value.deviation, 3)}
        </p>
      )}
    </section>
  );
}
