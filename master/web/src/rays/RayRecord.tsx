import { cssOf } from "./color";
import { answer } from "./probe";
import { fieldsOf, nameOf } from "./record";
import { described } from "./selection";

/// The record of the ray that is pointed at, or chosen.
export function RayRecord() {
  const entry = described.value;
  const sample = entry && answer.value?.trace.samples[entry.sample];
  return (
    <section
      class="rays-record"
      aria-label="Record of the ray"
      data-entry={entry?.id}
      data-record={entry ? nameOf(entry) : ""}
    >
      {entry && sample ? (
        <dl>
          {fieldsOf(entry, sample).map(({ label, text, color }) => (
            <div key={label}>
              <dt>{label}</dt>
              <dd>
                {color && <span class="rays-patch" style={{ background: cssOf(color) }} />}
                {text}
              </dd>
            </div>
          ))}
        </dl>
      ) : (
        <p class="quiet">No ray yet.</p>
      )}
    </section>
  );
}
