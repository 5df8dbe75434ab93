import type { Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { probed, selectedJob, tellError } from "../app/state";
import { many } from "../app/format";
import { alignWithPrimary, alignWithSelected, toggleKeepAligned } from "./align";
import { pose, reset, toggleOrthographic } from "./camera";
import { save, traceJson } from "./export";
import { filled, importanceAs, keepAligned, shown, type ImportanceAs } from "./options";
import { answer, asking, sampleChoice } from "./probe";
import { savePng, saveSvg } from "./RayCanvas";
import { rayCount, selected } from "./selection";
import type { Stroke } from "./segments";
import { outlierRule } from "./outliers";
import { outlierColor, styles } from "./strokes";

/// A piece of the line that stands for a kind of ray.
export function StrokeSample({ stroke, missed = false }: { stroke: Stroke; missed?: boolean }) {
  const { color, halo, dash, width } = styles[stroke];
  const shape = {
    x1: 1,
    y1: 5,
    x2: 19,
    y2: 5,
    "stroke-dasharray": dash ? dash.map((d) => d / 1.8).join(" ") : undefined,
  };
  return (
    <svg class="stroke-sample" width="20" height="10" aria-hidden="true" opacity={missed ? 0.55 : 1}>
      <line {...shape} stroke={halo} stroke-width={width + 1.5} stroke-opacity="0.5" />
      <line {...shape} stroke={color} stroke-width={width} />
    </svg>
  );
}

/// A camera ray in the glow of an outlier.
function OutlierSample() {
  return (
    <svg class="stroke-sample" width="20" height="10" aria-hidden="true">
      <line x1={1} y1={5} x2={19} y2={5} stroke={outlierColor} stroke-width={8} stroke-opacity="0.6" />
      <line x1={1} y1={5} x2={19} y2={5} stroke={styles.camera.color} stroke-width={2.5} />
    </svg>
  );
}

function Toggle({
  of,
  name,
  sample,
  title,
}: {
  of: Signal<boolean>;
  name: string;
  sample?: ComponentChildren;
  title: string;
}) {
  return (
    <button class="chip" aria-pressed={of.value} title={title} onClick={() => (of.value = !of.value)}>
      {sample}
      {name}
    </button>
  );
}

function SampleChoice() {
  const choice = sampleChoice.value;
  const last = (selectedJob.value?.settings.spp ?? 1) - 1;
  const kind = typeof choice === "number" ? "one" : choice;
  const set = (value: string) => (sampleChoice.value = value === "one" ? 0 : (value as "all" | "centre"));
  const setNumber = (value: number) => {
    if (Number.isInteger(value)) sampleChoice.value = Math.max(0, Math.min(last, value));
  };
  return (
    <label class="sample-choice">
      Sample{" "}
      <select value={kind} onChange={(event) => set(event.currentTarget.value)}>
        <option value="one">number</option>
        <option value="all">all of the pixel</option>
        <option value="centre">centre of the pixel</option>
      </select>
      {typeof choice === "number" && (
        <input
          type="number"
          aria-label="Number of the sample"
          min={0}
          max={last}
          value={choice}
          onInput={(event) => setNumber(event.currentTarget.valueAsNumber)}
        />
      )}
    </label>
  );
}

function Status() {
  const got = answer.value;
  const pixel = got?.question.pixel ?? probed.value;
  return (
    <span class="rays-status quiet" aria-live="polite">
      {pixel && (
        <>
          Pixel <b>{`${pixel.x}, ${pixel.y}`}</b>
        </>
      )}
      {got && ` · ${many(rayCount.value, "ray")} · ${Math.max(1, Math.round(got.milliseconds))} ms`}
      {asking.value && " …"}
    </span>
  );
}

function Exports() {
  const none = answer.value === null;
  return (
    <span class="group" role="group" aria-label="Save">
      <button onClick={() => void savePng().catch(tellError)} title="Save the 3D view as a picture">
        PNG
      </button>
      <button onClick={saveSvg} disabled={none} title="Save the rays as this view shows them, as a drawing">
        SVG
      </button>
      <button
        onClick={() => save(traceJson(), "json")}
        disabled={none}
        title="Save the trace as the master sent it"
      >
        JSON
      </button>
    </span>
  );
}

function View() {
  return (
    <span class="group" role="group" aria-label="View">
      <button
        onClick={alignWithPrimary}
        disabled={answer.value === null}
        title="Look along the primary ray from the eye (Shift+L)"
      >
        Align
      </button>
      <button
        aria-pressed={keepAligned.value}
        onClick={toggleKeepAligned}
        title="Keep looking along the primary ray while the pixel changes (L)"
      >
        Keep aligned
      </button>
      <button onClick={alignWithSelected} disabled={!selected.value} title="Look along the selected ray">
        Along ray
      </button>
      <button onClick={reset} title="See the whole scene (R)">
        Reset
      </button>
      <button
        aria-pressed={pose.value.orthographic}
        onClick={toggleOrthographic}
        title="Orthographic instead of perspective (O)"
      >
        Ortho
      </button>
    </span>
  );
}

export function Toolbar() {
  return (
    <div class="rays-toolbar">
      <SampleChoice />
      <Status />
      <View />
      <Exports />
      <div class="chips" role="group" aria-label="What is shown">
        <Toggle of={shown.camera} name="Camera" sample={<StrokeSample stroke="camera" />} title="Camera rays" />
        <Toggle of={shown.reflected} name="Reflected" sample={<StrokeSample stroke="reflected" />} title="Reflected rays" />
        <Toggle of={shown.refracted} name="Refracted" sample={<StrokeSample stroke="refracted" />} title="Refracted rays" />
        <Toggle
          of={shown.shadow}
          name="Shadow"
          sample={<StrokeSample stroke="shadow" />}
          title="Rays to the lights; dark behind what blocks them"
        />
        <Toggle
          of={shown.misses}
          name="Misses"
          title="Rays that hit nothing; they are cut around the scene"
        />
        <Toggle of={shown.normals} name="Normals" title="Surface normals where rays hit" />
        <Toggle
          of={shown.outliers}
          name="Outliers"
          sample={<OutlierSample />}
          title={`Among all samples of the pixel those that stand out: ${outlierRule}`}
        />
        <i />
        <Toggle of={shown.boxes} name="Boxes" title="Bounding boxes in the solids' colours, dashed where a solid is taken away (B)" />
        <Toggle of={filled} name="Filled" title="Boxes filled instead of wire" />
        <Toggle of={shown.preview} name="Solids" title="Each solid by itself, without the set operations" />
        <Toggle of={shown.cloud} name="Cloud" title="Point cloud of the visible surfaces (K)" />
        <Toggle of={shown.icons} name="Icons" title="The camera and the lights" />
        <Toggle of={shown.axes} name="Axes" title="The world's axes" />
        <i />
        <select
          aria-label="How a ray's importance is seen"
          value={importanceAs.value}
          onChange={(event) => (importanceAs.value = event.currentTarget.value as ImportanceAs)}
        >
          <option value="width">weak rays thin</option>
          <option value="opacity">weak rays faint</option>
          <option value="nothing">all rays alike</option>
        </select>
      </div>
    </div>
  );
}
