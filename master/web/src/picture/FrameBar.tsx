import { chosenFrame, frameAt, isAnimation, placeOf, shownFrame, stepFrame } from "../app/frames";
import { selectedJob } from "../app/state";

/// Which frame of an animation is looked at.
export function FrameBar() {
  const job = selectedJob.value;
  const frame = shownFrame.value;
  if (!job || frame === null || !isAnimation(job)) return null;
  const place = placeOf(job.frames, frame);
  return (
    <div class="frame-bar" role="group" aria-label="Frames">
      <button
        class="plain"
        aria-label="Previous frame"
        title="Previous frame (,)"
        disabled={place === 0}
        onClick={() => stepFrame(-1)}
      >
        ‹
      </button>
      <input
        type="range"
        aria-label="Frame"
        aria-valuetext={`Frame ${frame}`}
        min={0}
        max={job.frames.total - 1}
        value={place}
        onInput={(event) => (chosenFrame.value = frameAt(job.frames, event.currentTarget.valueAsNumber))}
      />
      <button
        class="plain"
        aria-label="Next frame"
        title="Next frame (.)"
        disabled={place === job.frames.total - 1}
        onClick={() => stepFrame(1)}
      >
        ›
      </button>
      <output>
        Frame {frame} <span class="quiet">{`${place + 1}/${job.frames.total}`}</span>
      </output>
      <button
        class="plain"
        aria-pressed={chosenFrame.value === null}
        title="Show the frame at work, one after the other"
        disabled={job.frames.current === null && chosenFrame.value === null}
        onClick={() => (chosenFrame.value = chosenFrame.peek() === null ? frame : null)}
      >
        Follow
      </button>
    </div>
  );
}
