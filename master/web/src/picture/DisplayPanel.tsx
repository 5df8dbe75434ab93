import {
  adjust,
  display,
  gridShown,
  initialDisplay,
  shownMap,
  tones,
  valuesShown,
  type Display,
  type Tone,
} from "./display";
import { normalize, resetDisplay } from "./display_actions";
import { Section } from "./Section";

interface SliderProps {
  title: string;
  keys: string;
  name: "exposure" | "offset" | "gamma";
  min: number;
  max: number;
  step: number;
}

function Slider({ title, keys, name, min, max, step }: SliderProps) {
  const value = display.value[name];
  const set = (text: string): void => {
    if (text !== "" && Number.isFinite(Number(text))) adjust({ [name]: Number(text) } as Partial<Display>);
  };
  return (
    <div class="slider" title={`${title} (${keys} and Shift+${keys})`}>
      <label for={`display-${name}`}>{title}</label>
      <input
        type="range"
        aria-label={title}
        min={min}
        max={max}
        step={step}
        value={value}
        onInput={(event) => set(event.currentTarget.value)}
        onDblClick={() => adjust({ [name]: initialDisplay[name] })}
      />
      <input
        id={`display-${name}`}
        type="number"
        step={step}
        value={value}
        onChange={(event) => set(event.currentTarget.value)}
      />
    </div>
  );
}

function Check({
  title,
  hint,
  checked,
  set,
}: {
  title: string;
  hint: string;
  checked: boolean;
  set: (on: boolean) => void;
}) {
  return (
    <label class="check" title={hint}>
      <input type="checkbox" checked={checked} onChange={(event) => set(event.currentTarget.checked)} />
      {title}
    </label>
  );
}

/// How the picture's values become light. Maps have colours of their own.
export function DisplayPanel() {
  const isPicture = !shownMap.value;
  return (
    <Section title="Display">
      {isPicture && (
        <>
          <Slider title="Exposure" keys="E" name="exposure" min={-8} max={8} step={0.25} />
          <Slider title="Offset" keys="O" name="offset" min={-1} max={1} step={0.05} />
          <Slider title="Gamma" keys="G" name="gamma" min={0.4} max={4} step={0.1} />
          <div class="line">
            <label for="display-tone">Tone</label>
            <select
              id="display-tone"
              value={display.value.tone}
              onChange={(event) => adjust({ tone: event.currentTarget.value as Tone })}
            >
              {Object.entries(tones).map(([tone, title]) => (
                <option key={tone} value={tone}>
                  {title}
                </option>
              ))}
            </select>
          </div>
        </>
      )}
      <div class="checks">
        {isPicture && (
          <>
            <Check
              title="clip"
              hint="To 0 to 1 before the tone curve (U)"
              checked={display.value.clip}
              set={(clip) => adjust({ clip })}
            />
            <Check
              title="zebra"
              hint="Stripes where values are outside 0 to 1 (Z)"
              checked={display.value.zebra}
              set={(zebra) => adjust({ zebra })}
            />
          </>
        )}
        <Check
          title="values"
          hint="Printed in large pixels (P)"
          checked={valuesShown.value}
          set={(on) => (valuesShown.value = on)}
        />
        <Check
          title="grid"
          hint="Between large pixels (Shift+P)"
          checked={gridShown.value}
          set={(on) => (gridShown.value = on)}
        />
      </div>
      {isPicture && (
        <div class="buttons">
          <button title="Lowest value dark, highest bright (N)" onClick={normalize}>
            Normalise
          </button>
          <button title="Shift+R" onClick={resetDisplay}>
            Reset
          </button>
        </div>
      )}
    </Section>
  );
}
