import { layer, maps } from "../app/state";
import { currentEntry } from "./compare";
import { shownMap } from "./display";
import { results, step } from "./history";
import { chooseLayer } from "./display_actions";
import { FrameBar } from "./FrameBar";
import { save } from "./save";

function Tab({ name, title, help }: { name: string; title: string; help: string }) {
  const chosen = layer.value.layer === name;
  const move = (event: KeyboardEvent): void => {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (by === 0) return;
    event.preventDefault();
    const tabs = [...(event.currentTarget as HTMLElement).parentElement!.querySelectorAll("button")];
    const next =
      tabs[(tabs.indexOf(event.currentTarget as HTMLButtonElement) + by + tabs.length) % tabs.length]!;
    next.click();
    next.focus();
  };
  return (
    <button
      class="plain"
      role="tab"
      aria-selected={chosen}
      aria-controls="picture-canvas"
      tabIndex={chosen ? 0 : -1}
      title={help}
      data-layer={name}
      onClick={() => chooseLayer(name)}
      onKeyDown={move}
    >
      {title}
    </button>
  );
}

function HistorySteps() {
  const at = results.value.findIndex((job) => job.id === currentEntry.value?.watch.job);
  return (
    <span class="group" role="group" aria-label="History">
      <button
        class="plain"
        aria-label="Previous result"
        title="Previous result of the scene (A)"
        disabled={at < 0 || at + 1 >= results.value.length}
        onClick={() => step(1)}
      >
        «
      </button>
      <span class="history-place" title="Place in the history, newest first">
        {at < 0 ? "–" : `${at + 1}/${results.value.length}`}
      </span>
      <button
        class="plain"
        aria-label="Next result"
        title="Next result of the scene (D)"
        disabled={at <= 0}
        onClick={() => step(-1)}
      >
        »
      </button>
    </span>
  );
}

function SaveTools() {
  const map = shownMap.value;
  const what = map ? map.title : "Picture";
  return (
    <span class="group" role="group" aria-label="Save">
      <button class="plain" title={`${what} in its colours: save as PNG`} onClick={() => save("png")}>
        PNG
      </button>
      <button class="plain" title={`${what}: save the numbers as EXR`} onClick={() => save("exr")}>
        EXR
      </button>
      {map && (
        <button
          class="plain"
          title={`${what}: save the numbers as a table, one line an image row`}
          onClick={() => save("csv")}
        >
          CSV
        </button>
      )}
    </span>
  );
}

export function LayerBar() {
  return (
    <div class="layer-bar">
      <div role="tablist" aria-label="Layers">
        <Tab name="picture" title="Picture" help="The picture itself" />
        {maps.value.map((map) => (
          <Tab key={map.name} name={map.name} title={map.title} help={map.help} />
        ))}
      </div>
      <div class="layer-tools">
        <FrameBar />
        <HistorySteps />
        <SaveTools />
      </div>
    </div>
  );
}
