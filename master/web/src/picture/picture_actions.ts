// What keys and the palette do with the picture.
import { register, type Action } from "../app/actions";
import { layer, maps, probed, type Pixel } from "../app/state";
import { choose, results, step } from "./history";
import { currentEntry, nextMetric, setReference, shiftHeld, toggleComparison, toggleFlip } from "./compare";
import { adjust, adjustMap, display, gridShown, initialDisplay, nextTone, resetMap, shownMap, shownOf, valuesShown } from "./display";
import { figuresOf } from "./statistics";
import { palettes } from "./palettes";
import { bigZoomStep, zoomStep } from "./gestures";
import { canvasId } from "./PictureCanvas";
import { areaIn, selection } from "./selection";
import { cursor, fit, panBy, pictureSize, pixelUnder, reveal, screen, zoomBy, zoomTo } from "./view_state";

const layerNames = (): string[] => ["picture", ...maps.peek().map((map) => map.name)];

export function chooseLayer(name: string): void {
  layer.value = { ...layer.peek(), layer: name };
}

function stepLayer(by: number): void {
  const names = layerNames();
  chooseLayer(names[(names.indexOf(layer.peek().layer) + by + names.length) % names.length]!);
}

/// The values of the picture, or of the selection, from 0 to 1; the range of a map, its own.
export function normalize(): void {
  const map = shownMap.peek();
  const data = currentEntry.peek()?.data;
  if (map) {
    adjustMap(map, { mode: "auto" });
    return;
  }
  const area = data && areaIn(data, selection.peek());
  if (!data || !area) return;
  const figures = [0, 1, 2].map((c) => figuresOf(data, c, area));
  const low = Math.min(...figures.map((each) => each.min));
  const span = Math.max(...figures.map((each) => each.max)) - low;
  if (span > 0) adjust({ exposure: -Math.log2(span), offset: -low / span });
}

export function resetDisplay(): void {
  display.value = initialDisplay;
  if (shownMap.peek()) resetMap(shownMap.peek()!);
}

function nextColors(): void {
  const map = shownMap.peek();
  if (map && palettes[map.scale].length > 0)
    adjustMap(map, { palette: (shownOf(map).palette + 1) % palettes[map.scale].length });
}

const onCanvas = (): boolean => document.activeElement?.id === canvasId;

/// Where keys begin to move the cursor: the last probe, or the middle of the screen.
function cursorStart(): Pixel | null {
  const { width, height } = screen.peek();
  return cursor.peek() ?? probed.peek() ?? pixelUnder({ x: width / 2, y: height / 2 });
}

function moveCursor(x: number, y: number): void {
  const size = pictureSize.peek();
  if (!size) return;
  const from = cursorStart() ?? { x: size.width >> 1, y: size.height >> 1 };
  const within = (value: number, side: number): number => Math.min(Math.max(value, 0), side - 1);
  cursor.value = { x: within(from.x + x, size.width), y: within(from.y + y, size.height) };
  reveal(cursor.value);
}

const arrows = { Left: [-1, 0], Right: [1, 0], Up: [0, -1], Down: [0, 1] } as const;

const arrowActions: Action[] = Object.entries(arrows).flatMap(([name, [x, y]]): Action[] => {
  const words = name.toLowerCase();
  const id = `picture-${words}`;
  const pan = (): void => panBy({ x: (-x * screen.peek().width) / 8, y: (-y * screen.peek().height) / 8 });
  return [
    { id: `${id}-cursor`, title: `Cursor ${words}`, group: "Picture", keys: [`Arrow${name}`], enabled: onCanvas, run: () => moveCursor(x, y) },
    { id: `${id}-far`, title: `Cursor 10 pixels ${words}`, group: "Picture", keys: [`Shift+Arrow${name}`], enabled: onCanvas, run: () => moveCursor(10 * x, 10 * y) },
    { id: `${id}-pan`, title: `Look further ${words}`, group: "Picture", keys: [`Alt+Arrow${name}`], run: pan },
  ];
});

const viewActions: Action[] = [
  { id: "zoom-in", title: "Zoom in", group: "Picture", keys: ["+", "=", "PageUp"], run: () => zoomBy(zoomStep) },
  { id: "zoom-out", title: "Zoom out", group: "Picture", keys: ["-", "PageDown"], run: () => zoomBy(1 / zoomStep) },
  { id: "zoom-in-far", title: "Zoom in, large step", group: "Picture", keys: ["Shift+PageUp"], run: () => zoomBy(bigZoomStep) },
  { id: "zoom-out-far", title: "Zoom out, large step", group: "Picture", keys: ["Shift+PageDown"], run: () => zoomBy(1 / bigZoomStep) },
  { id: "zoom-full", title: "Zoom to 100 %", group: "Picture", keys: ["0"], run: () => zoomTo(1) },
  { id: "zoom-fit", title: "Fit the picture into the window", group: "Picture", keys: ["F"], run: fit },
  {
    id: "view-reset",
    title: "Reset the view: all of the picture, nothing selected or probed",
    group: "Picture",
    keys: ["R"],
    run: () => {
      fit();
      selection.value = cursor.value = probed.value = null;
    },
  },
  {
    id: "probe",
    title: "Probe the pixel under the cursor",
    group: "Picture",
    keys: ["Enter"],
    enabled: onCanvas,
    run: () => (probed.value = cursorStart()),
  },
  {
    id: "focus-picture",
    title: "Go to the picture, to probe with the arrow keys",
    group: "Picture",
    keys: ["I"],
    run: () => document.getElementById(canvasId)?.focus(),
  },
];

const displayActions: Action[] = [
  { id: "exposure-up", title: "Brighter by half a stop", group: "Picture", keys: ["E"], run: () => adjust({ exposure: display.peek().exposure + 0.5 }) },
  { id: "exposure-down", title: "Darker by half a stop", group: "Picture", keys: ["Shift+E"], run: () => adjust({ exposure: display.peek().exposure - 0.5 }) },
  { id: "offset-up", title: "Offset up", group: "Picture", keys: ["O"], run: () => adjust({ offset: display.peek().offset + 0.1 }) },
  { id: "offset-down", title: "Offset down", group: "Picture", keys: ["Shift+O"], run: () => adjust({ offset: display.peek().offset - 0.1 }) },
  { id: "gamma-up", title: "Gamma up", group: "Picture", keys: ["G"], run: () => adjust({ gamma: display.peek().gamma + 0.1 }) },
  { id: "gamma-down", title: "Gamma down", group: "Picture", keys: ["Shift+G"], run: () => adjust({ gamma: display.peek().gamma - 0.1 }) },
  { id: "tone", title: "Next tone curve", group: "Picture", keys: ["T"], run: nextTone },
  { id: "normalize", title: "Normalise: lowest value dark, highest bright", group: "Picture", keys: ["N"], run: normalize },
  { id: "clip", title: "Clip to the range of a screen", group: "Picture", keys: ["U"], run: () => adjust({ clip: !display.peek().clip }) },
  { id: "zebra", title: "Stripes where it is clipped", group: "Picture", keys: ["Z"], run: () => adjust({ zebra: !display.peek().zebra }) },
  { id: "values", title: "Values in large pixels", group: "Picture", keys: ["P"], run: () => (valuesShown.value = !valuesShown.peek()) },
  { id: "grid", title: "Grid between large pixels", group: "Picture", keys: ["Shift+P"], run: () => (gridShown.value = !gridShown.peek()) },
  { id: "display-reset", title: "Reset exposure, tone and colours", group: "Picture", keys: ["Shift+R"], run: resetDisplay },
  {
    id: "select-all",
    title: "Select all of the picture",
    group: "Picture",
    keys: ["Shift+A"],
    enabled: () => selection.peek() !== null,
    run: () => (selection.value = null),
  },
];

const layerActions: Action[] = [
  { id: "layer-next", title: "Next layer", group: "Layers", keys: ["]"], run: () => stepLayer(1) },
  { id: "layer-previous", title: "Previous layer", group: "Layers", keys: ["["], run: () => stepLayer(-1) },
  { id: "colors", title: "Next colours of the map", group: "Layers", keys: ["C"], enabled: () => shownMap.peek() !== null, run: nextColors },
  {
    id: "log",
    title: "Logarithmic or linear colours of the map",
    group: "Layers",
    keys: ["Shift+C"],
    enabled: () => shownMap.peek() !== null,
    run: () => adjustMap(shownMap.peek()!, { log: !shownOf(shownMap.peek()!).log }),
  },
];

const slots = [1, 2, 3, 4, 5];
const hasSlot = (slot: number) => (): boolean => results.peek().length >= slot;
const compareActions: Action[] = [
  { id: "older", title: "Previous result of the scene", group: "Picture", keys: ["A"], run: () => step(1) },
  { id: "newer", title: "Next result of the scene", group: "Picture", keys: ["D"], run: () => step(-1) },
  { id: "flip", title: "Flip between the result and the reference (hold Shift to look only)", group: "Picture", keys: ["Space"], run: toggleFlip },
  { id: "wipe", title: "Compare with a wipe", group: "Picture", keys: ["W"], run: () => toggleComparison("wipe") },
  { id: "metric", title: "Difference to the reference, next metric", group: "Picture", keys: ["X"], run: nextMetric },
  { id: "no-reference", title: "Compare with nothing", group: "Picture", keys: ["Shift+X"], run: () => setReference(null) },
  ...slots.map((slot): Action => ({
    id: `slot-${slot}`,
    title: slot === 1 ? "Show the newest result" : `Show result ${slot} of the history`,
    group: "Picture",
    keys: [String(slot)],
    enabled: hasSlot(slot),
    run: () => choose(slot),
  })),
  ...slots.map((slot): Action => ({
    id: `reference-${slot}`,
    title: `Compare with result ${slot} of the history`,
    group: "Picture",
    keys: [`Shift+${slot}`],
    enabled: hasSlot(slot),
    run: () => setReference(results.peek()[slot - 1]?.id ?? null),
  })),
];

/// While Shift alone is held the reference is shown.
function followShift(): () => void {
  const stop = new AbortController();
  const listen = (type: "keydown" | "keyup", held: boolean): void =>
    addEventListener(type, (event) => event.key === "Shift" && (shiftHeld.value = held), { signal: stop.signal });
  listen("keydown", true);
  listen("keyup", false);
  addEventListener("blur", () => (shiftHeld.value = false), { signal: stop.signal });
  return () => stop.abort();
}

export function registerPicture(): () => void {
  const stops = [
    register([...viewActions, ...displayActions, ...layerActions, ...compareActions, ...arrowActions]),
    followShift(),
  ];
  return () => stops.forEach((stop) => stop());
}
