// Hands on the 3D view: drag turns, right, middle or Shift-drag pans, the wheel and two fingers zoom, a click chooses.
import { jumpBy } from "../camera";
import { moved, orbited, zoomed } from "../pose";

interface At {
  x: number;
  y: number;
}

export interface Listener {
  pointed: (x: number, y: number) => void; // at a place of the canvas, no button down
  left: () => void;
  clicked: (x: number, y: number) => void;
}

const clickReach = 4; // pixels within which a press is a click

/// Until the result is called.
export function listenToHands(canvas: HTMLCanvasElement, listener: Listener): () => void {
  const down = new Map<number, At>();
  let pressed: (At & { pans: boolean }) | null = null;
  let travelled = 0;
  const place = (event: PointerEvent | WheelEvent): At => ({ x: event.offsetX, y: event.offsetY });

  const press = (event: PointerEvent) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, place(event));
    travelled = down.size > 1 ? Infinity : 0;
    pressed = { ...place(event), pans: event.button > 0 || event.shiftKey };
  };
  const move = (event: PointerEvent) => {
    const now = place(event);
    const before = down.get(event.pointerId);
    if (!before) return listener.pointed(now.x, now.y);
    down.set(event.pointerId, now);
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    travelled += Math.hypot(dx, dy);
    if (travelled < clickReach) return;
    listener.left();
    const other = [...down].find(([id]) => id !== event.pointerId)?.[1];
    if (other) pinch(before, now, other);
    else if (pressed?.pans) pan(dx, dy);
    else jumpBy((from) => orbited(from, (3 * dx) / canvas.clientHeight, (3 * dy) / canvas.clientHeight));
  };
  const pan = (dx: number, dy: number) => {
    jumpBy((from) => moved(from, -dx / canvas.clientHeight, dy / canvas.clientHeight, 0));
  };
  const pinch = (before: At, now: At, other: At) => {
    const apart = (p: At) => Math.hypot(p.x - other.x, p.y - other.y);
    if (apart(before) > 0 && apart(now) > 0) jumpBy((from) => zoomed(from, apart(now) / apart(before)));
    pan((now.x - before.x) / 2, (now.y - before.y) / 2);
  };
  const release = (event: PointerEvent) => {
    if (down.delete(event.pointerId) && down.size === 0 && travelled < clickReach && !pressed?.pans)
      listener.clicked(event.offsetX, event.offsetY);
  };
  const cancel = (event: PointerEvent) => void down.delete(event.pointerId);
  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    // Shift turns the wheel sideways in most browsers.
    const turns =
      -(event.deltaY || event.deltaX) / (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 100 : 3);
    jumpBy((from) => zoomed(from, (event.shiftKey ? 1.331 : 1.1) ** Math.max(-3, Math.min(3, turns))));
  };
  const noMenu = (event: Event) => event.preventDefault();

  canvas.addEventListener("pointerdown", press);
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", cancel);
  canvas.addEventListener("pointerleave", listener.left);
  canvas.addEventListener("wheel", wheel, { passive: false });
  canvas.addEventListener("contextmenu", noMenu);
  return () => {
    canvas.removeEventListener("pointerdown", press);
    canvas.removeEventListener("pointermove", move);
    canvas.removeEventListener("pointerup", release);
    canvas.removeEventListener("pointercancel", cancel);
    canvas.removeEventListener("pointerleave", listener.left);
    canvas.removeEventListener("wheel", wheel);
    canvas.removeEventListener("contextmenu", noMenu);
  };
}
