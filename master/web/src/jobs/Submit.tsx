import { useEffect } from "preact/hooks";
import { cloned } from "../app/route";
import { jobs } from "../app/state";
import { checked, faults, followScript, form, prefill, refusal, sending, submit } from "./draft";
import { ParameterFields } from "./ParameterFields";
import { SceneChoice } from "./SceneChoice";
import { SettingFields } from "./SettingFields";
import "./submit.css";

/// The page for a new job.
export function Submit() {
  const from = jobs.value.find((job) => job.id === cloned.value);
  useEffect(followScript, []);
  useEffect(() => {
    if (from) prefill(from);
    else if (cloned.value === null) prefill(null);
  }, [cloned.value, from?.id]);
  const fault = faults.value.source ?? Object.values(faults.value)[0];
  const scriptIsBroken = form.value.source === "script" && (!checked.value || "fault" in checked.value);
  return (
    <form
      class="submit"
      aria-label="New job"
      onSubmit={(event) => {
        event.preventDefault();
        if (!fault && !scriptIsBroken && !sending.value) void submit();
      }}
    >
      <div class="columns">
        <div>
          <SceneChoice />
        </div>
        <div>
          <ParameterFields />
          <SettingFields />
        </div>
      </div>
      <footer>
        <button class="main" type="submit" disabled={fault !== undefined || scriptIsBroken || sending.value}>
          {sending.value ? "Submitting …" : "Submit"}
        </button>
        {refusal.value ? (
          <p class="bad" role="alert">
            {refusal.value}
          </p>
        ) : (
          <p class="quiet">{fault}</p>
        )}
      </footer>
    </form>
  );
}
