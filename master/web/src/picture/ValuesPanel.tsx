import { useEffect, useRef } from "preact/hooks";
import { count } from "../app/format";
import { theme } from "../app/theme";
import type { MapEntry } from "../app/types";
import { shownMap, shownOf } from "./display";
import { metricNames } from "./difference";
import { plain, timeText } from "./format";
import { palettes } from "./palettes";
import { logStep, positionOf } from "./range";
import { saveSelection } from "./save";
import { Section } from "./Section";
import { areaIn, selection } from "./selection";
import { shownMetric, shownStand, shownValues } from "./shown_values";
import { figuresOf, histogramOf, type Figures } from "./statistics";
import { useSteady } from "./steady";

interface Summary {
  figures: Figures[]; // a channel
  low: number; // of all channels; above `high` while there are no values
  high: number;
  histograms: number[][]; // a channel; none without a finite value
}

const bins = 128;

function summary(): Summary | null {
  const shown = shownValues();
  const area = shown && areaIn(shown.data, selection.value);
  if (!area) return null;
  const { data, difference } = shown;
  const channels = Array.from({ length: data.channels }, (_, c) => c);
  const figures = channels.map((c) => figuresOf(data, c, area));
  const finite = figures.filter((each) => each.finite > 0);
  const low = Math.min(...finite.map((each) => each.min));
  const high = Math.max(...finite.map((each) => each.max));
  const map = difference ? null : shownMap.value;
  // As the map's colours are.
  const isLog = map !== null && palettes[map.scale].length > 0 && shownOf(map).log;
  const step = map ? logStep(map) : 1;
  const place = (value: number): number => positionOf(value, { low, high }, isLog, step, "depth");
  const histograms = low <= high ? channels.map((c) => histogramOf(data, c, area, place, bins)) : [];
  return { figures, low, high, histograms };
}

/// Heights are roots of counts: seldom values are seen beside frequent ones.
function drawHistograms(canvas: HTMLCanvasElement, histograms: number[][]): void {
  const context = canvas.getContext("2d")!;
  const { width, height } = canvas;
  context.clearRect(0, 0, width, height);
  const most = Math.max(1, ...histograms.flat());
  const dark = theme.value === "dark";
  context.globalCompositeOperation = dark ? "lighter" : "multiply";
  const colors = dark ? ["#8c3028", "#286c3c", "#30528c"] : ["#ff9a8f", "#8fdc9f", "#8fb8ff"];
  histograms.forEach((histogram, c) => {
    context.fillStyle = histograms.length === 1 ? (dark ? "#8c97a5" : "#7c8794") : colors[c]!;
    histogram.forEach((counted, i) => {
      const tall = counted > 0 ? Math.max(1, Math.sqrt(counted / most) * height) : 0;
      context.fillRect((i * width) / bins, height - tall, width / bins, tall);
    });
  });
}

function HistogramView({ summary, text }: { summary: Summary; text: (value: number) => string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { low, high, histograms } = summary;
  const isDark = theme.value === "dark";
  useEffect(() => drawHistograms(canvas.current!, histograms), [histograms, isDark]);
  return (
    <figure class="histogram">
      <canvas
        ref={canvas}
        width={512}
        height={112}
        role="img"
        aria-label={`Histogram from ${text(low)} to ${text(high)}`}
      />
      <figcaption>
        <span>{text(low)}</span>
        <span>{text(high)}</span>
      </figcaption>
    </figure>
  );
}

function namesOf(map: MapEntry | null, channels: number): string[] {
  if (channels === 1) return [""];
  return map ? ["x", "y", "z"] : ["R", "G", "B"];
}

type Row = [title: string, of: (figures: Figures) => string];

function rowsFor(map: MapEntry | null, text: (value: number) => string): Row[] {
  const means: Row[] = [["mean", (f) => text(f.mean)]];
  const sums: Row[] = map?.scale === "count" ? [["sum", (f) => text(f.sum)]] : [];
  return [["min", (f) => text(f.min)], ["max", (f) => text(f.max)], ...means, ...sums];
}

function Oddities({ figures, isMap }: { figures: Figures[]; isMap: boolean }) {
  const most = (of: (f: Figures) => number): number => Math.max(0, ...figures.map(of));
  const parts = [
    [most((f) => f.nans), "NaN"],
    [most((f) => f.infinite), isMap ? "show nothing" : "infinite"],
    [most((f) => f.absent), "not there yet"],
  ] as const;
  const told = parts.filter(([pixels]) => pixels > 0).map(([pixels, words]) => `${count(pixels)} ${words}`);
  return told.length > 0 ? (
    <p class={most((f) => f.nans) > 0 ? "bad" : "quiet"}>Pixels: {told.join(", ")}</p>
  ) : null;
}

/// Figures of what is shown: of the selection, or of all.
export function ValuesPanel() {
  const map = shownMap.value;
  const data = useSteady(
    () => [shownStand(), selection.value, shownMap.value && shownOf(shownMap.value).log],
    summary,
  );
  const area = selection.value;
  const text = (value: number): string =>
    map?.unit === "seconds" && value >= 0 ? timeText(value) : plain(value, 4);
  if (map?.scale === "label") return null;
  const metric = shownMetric();
  const names = namesOf(map, data?.figures.length ?? 1);
  return (
    <Section
      title="Values"
      aside={[
        ...(metric ? [metricNames[metric]] : []),
        area ? `${area.width} × ${area.height} at ${area.x}, ${area.y}` : "whole picture",
      ].join(" · ")}
    >
      {metric === "flip" && <p class="quiet hint">ꟻLIP is shown in colours; its mean is told under Compare.</p>}
      {data && data.histograms.length > 0 && <HistogramView summary={data} text={text} />}
      {data && data.low <= data.high && (
        <table class="figures">
          {names.length > 1 && (
            <thead>
              <tr>
                <th />
                {names.map((name) => (
                  <th key={name} scope="col">
                    {name}
                  </th>
                ))}
              </tr>
            </thead>
          )}
          <tbody>
            {rowsFor(metric ? null : map, text).map(([title, of]) => (
              <tr key={title} data-figure={title}>
                <th scope="row">{title}</th>
                {data.figures.map((figures, c) => (
                  <td key={c}>{of(figures)}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      )}
      {data && <Oddities figures={data.figures} isMap={map !== null && metric === null} />}
      {area ? (
        <div class="buttons">
          <button title="Shift+A" onClick={() => (selection.value = null)}>
            Whole picture
          </button>
          <button title="The selected values as a table" disabled={!data} onClick={saveSelection}>
            Save CSV
          </button>
        </div>
      ) : (
        <p class="quiet hint">Shift+drag selects a rectangle.</p>
      )}
    </Section>
  );
}
