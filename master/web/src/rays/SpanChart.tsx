import { plain as short } from "../picture/format";
import { cssOf } from "./color";
import { scene } from "./scene";
import { nameOf } from "./record";
import { spanMark } from "./selection";
import { chartOf, type Bar, type Row } from "./spans";
import { story, storyError, type Story } from "./story";
import type { CsgStory, TracedRay } from "./trace";
import { along, unit } from "./vec";

const rowHeight = 18;
const at = (share: number): string => `${(100 * share).toFixed(3)}%`;

function point(ray: TracedRay, row: Row, bar: Bar): void {
  const direction = unit(ray.direction);
  const ends = [...(bar.startsInside ? [] : [bar.in]), ...(bar.out === null ? [] : [bar.out])];
  spanMark.value = { points: ends.map((t) => along(ray.origin, direction, t)), leaf: row.leaf };
}
const leave = (): void => void (spanMark.value = null);

const words = (bar: Bar): string =>
  `${bar.startsInside ? "from the start" : short(bar.in, 5)} to ${bar.out === null ? "∞" : short(bar.out, 5)}`;

function colorOf(row: Row): string {
  const solid = scene.value?.solids.find((s) => s.leaf === row.leaf);
  return row.leaf === null ? "var(--accent)" : solid ? cssOf(solid.color) : "var(--quiet)";
}

function Bars({ row, index, ray }: { row: Row; index: number; ray: TracedRay }) {
  const y = index * rowHeight + 3;
  const fill = colorOf(row);
  return (
    <>
      {row.bars.map((bar) => (
        <g
          key={bar.in}
          class="span"
          tabIndex={0}
          role="img"
          aria-label={`${row.name}: ${words(bar)}`}
          data-leaf={row.leaf ?? "material"}
          onPointerEnter={() => point(ray, row, bar)}
          onPointerLeave={leave}
          onFocus={() => point(ray, row, bar)}
          onBlur={leave}
        >
          <title>{`${row.name}: ${words(bar)}`}</title>
          <rect
            x={at(bar.from)}
            width={at(Math.max(bar.to - bar.from, 0.002))}
            y={y}
            height={rowHeight - 6}
            rx="2"
            fill={fill}
          />
          {bar.endless && (
            <svg x="100%" y={y} overflow="visible">
              <path
                d={`M0 -1 l7 ${(rowHeight - 4) / 2} l-7 ${(rowHeight - 4) / 2} z`}
                fill={fill}
                stroke="none"
              />
            </svg>
          )}
        </g>
      ))}
    </>
  );
}

function Chart({ ray, csg }: { ray: TracedRay; csg: CsgStory }) {
  const hit = ray.hit?.distance ?? null;
  const chart = chartOf(csg, hit);
  const share = (t: number) => (t - chart.from) / (chart.to - chart.from);
  const height = chart.rows.length * rowHeight;
  return (
    <div class="spans-grid">
      <ol style={{ lineHeight: `${rowHeight}px` }}>
        {chart.rows.map((row) => (
          <li key={row.leaf ?? "material"} class={row.leaf === null ? "material" : ""} title={row.name}>
            {row.name}
          </li>
        ))}
      </ol>
      <svg width="100%" height={height + 18} overflow="visible">
        {chart.ticks.map((t) => (
          <g key={t} class="tick">
            <line x1={at(share(t))} x2={at(share(t))} y1="0" y2={height} />
            <text x={at(share(t))} y={height + 13} text-anchor="middle">
              {short(t)}
            </text>
          </g>
        ))}
        {chart.rows.map((row, i) => (
          <Bars key={row.leaf ?? "material"} row={row} index={i} ray={ray} />
        ))}
        <line class="rule" x1="0" x2="100%" y1={height - rowHeight} y2={height - rowHeight} />
        {hit !== null && <line class="hit" x1={at(share(hit))} x2={at(share(hit))} y1="-2" y2={height} />}
      </svg>
    </div>
  );
}

function titleOf({ entry, sample }: Story): string {
  const of = sample.sample === "centre" ? "" : ` of sample ${sample.sample}`;
  return `Solids along the ${entry.parent === null ? "primary ray" : nameOf(entry)}${of}`;
}

/// Where the chosen ray is inside each leaf, and inside what the set operations make of them.
export function SpanChart() {
  const told = story.value;
  return (
    <section class="rays-spans" aria-label="Set operations along the ray" data-ray={told?.entry.id}>
      {told && <h3>{titleOf(told)}</h3>}
      {told &&
        (told.csg.leaves.length === 0 ? (
          <p class="quiet">It passes through none.</p>
        ) : (
          <Chart ray={told.entry.ray} csg={told.csg} />
        ))}
      {storyError.value && (
        <p class="bad" role="alert">
          Solids along the ray: {storyError}
        </p>
      )}
    </section>
  );
}
