import type { Parameter } from "../app/types";
import { change, declared, faults, form } from "./draft";
import { Field } from "./Field";

/// A form made of what the scene declares.
export function ParameterFields() {
  const { parameters } = declared.value;
  if (parameters.length === 0) return null;
  return (
    <section aria-label="Parameters">
      <h2>Parameters</h2>
      <div class="fields">
        {parameters.map((parameter) => (
          <ParameterField key={parameter.name} parameter={parameter} />
        ))}
      </div>
    </section>
  );
}

function limitsOf({ min, max }: Parameter): string {
  if (min !== null && max !== null) return `${min} to ${max}`;
  if (min !== null) return `${min} or more`;
  return max === null ? "" : `${max} or less`;
}

function ParameterField({ parameter }: { parameter: Parameter }) {
  const { name, type, help } = parameter;
  const value = form.value.parameters[name] ?? "";
  const set = (text: string) => change({ parameters: { ...form.value.parameters, [name]: text } });
  const hint = [help, limitsOf(parameter)].filter(Boolean).join("; ");
  return (
    <Field label={name} hint={hint} fault={faults.value[`parameter ${name}`]}>
      {(attributes) =>
        type === "boolean" ? (
          <input
            {...attributes}
            type="checkbox"
            checked={(value || parameter.default) === "true"}
            onChange={(event) => set(String(event.currentTarget.checked))}
          />
        ) : type === "choice" ? (
          <select
            {...attributes}
            value={value || parameter.default}
            onChange={(event) => set(event.currentTarget.value)}
          >
            {parameter.choices.map((choice) => (
              <option key={choice}>{choice}</option>
            ))}
          </select>
        ) : (
          <input
            {...attributes}
            inputMode={type === "int" ? "numeric" : type === "number" ? "decimal" : "text"}
            placeholder={parameter.default}
            value={value}
            onInput={(event) => set(event.currentTarget.value)}
          />
        )
      }
    </Field>
  );
}
