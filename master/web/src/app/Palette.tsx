import { computed, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { actions } from "./actions";
import { Dialog } from "./Dialog";
import { filter } from "./fuzzy";
import { Keys } from "./Help";
import { openJob, page } from "./route";
import { jobs, layer, maps } from "./state";
import "./palette.css";

interface Entry {
  id: string;
  kind: string;
  title: string;
  key: string | undefined;
  run: () => void;
}

export const paletteShown = signal(false);
const query = signal("");
const place = signal(0);
const most = 60; // entries shown: more would be scrolled, not read

function layerEntry(name: string, title: string): Entry {
  const run = () => {
    layer.value = { ...layer.value, layer: name };
    page.value = "jobs";
  };
  return { id: `layer ${name}`, kind: "Layer", title: `Show ${title}`, key: undefined, run };
}

const entries = computed<Entry[]>(() => [
  ...actions.value
    .filter((action) => action.id !== "palette" && (action.enabled?.() ?? true))
    .map((action) => ({
      id: action.id,
      kind: action.group,
      title: action.title,
      key: action.keys[0],
      run: action.run,
    })),
  layerEntry("picture", "the picture"),
  ...maps.value.map((map) => layerEntry(map.name, `map: ${map.title}`)),
  ...[...jobs.value].reverse().map((job) => ({
    id: `job ${job.id}`,
    kind: "Job",
    title: `${job.id} ${job.name} (${job.state})`,
    key: undefined,
    run: () => openJob(job.id),
  })),
]);
const found = computed(() => filter(query.value, entries.value, (entry) => entry.title).slice(0, most));

export function openPalette(): void {
  query.value = "";
  place.value = 0;
  paletteShown.value = true;
}

/// Everything by its name.
export function Palette() {
  return paletteShown.value ? <OpenPalette /> : null;
}

function OpenPalette() {
  const list = useRef<HTMLUListElement>(null);
  const close = () => (paletteShown.value = false);
  const chosen = Math.min(place.value, found.value.length - 1);
  useEffect(
    () => list.current?.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" }),
    [chosen, query.value],
  );

  function run(entry: Entry | undefined) {
    if (!entry) return;
    close();
    // After the dialog gave the focus back: what runs may move it.
    queueMicrotask(() => requestAnimationFrame(entry.run));
  }
  function key(event: KeyboardEvent) {
    const count = found.value.length;
    if (event.key === "Enter") run(found.value[chosen]?.entry);
    else if (event.key === "ArrowDown" && count > 0) place.value = (chosen + 1) % count;
    else if (event.key === "ArrowUp" && count > 0) place.value = (chosen + count - 1) % count;
    else return;
    event.preventDefault();
  }

  return (
    <Dialog label="Find an action, a layer or a job" class="palette" close={close}>
      <input
        type="text"
        placeholder="Action, layer or job"
        role="combobox"
        aria-label="Action, layer or job"
        aria-expanded="true"
        aria-controls="palette-list"
        aria-activedescendant={found.value.length > 0 ? `palette-${chosen}` : undefined}
        autocomplete="off"
        spellcheck={false}
        autofocus
        onInput={(event) => {
          query.value = event.currentTarget.value;
          place.value = 0;
        }}
        onKeyDown={key}
      />
      <ul id="palette-list" role="listbox" aria-label="Found" ref={list}>
        {found.value.map(({ entry, match }, index) => (
          <li
            key={entry.id}
            id={`palette-${index}`}
            role="option"
            aria-selected={index === chosen}
            onClick={() => run(entry)}
          >
            <span class="quiet">{entry.kind}</span>
            <span>{marked(entry.title, match.places)}</span>
            {entry.key && <Keys keys={entry.key} />}
          </li>
        ))}
      </ul>
      {found.value.length === 0 && <p class="quiet">Nothing is called that.</p>}
    </Dialog>
  );
}

const marked = (title: string, places: number[]) =>
  [...title].map((letter, index) => (places.includes(index) ? <b key={index}>{letter}</b> : letter));
