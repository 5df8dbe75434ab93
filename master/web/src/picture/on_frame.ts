/// Runs once before the next frame, however often it is asked for.
export function onFrame(run: () => void): { ask: () => void; stop: () => void } {
  let frame = 0;
  const ask = (): void => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      run();
    });
  };
  return { ask, stop: () => cancelAnimationFrame(frame) };
}
