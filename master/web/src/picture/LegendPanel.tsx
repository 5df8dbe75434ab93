import { useEffect, useRef } from "preact/hooks";
import { currentEntry } from "./compare";
import { adjustMap, resetMap, shownMap, shownOf } from "./display";
import { rangeOf } from "./figures";
import { fieldText, fieldUnit, plain, timeText } from "./format";
import { LabelLegend } from "./LabelLegend";
import { paletteOf } from "./look";
import { MapChoices } from "./MapChoices";
import { normalColor, palettes, tableOf, type Palette } from "./palettes";
import { logStep, positionOf, ticksOf, type Range, type RangeMode, type Shown } from "./range";
import { Section } from "./Section";
import type { MapEntry } from "../app/types";

const barEntries = 256;

function Bar({ palette }: { palette: Palette }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const image = new ImageData(new Uint8ClampedArray(tableOf(palette, barEntries)), barEntries, 1);
    canvas.current!.getContext("2d")!.putImageData(image, 0, 0);
  }, [palette]);
  return <canvas class="legend-bar" ref={canvas} width={barEntries} height={1} aria-hidden="true" />;
}

function Ticks({ map, range, shown }: { map: MapEntry; range: Range; shown: Shown }) {
  const step = logStep(map);
  const text = (value: number): string => (map.unit === "seconds" ? timeText(value) : plain(value, 3));
  const ticks = ticksOf(range, shown.log, step, map.unit === "seconds" ? 3 : 5);
  return (
    <div class="legend-ticks" aria-hidden="true">
      {ticks.map((value) => {
        const at = positionOf(value, range, shown.log, step, map.scale) * 100;
        const edge = at < 8 ? "first" : at > 92 ? "last" : "";
        return (
          <span key={value} class={edge} style={{ left: `${at}%` }}>
            {text(value)}
          </span>
        );
      })}
    </div>
  );
}

/// The colours of all normals that a camera can see, as on a ball.
function NormalBall() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const side = 96;
    const image = new ImageData(side, side);
    for (let y = 0; y < side; ++y)
      for (let x = 0; x < side; ++x) {
        const nx = (2 * (x + 0.5)) / side - 1;
        const ny = 1 - (2 * (y + 0.5)) / side;
        const rest = 1 - nx * nx - ny * ny;
        if (rest >= 0) image.data.set([...normalColor([nx, ny, -Math.sqrt(rest)]), 255], 4 * (y * side + x));
      }
    canvas.current!.getContext("2d")!.putImageData(image, 0, 0);
  }, []);
  return (
    <div class="normal-ball">
      <canvas ref={canvas} width={96} height={96} role="img" aria-label="Colours of normals on a ball" />
      <p class="quiet">
        red: x, rightwards
        <br />
        green: y, upwards
        <br />
        blue: −z, to the usual camera
      </p>
    </div>
  );
}

const modes: Record<RangeMode, string> = { auto: "all values", percentile: "1 % to 99 %", fixed: "fixed" };

function RangeChoice({ map, range, shown }: { map: MapEntry; range: Range; shown: Shown }) {
  const unit = fieldUnit(map.unit, range.high);
  const set = (end: "low" | "high", text: string): void => {
    if (text !== "" && Number.isFinite(Number(text)))
      adjustMap(map, { ...range, mode: "fixed", [end]: Number(text) * unit.size });
  };
  return (
    <>
      <div class="line">
        <label for="map-range">Range</label>
        <select
          id="map-range"
          value={shown.mode}
          onChange={(event) => adjustMap(map, { ...range, mode: event.currentTarget.value as RangeMode })}
        >
          {Object.entries(modes).map(([mode, title]) => (
            <option key={mode} value={mode}>
              {title}
            </option>
          ))}
        </select>
      </div>
      <div class="line range-ends">
        <input
          type="number"
          step="any"
          aria-label={`Lowest value ${unit.name}`.trim()}
          value={fieldText(range.low / unit.size)}
          onChange={(event) => set("low", event.currentTarget.value)}
        />
        <span class="quiet">to</span>
        <input
          type="number"
          step="any"
          aria-label={`Highest value ${unit.name}`.trim()}
          value={fieldText(range.high / unit.size)}
          onChange={(event) => set("high", event.currentTarget.value)}
        />
        {unit.name && <span class="quiet">{unit.name}</span>}
      </div>
    </>
  );
}

function ScaleChoices({ map, shown }: { map: MapEntry; shown: Shown }) {
  return (
    <div class="line">
      <label for="map-palette">Colours</label>
      <select
        id="map-palette"
        value={shown.palette}
        onChange={(event) => adjustMap(map, { palette: Number(event.currentTarget.value) })}
      >
        {palettes[map.scale].map((palette, i) => (
          <option key={palette.name} value={i}>
            {palette.name}
          </option>
        ))}
      </select>
      <label class="check" title="Shift+C">
        <input
          type="checkbox"
          checked={shown.log}
          onChange={(event) => adjustMap(map, { log: event.currentTarget.checked })}
        />
        log
      </label>
    </div>
  );
}

/// What the colours of a map mean, and which they are.
export function LegendPanel() {
  const map = shownMap.value;
  const entry = currentEntry.value;
  if (!map || !entry) return null;
  const shown = shownOf(map);
  const palette = paletteOf(map, shown);
  const range = rangeOf(entry, map, shown);
  const isKnown = shown.mode === "fixed" || (entry.message.value?.range ?? null) !== null;
  return (
    <Section title="Legend" aside={map.channels === 1 && map.unit}>
      <p class="quiet hint">{map.help}</p>
      <MapChoices map={map} />
      {map.scale === "normal" && <NormalBall />}
      {map.scale === "label" && <LabelLegend entry={entry} />}
      {palette && (
        <>
          <div
            class="legend"
            role="img"
            aria-label={isKnown ? `Colours from ${plain(range.low)} to ${plain(range.high)} ${map.unit}` : "Colours"}
          >
            <Bar palette={palette} />
            {isKnown && <Ticks map={map} range={range} shown={shown} />}
          </div>
          <ScaleChoices map={map} shown={shown} />
          {isKnown && <RangeChoice map={map} range={range} shown={shown} />}
          <div class="buttons">
            <button title="Shift+R" onClick={() => resetMap(map)}>
              Reset
            </button>
          </div>
        </>
      )}
    </Section>
  );
}
