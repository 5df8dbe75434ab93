import { useEffect, useState } from "preact/hooks";
import { jobs, link } from "../app/state";
import type { SceneEntry } from "../app/types";
import { change, checked, faults, form, loadScenes, scenes, scenesFault, takeFile } from "./draft";
import type { Source } from "./submission";

/// Where the scene comes from.
export function SceneChoice() {
  const { source, job } = form.value;
  const sources: [Source, string][] = [
    ["farm", "The master's scenes"],
    ["script", "A script of mine"],
    ...(job === null ? [] : ([["job", `As job ${job}`]] as [Source, string][])),
  ];
  return (
    <section aria-label="Scene">
      <h2>Scene</h2>
      <div class="choice" role="radiogroup" aria-label="Where the scene comes from">
        {sources.map(([value, title]) => (
          <label key={value} class={value === source ? "chosen" : undefined}>
            <input
              type="radio"
              name="source"
              checked={value === source}
              onChange={() => change({ source: value })}
            />
            {title}
          </label>
        ))}
      </div>
      {source === "farm" && <SceneList />}
      {source === "script" && <Script />}
      {source === "job" && <SceneOfJob />}
    </section>
  );
}

function SceneList() {
  const open = link.value === "open";
  useEffect(() => {
    if (open) void loadScenes(); // also of a master that was started anew
  }, [open]);
  if (scenesFault.value)
    return (
      <p class="bad" role="alert">
        {scenesFault.value} <button onClick={() => void loadScenes()}>Try again</button>
      </p>
    );
  if (scenes.value?.length === 0)
    return <p class="quiet">The master has no scenes installed; bring a script.</p>;
  return (
    <div class="scenes" role="radiogroup" aria-label="Scenes">
      {scenes.value?.map((entry) => (
        <SceneRow key={entry.name} entry={entry} />
      ))}
    </div>
  );
}

function SceneRow({ entry }: { entry: SceneEntry }) {
  const chosen = form.value.scene === entry.name;
  return (
    <label class={chosen ? "chosen" : undefined}>
      <input
        type="radio"
        name="scene"
        checked={chosen}
        disabled={entry.error !== undefined}
        onChange={() => change({ scene: entry.name, parameters: {} })}
      />
      <span>{entry.name}</span>
      <span class={entry.error ? "bad" : "quiet"}>{entry.error ?? entry.title}</span>
    </label>
  );
}

function Script() {
  const [over, setOver] = useState(false);
  const { script } = form.value;
  const take = (files: FileList | null | undefined) => {
    if (files?.[0]) void takeFile(files[0]);
  };
  return (
    <div
      class={over ? "script over" : "script"}
      onDragOver={(event) => {
        event.preventDefault();
        setOver(true);
      }}
      onDragLeave={() => setOver(false)}
      onDrop={(event) => {
        event.preventDefault();
        setOver(false);
        take(event.dataTransfer?.files);
      }}
    >
      <div class="file">
        <label class="button">
          Choose a .lua file
          <input
            type="file"
            accept=".lua"
            class="out-of-sight"
            onChange={(event) => {
              take(event.currentTarget.files);
              event.currentTarget.value = "";
            }}
          />
        </label>
        <span class="quiet">{script.name || "or drop one here, or paste its text:"}</span>
      </div>
      <textarea
        aria-label="Script"
        rows={12}
        spellcheck={false}
        value={script.text}
        aria-invalid={checked.value && "fault" in checked.value ? "true" : undefined}
        onInput={(event) => change({ script: { ...script, text: event.currentTarget.value } })}
      />
      <ScriptState />
    </div>
  );
}

function ScriptState() {
  const result = checked.value;
  if (faults.value.source) return null;
  if (!result) return <p class="quiet">The master reads the script …</p>;
  if ("fault" in result)
    return (
      <p class="bad" role="alert">
        {result.fault}
      </p>
    );
  return <p class="quiet">The script can be rendered.</p>;
}

function SceneOfJob() {
  const job = jobs.value.find((one) => one.id === form.value.job);
  const parameters = Object.entries(job?.parameters ?? {});
  return (
    <p class="quiet">
      The very scene of {job ? `${job.name} (job ${job.id})` : `job ${form.value.job}`}
      {parameters.length > 0 &&
        `, with ${parameters.map(([name, value]) => `${name} = ${value}`).join(", ")}`}
      . To change its parameters or its frame, choose the scene or its script.
    </p>
  );
}
