import { many } from "../app/format";
import { change, declared, faults, form } from "./draft";
import { Field } from "./Field";
import { defaultOf, lastFrame, rules, samplers, verifications, type NumberName, type SwitchName } from "./submission";

/// How the picture is made.
export function SettingFields() {
  const { animation } = declared.value;
  const last = animation ? lastFrame(animation) : 0;
  return (
    <section aria-label="Settings">
      <h2>Settings</h2>
      <div class="fields">
        <NumberField name="width" hint="pixels" />
        <NumberField name="height" hint="pixels" />
        <NumberField name="spp" />
        <Field label="Sampler">
          {(attributes) => (
            <select
              {...attributes}
              value={form.value.sampler}
              onChange={(event) => change({ sampler: event.currentTarget.value })}
            >
              {samplers.map((sampler) => (
                <option key={sampler}>{sampler}</option>
              ))}
            </select>
          )}
        </Field>
        <NumberField name="max_depth" hint="of reflected and refracted rays" />
        <NumberField name="min_importance" hint="rays of less are not traced" />
        <NumberField name="seed" />
        {form.value.source !== "job" && (
          <NumberField
            name="frame"
            hint={animation ? `0 to ${last}, ${many(animation.fps, "frame")} a second` : ""}
          />
        )}
        {form.value.source !== "job" && animation && (
          <Field label="Frames" hint={`several in one job: 0-${last}, or 0-${last}:2`} fault={faults.value.frames}>
            {(attributes) => (
              <input
                {...attributes}
                placeholder="just the one"
                value={form.value.frames}
                onInput={(event) => change({ frames: event.currentTarget.value })}
              />
            )}
          </Field>
        )}
      </div>
      <div class="switches" role="group" aria-label="Rays that are traced">
        <Switch name="shadows" />
        <Switch name="reflections" />
        <Switch name="refractions" />
      </div>
      <h2>Job</h2>
      <div class="fields">
        <Field label="Name" fault={faults.value.name}>
          {(attributes) => (
            <input
              {...attributes}
              placeholder={
                form.value.source === "farm" ? form.value.scene : form.value.script.name.replace(/\.lua$/, "")
              }
              value={form.value.name}
              onInput={(event) => change({ name: event.currentTarget.value })}
            />
          )}
        </Field>
        <Field label="Workers" hint="those that deliver wrong pixels twice are banned">
          {(attributes) => (
            <select
              {...attributes}
              value={form.value.verify}
              onChange={(event) => change({ verify: event.currentTarget.value })}
            >
              {Object.entries(verifications).map(([verify, words]) => (
                <option key={verify} value={verify}>
                  {words}
                </option>
              ))}
            </select>
          )}
        </Field>
        <NumberField name="priority" hint="0 to 99, higher goes first" />
      </div>
      <div class="switches">
        <label>
          <input
            type="checkbox"
            checked={form.value.hold}
            onChange={(event) => change({ hold: event.currentTarget.checked })}
          />
          Hold: begin paused
        </label>
      </div>
    </section>
  );
}

function NumberField({ name, hint = "" }: { name: NumberName; hint?: string }) {
  const { numbers } = form.value;
  const { label, whole } = rules[name];
  return (
    <Field label={label} hint={hint} fault={faults.value[name]}>
      {(attributes) => (
        <input
          {...attributes}
          inputMode={whole ? "numeric" : "decimal"}
          placeholder={String(defaultOf(name, declared.value.image))}
          value={numbers[name]}
          onInput={(event) => change({ numbers: { ...numbers, [name]: event.currentTarget.value } })}
        />
      )}
    </Field>
  );
}

function Switch({ name }: { name: SwitchName }) {
  const { switches } = form.value;
  return (
    <label>
      <input
        type="checkbox"
        checked={switches[name]}
        onChange={(event) => change({ switches: { ...switches, [name]: event.currentTarget.checked } })}
      />
      {name}
    </label>
  );
}
