// What keys do with the rays. W A S D Q E R O count while the 3D view has the focus, the others everywhere.
import { register, type Action } from "../app/actions";
import { raysShown } from "../app/state";
import { alignWithPrimary, alignWithSelected, toggleKeepAligned } from "./align";
import { reset, step, toggleOrthographic, turn, zoom } from "./camera";
import { shown, toggle } from "./options";
import { selected } from "./selection";

const angle = 0.2; // radians
const stride = 0.08; // of the view's height, or of the distance to what it turns around

const show = (what: keyof typeof shown, title: string, keys: string[] = []): Action => ({
  id: `rays.${what}`,
  title,
  group: "Rays",
  keys,
  enabled: () => raysShown.value,
  run: () => toggle(what),
});

const inView = (id: string, title: string, key: string, run: () => void): Action => ({
  id: `rays.${id}`,
  title,
  group: "Rays",
  keys: [key],
  scope: "rays",
  enabled: () => raysShown.value,
  run,
});

const turning = "Turn the 3D view";
const rayActions: Action[] = [
  {
    id: "rays.align",
    title: "Align the 3D view with the primary ray",
    group: "Rays",
    keys: ["Shift+L"],
    enabled: () => raysShown.value,
    run: alignWithPrimary,
  },
  {
    id: "rays.keep-aligned",
    title: "Keep the 3D view aligned with the primary ray",
    group: "Rays",
    keys: ["L"],
    enabled: () => raysShown.value,
    run: toggleKeepAligned,
  },
  {
    id: "rays.along",
    title: "Look along the selected ray",
    group: "Rays",
    keys: [],
    enabled: () => raysShown.value && selected.value !== null,
    run: alignWithSelected,
  },
  show("boxes", "Show bounding boxes", ["B"]),
  show("cloud", "Show the point cloud", ["K"]),
  show("preview", "Show the solids"),
  show("camera", "Show camera rays"),
  show("reflected", "Show reflected rays"),
  show("refracted", "Show refracted rays"),
  show("shadow", "Show shadow rays"),
  show("misses", "Show rays that miss"),
  show("normals", "Show normals"),
  show("outliers", "Mark the samples that stand out"),
  show("icons", "Show the camera and the lights"),
  show("axes", "Show the axes"),
  inView("forward", "Move the 3D view forward", "W", () => step(0, 0, stride)),
  inView("back", "Move the 3D view back", "S", () => step(0, 0, -stride)),
  inView("left", "Move the 3D view left", "A", () => step(-stride, 0, 0)),
  inView("right", "Move the 3D view right", "D", () => step(stride, 0, 0)),
  inView("up", "Move the 3D view up", "E", () => step(0, stride, 0)),
  inView("down", "Move the 3D view down", "Q", () => step(0, -stride, 0)),
  { ...inView("turn-left", "Turn the 3D view left", "ArrowLeft", () => turn(-angle, 0)), family: turning },
  { ...inView("turn-right", "Turn the 3D view right", "ArrowRight", () => turn(angle, 0)), family: turning },
  { ...inView("turn-up", "Turn the 3D view up", "ArrowUp", () => turn(0, -angle)), family: turning },
  { ...inView("turn-down", "Turn the 3D view down", "ArrowDown", () => turn(0, angle)), family: turning },
  inView("nearer", "Zoom into the 3D view", "+", () => zoom(1.1)),
  inView("farther", "Zoom out of the 3D view", "-", () => zoom(1 / 1.1)),
  inView("reset", "See the whole scene in the 3D view", "R", reset),
  inView("orthographic", "Switch the 3D view between perspective and orthographic", "O", toggleOrthographic),
];

/// The result takes them away again.
export const registerRayActions = (): (() => void) => register(rayActions);
