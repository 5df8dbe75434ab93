// Layers, and how their values become colours.
import type { Action } from "../app/actions";
import { layer, maps } from "../app/state";
import { act } from "./action";
import { currentEntry } from "./compare";
import * as shown from "./display";
import { adjust, adjustMap, display, shownMap, shownOf } from "./display";
import { palettes } from "./palettes";
import { areaIn, selection } from "./selection";
import { figuresOf } from "./statistics";

export function chooseLayer(name: string): void {
  layer.value = { ...layer.peek(), layer: name };
}

function stepLayer(by: number): void {
  const names = ["picture", ...maps.peek().map((map) => map.name)];
  chooseLayer(names[(names.indexOf(layer.peek().layer) + by + names.length) % names.length]!);
}

/// The values of the picture, or of the selection, from 0 to 1; the range of a map, its own.
export function normalize(): void {
  const map = shownMap.peek();
  const data = currentEntry.peek()?.data;
  const area = data && areaIn(data, selection.peek());
  if (map) adjustMap(map, { mode: "auto" });
  if (map || !data || !area) return;
  const figures = [0, 1, 2].map((c) => figuresOf(data, c, area));
  const low = Math.min(...figures.map((each) => each.min));
  const span = Math.max(...figures.map((each) => each.max)) - low;
  if (span > 0) adjust({ exposure: -Math.log2(span), offset: -low / span });
}

export function resetDisplay(): void {
  display.value = shown.initialDisplay;
  if (shownMap.peek()) shown.resetMap(shownMap.peek()!);
}

function nextColors(): void {
  const map = shownMap.peek()!;
  adjustMap(map, { palette: (shownOf(map).palette + 1) % palettes[map.scale].length });
}
const toggleLog = (): void => adjustMap(shownMap.peek()!, { log: !shownOf(shownMap.peek()!).log });
const hasColors = (): boolean => shownMap.peek() !== null && palettes[shownMap.peek()!.scale].length > 0;

const change = (name: "exposure" | "offset" | "gamma", by: number) => (): void =>
  adjust({ [name]: display.peek()[name] + by });
const toggle = (name: "clip" | "zebra") => (): void => adjust({ [name]: !display.peek()[name] });

export const displayActions: Action[] = [
  act("exposure-up", "Brighter by half a stop", ["E"], change("exposure", 0.5)),
  act("exposure-down", "Darker by half a stop", ["Shift+E"], change("exposure", -0.5)),
  act("offset-up", "Offset up", ["O"], change("offset", 0.1)),
  act("offset-down", "Offset down", ["Shift+O"], change("offset", -0.1)),
  act("gamma-up", "Gamma up", ["G"], change("gamma", 0.1)),
  act("gamma-down", "Gamma down", ["Shift+G"], change("gamma", -0.1)),
  act("tone", "Next tone curve", ["T"], shown.nextTone),
  act("normalize", "Normalise: lowest value dark, highest bright", ["N"], normalize),
  act("clip", "Clip to the range of a screen", ["U"], toggle("clip")),
  act("zebra", "Stripes where it is clipped", ["Z"], toggle("zebra")),
  act("values", "Values in large pixels", ["P"], () => (shown.valuesShown.value = !shown.valuesShown.peek())),
  act(
    "grid",
    "Grid between large pixels",
    ["Shift+P"],
    () => (shown.gridShown.value = !shown.gridShown.peek()),
  ),
  act("display-reset", "Reset exposure, tone and colours", ["Shift+R"], resetDisplay),
  act("select-all", "Select all of the picture", ["Shift+A"], () => (selection.value = null)),
];

const onLayers = (action: Action): Action => ({ ...action, group: "Layers" });
export const layerActions: Action[] = [
  act("layer-next", "Next layer", ["]", "ArrowRight"], () => stepLayer(1)),
  act("layer-previous", "Previous layer", ["[", "ArrowLeft"], () => stepLayer(-1)),
  act("colors", "Next colours of the map", ["C"], nextColors, hasColors),
  act("log", "Logarithmic or linear colours of the map", ["Shift+C"], toggleLog, hasColors),
].map(onLayers);
