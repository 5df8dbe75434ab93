import { signal } from "@preact/signals";
import { Fragment } from "preact";
import { actions, type Action, type Group } from "./actions";
import { Dialog } from "./Dialog";
import { Icon } from "./Icon";
import "./help.css";

export const helpShown = signal(false);

const groups: Group[] = ["General", "Jobs", "Picture", "Layers", "Rays"];
const places = { rays: "in the 3D view", jobs: "in the job list" };

/// The actions on keys by group; those that count only in a place are apart.
function sectionsOf(all: readonly Action[]): { title: string; listed: Action[] }[] {
  const scopes: Action["scope"][] = [undefined, "jobs", "rays"];
  return groups
    .flatMap((group) =>
      scopes.map((scope) => ({
        title: scope ? `${group}, ${places[scope]}` : group,
        listed: all.filter((one) => one.keys.length > 0 && one.group === group && one.scope === scope),
      })),
    )
    .filter(({ listed }) => listed.length > 0);
}

/// All that keys do.
export function Help() {
  if (!helpShown.value) return null;
  const close = () => (helpShown.value = false);
  return (
    <Dialog label="Keys" class="help" close={close}>
      <div>
        <header>
          <h2>Keys</h2>
          <button class="plain" aria-label="Close" onClick={close}>
            <Icon name="close" />
          </button>
        </header>
        <div class="groups">
          {sectionsOf(actions.value).map(({ title, listed }) => (
            <KeyGroup key={title} title={title} listed={listed} />
          ))}
        </div>
      </div>
    </Dialog>
  );
}

function KeyGroup({ title, listed }: { title: string; listed: Action[] }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {listed.map((action) => (
          <Fragment key={action.id}>
            <dt>
              {action.keys.map((key) => (
                <Keys key={key} keys={key} />
              ))}
            </dt>
            <dd>{action.title}</dd>
          </Fragment>
        ))}
      </dl>
    </section>
  );
}

const signs: Record<string, string> = {
  ArrowLeft: "←",
  ArrowRight: "→",
  ArrowUp: "↑",
  ArrowDown: "↓",
  Escape: "Esc",
  PageUp: "PgUp",
  PageDown: "PgDn",
  Delete: "Del",
};

/// "Shift+ArrowLeft" as keys to press together.
export function Keys({ keys }: { keys: string }) {
  const parts = keys.endsWith("+") ? [...keys.slice(0, -1).split("+").filter(Boolean), "+"] : keys.split("+");
  return (
    <span class="keys">
      {parts.map((part) => (
        <kbd key={part}>{signs[part] ?? part}</kbd>
      ))}
    </span>
  );
}
