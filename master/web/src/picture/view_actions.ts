// Zoom, pan, and the cursor that probes without a pointer.
import type { Action } from "../app/actions";
import { probe, probed, type Pixel } from "../app/state";
import { act, gesture } from "./action";
import { bigZoomStep, zoomStep } from "./gestures";
import { selection } from "./selection";
import {
  canvasId,
  cursor,
  fit,
  panBy,
  pictureSize,
  pixelUnder,
  reveal,
  screen,
  zoomBy,
  zoomTo,
} from "./view_state";

/// The key counts while the picture itself has the focus.
const withFocus = (id: string, title: string, key: string, run: () => void): Action => ({
  ...act(id, title, [key], run, () => document.activeElement?.id === canvasId),
  scope: "picture",
});

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

function reset(): void {
  fit();
  selection.value = cursor.value = null;
  probe(null);
}

const directions = { Left: [-1, 0], Right: [1, 0], Up: [0, -1], Down: [0, 1] } as const;
const farther = 10; // pixels with Shift
const panShare = 1 / 8; // of the screen

const arrowActions = Object.entries(directions).flatMap(([name, [x, y]]): Action[] => {
  const [id, word] = [`picture-${name.toLowerCase()}`, name.toLowerCase()];
  const far = (): void => moveCursor(farther * x, farther * y);
  const pan = (): void => {
    const { width, height } = screen.peek();
    panBy({ x: -x * width * panShare, y: -y * height * panShare });
  };
  return [
    {
      ...withFocus(`${id}-cursor`, `Cursor ${word}`, `Arrow${name}`, () => moveCursor(x, y)),
      family: "Move the cursor",
    },
    {
      ...withFocus(`${id}-far`, `Cursor ${farther} pixels ${word}`, `Shift+Arrow${name}`, far),
      family: `Move the cursor ${farther} pixels`,
    },
    { ...act(`${id}-pan`, `Look further ${word}`, [`Alt+Arrow${name}`], pan), family: "Look further" },
  ];
});

const gestures: Action[] = [
  gesture("zoom", "Zoom at the pointer; with Shift in large steps", ["Wheel", "Shift+Wheel", "Pinch"]),
  gesture("pan", "Pan", ["Drag", "Middle drag"]),
  gesture("fit", "All of the picture, or 100 % at the pointer", ["Double click"]),
  gesture("probe", "Probe the pixel", ["Click"]),
  gesture("scrub", "Probe the pixels along the way", ["Ctrl+Drag", "Right drag"]),
  gesture("select", "Select a rectangle", ["Shift+Drag"]),
  gesture("flip", "Show the reference", ["Shift+hold"]),
];

export const viewActions: Action[] = [
  ...gestures,
  act("zoom-in", "Zoom in", ["+", "=", "PageUp"], () => zoomBy(zoomStep)),
  act("zoom-out", "Zoom out", ["-", "PageDown"], () => zoomBy(1 / zoomStep)),
  act("zoom-in-far", "Zoom in, large step", ["Shift+PageUp"], () => zoomBy(bigZoomStep)),
  act("zoom-out-far", "Zoom out, large step", ["Shift+PageDown"], () => zoomBy(1 / bigZoomStep)),
  act("zoom-full", "Zoom to 100 %", ["0"], () => zoomTo(1)),
  act("zoom-fit", "Fit the picture into the window", ["F"], fit),
  act("view-reset", "Reset the view: all of the picture, nothing selected or probed", ["R"], reset),
  act("focus-picture", "Go to the picture, to probe with the arrow keys", ["I"], () =>
    document.getElementById(canvasId)?.focus(),
  ),
  withFocus("probe", "Probe the pixel under the cursor", "Enter", () => probe(cursorStart())),
  ...arrowActions,
];
