// What keys and the palette do with the picture.
import { register, type Action } from "../app/actions";
import { shownFrame, stepFrame } from "../app/frames";
import { act } from "./action";
import { nextMetric, setReference, shiftHeld, toggleComparison, toggleFlip } from "./compare";
import { displayActions, layerActions } from "./display_actions";
import { choose, results, step } from "./history";
import { viewActions } from "./view_actions";

const slots = [1, 2, 3, 4, 5];
const hasSlot = (slot: number) => (): boolean => results.peek().length >= slot;
const refer = (slot: number) => (): void => setReference(results.peek()[slot - 1]?.id ?? null);
const slotTitle = (slot: number): string =>
  slot === 1 ? "Show the newest result" : `Show result ${slot} of the history`;

const historyActions: Action[] = [
  act("older", "Previous result of the scene", ["A"], () => step(1)),
  act("newer", "Next result of the scene", ["D"], () => step(-1)),
  ...slots.map((slot) => ({
    ...act(`slot-${slot}`, slotTitle(slot), [String(slot)], () => choose(slot), hasSlot(slot)),
    family: "Show one of the last results",
  })),
];

const hasFrames = (): boolean => shownFrame.peek() !== null;
const frameActions: Action[] = [
  act("frame-previous", "Previous frame of the animation", [","], () => stepFrame(-1), hasFrames),
  act("frame-next", "Next frame of the animation", ["."], () => stepFrame(1), hasFrames),
];

const compareActions: Action[] = [
  act("flip", "Flip between result and reference (hold Shift to look only)", ["Space"], toggleFlip),
  act("wipe", "Compare with a wipe", ["W"], () => toggleComparison("wipe")),
  act("metric", "Difference to the reference, next metric", ["X"], nextMetric),
  act("no-reference", "Compare with nothing", ["Shift+X"], () => setReference(null)),
  ...slots.map((slot) => ({
    ...act(
      `reference-${slot}`,
      `Compare with result ${slot} of the history`,
      [`Shift+${slot}`],
      refer(slot),
      hasSlot(slot),
    ),
    family: "Compare with one of the last results",
  })),
];

/// While Shift alone is held the reference is shown.
function followShift(): () => void {
  const stop = new AbortController();
  const follow = (type: "keydown" | "keyup", held: boolean): void =>
    addEventListener(type, (event) => event.key === "Shift" && (shiftHeld.value = held), {
      signal: stop.signal,
    });
  follow("keydown", true);
  follow("keyup", false);
  addEventListener("blur", () => (shiftHeld.value = false), { signal: stop.signal });
  return () => stop.abort();
}

export function registerPicture(): () => void {
  const stops = [
    register([...viewActions, ...displayActions, ...layerActions, ...historyActions, ...frameActions, ...compareActions]),
    followShift(),
  ];
  return () => stops.forEach((stop) => stop());
}
