import { effect, untracked } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";

const pause = 250; // milliseconds

/// A value that takes its time to make: made anew at most four times a second when what `watched` reads changes.
export function useSteady<T>(watched: () => unknown, make: () => T): T | null {
  const [value, setValue] = useState<T | null>(null);
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    let due = false;
    const run = (): void => {
      due = false;
      setValue(untracked(make));
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
