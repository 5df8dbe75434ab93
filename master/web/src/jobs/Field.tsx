import type { ComponentChildren, JSX } from "preact";
import { useId } from "preact/hooks";

interface Props {
  label: string;
  hint?: string;
  fault?: string | undefined;
  children: (attributes: {
    id: string;
    "aria-describedby"?: string;
    "aria-invalid"?: "true";
  }) => ComponentChildren;
}

/// A label, its control, and below it what is wrong, or else a hint.
export function Field({ label, hint, fault, children }: Props): JSX.Element {
  const id = useId();
  const words = fault ?? hint;
  return (
    <div class="field">
      <label for={id}>{label}</label>
      {children({
        id,
        ...(words && { "aria-describedby": `${id}-words` }),
        ...(fault && { "aria-invalid": "true" as const }),
      })}
      {words && (
        <span id={`${id}-words`} class={fault ? "words bad" : "words quiet"}>
          {words}
        </span>
      )}
    </div>
  );
}
