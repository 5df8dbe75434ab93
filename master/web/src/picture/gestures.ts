// Pointer and wheel over the picture: drag pans, click probes, Ctrl or right drag probes along, Shift drag selects.
import type { Point } from "./view";
import { density } from "./view_state";

/// What the gestures do; points are device pixels from the canvas' upper left corner.
export interface Hands {
  pan(by: Point): void;
  zoom(factor: number, at: Point): void;
  probe(at: Point): void;
  scrub(at: Point): void; // a probe of a drag: there are many
  select(from: Point, to: Point): void;
  hover(at: Point | null): void;
  toggleFit(at: Point): void;
  overWipe(at: Point): boolean;
  wipe(at: Point): void;
  start(): void; // a pointer is down
}

type Drag = "click or pan" | "pan" | "scrub" | "select" | "wipe" | "pinch";

const threshold = 3; // CSS pixels that a click may move
export const zoomStep = 1.1;
export const bigZoomStep = 1.331;

/// One notch of a wheel is one step, of whatever length browsers make it; a touch pad's small moves are parts.
export function wheelFactor(event: Pick<WheelEvent, "deltaX" | "deltaY" | "deltaMode" | "shiftKey">): number {
  const delta = event.deltaY || event.deltaX; // Shift turns a wheel sideways
  const notches = event.deltaMode !== 0 || Math.abs(delta) >= 50 ? Math.sign(delta) : delta / 50;
  return (event.shiftKey ? bigZoomStep : zoomStep) ** -notches;
}

export function attachGestures(target: HTMLElement, hands: Hands): () => void {
  const pointers = new Map<number, Point>();
  let drag: Drag | null = null;
  let start: Point = { x: 0, y: 0 };

  const at = (event: MouseEvent): Point => {
    const box = target.getBoundingClientRect();
    return { x: (event.clientX - box.left) * density.peek(), y: (event.clientY - box.top) * density.peek() };
  };

  const kindOf = (event: PointerEvent, p: Point): Drag => {
    if (event.button === 1) return "pan";
    if (event.button === 2 || event.ctrlKey || event.metaKey) return "scrub";
    if (hands.overWipe(p)) return "wipe";
    return event.shiftKey ? "select" : "click or pan";
  };

  const down = (event: PointerEvent): void => {
    const p = at(event);
    target.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, p);
    hands.start();
    if (pointers.size === 2) drag = "pinch";
    else {
      drag = kindOf(event, p);
      start = p;
      if (drag === "scrub") hands.scrub(p);
    }
    if (event.button === 1) event.preventDefault(); // no scrolling by the middle button
  };

  const pinch = (id: number, from: Point, to: Point): void => {
    const other = [...pointers].find(([each]) => each !== id)?.[1];
    if (!other) return;
    const apart = (p: Point): number => Math.hypot(p.x - other.x, p.y - other.y);
    const middle = { x: (to.x + other.x) / 2, y: (to.y + other.y) / 2 };
    hands.pan({ x: (to.x - from.x) / 2, y: (to.y - from.y) / 2 });
    if (apart(from) > 0) hands.zoom(apart(to) / apart(from), middle);
  };

  const move = (event: PointerEvent): void => {
    const p = at(event);
    const last = pointers.get(event.pointerId);
    hands.hover(p);
    target.classList.toggle("over-wipe", hands.overWipe(p));
    if (!last || !drag) return;
    if (drag === "click or pan" && Math.hypot(p.x - start.x, p.y - start.y) >= threshold * density.peek())
      drag = "pan";
    if (drag === "pan") hands.pan({ x: p.x - last.x, y: p.y - last.y });
    else if (drag === "scrub") hands.scrub(p);
    else if (drag === "select") hands.select(start, p);
    else if (drag === "wipe") hands.wipe(p);
    else if (drag === "pinch") pinch(event.pointerId, last, p);
    // A click that has not moved far enough yet is measured from where it began.
    if (drag !== "click or pan") pointers.set(event.pointerId, p);
    target.classList.toggle("panning", drag === "pan");
  };

  const up = (event: PointerEvent): void => {
    pointers.delete(event.pointerId);
    if (drag === "click or pan" && event.type === "pointerup") hands.probe(at(event));
    if (drag === "select" && event.type === "pointerup") hands.select(start, at(event));
    drag = null;
    target.classList.remove("panning");
  };

  const wheel = (event: WheelEvent): void => {
    event.preventDefault();
    hands.zoom(wheelFactor(event), at(event));
  };

  const stop = new AbortController();
  const on = { signal: stop.signal };
  target.addEventListener("pointerdown", down, on);
  target.addEventListener("pointermove", move, on);
  target.addEventListener("pointerup", up, on);
  target.addEventListener("pointercancel", up, on);
  target.addEventListener("pointerleave", () => hands.hover(null), on);
  target.addEventListener("wheel", wheel, { ...on, passive: false });
  target.addEventListener("dblclick", (event) => hands.toggleFit(at(event)), on);
  target.addEventListener("contextmenu", (event) => event.preventDefault(), on);
  return () => stop.abort();
}
