import { effect, untracked } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";

const shortestPause = 250; // milliseconds

/// A value that takes its time to make: made anew when what `watched` reads changes, but not more than four times
/// a second and not for more than a fifth of the time.
export function useSteady<T>(watched: () => unknown, make: () => T): T | null {
  const [value, setValue] = useState<T | null>(null);
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    let due = false;
    const run = (): void => {
      due = false;
      const start = performance.now();
      setValue(untracked(make));
      const pause = Math.max(shortestPause, 4 * (performance.now() - start));
      timer = setTimeout(() => {
        timer = undefined;
        if (due) run();
      }, pause);
    };
    const stop = effect(() => {
      watched();
      due = true;
      if (timer === undefined) untracked(run);
    });
    return () => {
      stop();
      clearTimeout(timer);
    };
  }, []);
  return value;
}
