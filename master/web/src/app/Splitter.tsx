import type { Signal } from "@preact/signals";
import "./splitter.css";

interface Props {
  label: string;
  size: Signal<number>;
  /// "columns": between left and right; "rows": between upper and lower.
  split: "columns" | "rows";
  /// Of the size: pixels of the first part, or its share of the parent.
  unit: "pixels" | "share";
  least: number;
  most: number;
  initial: number;
}

/// A bar that is dragged, or moved with the arrow keys, to share room between two areas.
export function Splitter({ label, size, split, unit, least, most, initial }: Props) {
  const columns = split === "columns";
  const set = (value: number) => (size.value = Math.min(most, Math.max(least, value)));
  const perPixel = (bar: HTMLElement) => {
    const parent = bar.parentElement!.getBoundingClientRect();
    return unit === "pixels" ? 1 : 1 / (columns ? parent.width : parent.height);
  };

  function drag(event: PointerEvent) {
    if (event.button !== 0) return;
    const bar = event.currentTarget as HTMLElement;
    const from = columns ? event.clientX : event.clientY;
    const before = size.value;
    const scale = perPixel(bar);
    const move = (moved: PointerEvent) =>
      set(before + ((columns ? moved.clientX : moved.clientY) - from) * scale);
    bar.setPointerCapture(event.pointerId);
    bar.addEventListener("pointermove", move);
    bar.addEventListener("lostpointercapture", () => bar.removeEventListener("pointermove", move), {
      once: true,
    });
  }

  function key(event: KeyboardEvent) {
    const step = 16 * perPixel(event.currentTarget as HTMLElement);
    const moves: Record<string, number> = {
      [columns ? "ArrowLeft" : "ArrowUp"]: size.value - step,
      [columns ? "ArrowRight" : "ArrowDown"]: size.value + step,
      Home: least,
      End: most,
      Enter: initial,
    };
    const moved = moves[event.key];
    if (moved === undefined) return;
    event.preventDefault();
    set(moved);
  }

  const shown = (value: number) => Math.round(unit === "share" ? value * 100 : value);
  return (
    <div
      class={`splitter ${split}`}
      role="separator"
      tabIndex={0}
      aria-label={label}
      aria-orientation={columns ? "vertical" : "horizontal"}
      aria-valuenow={shown(size.value)}
      aria-valuemin={shown(least)}
      aria-valuemax={shown(most)}
      onPointerDown={drag}
      onDblClick={() => set(initial)}
      onKeyDown={key}
    />
  );
}
