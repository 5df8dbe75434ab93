import { signal } from "@preact/signals";
import { Fragment } from "preact";
import { actions, type Action, type Group } from "./actions";
import { Dialog } from "./Dialog";
import { Icon } from "./Icon";
import "./help.css";

export const helpShown = signal(false);

const groups: Group[] = ["General", "Jobs", "Picture", "Layers", "Rays"];
const places = { rays: "in the 3D view", jobs: "in the job list" };

/// All that keys do.
export function Help() {
  if (!helpShown.value) return null;
  const close = () => (helpShown.value = false);
  const withKeys = actions.value.filter((action) => action.keys.length > 0);
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
          {groups.map((group) => {
            const listed = withKeys.filter((action) => action.group === group);
            return listed.length > 0 && <KeyGroup key={group} group={group} listed={listed} />;
          })}
        </div>
      </div>
    </Dialog>
  );
}

function KeyGroup({ group, listed }: { group: Group; listed: Action[] }) {
  return (
    <section>
      <h3>{group}</h3>
      <dl>
        {listed.map((action) => (
          <Fragment key={action.id}>
            <dt>
              {action.keys.map((key) => (
                <Keys key={key} keys={key} />
              ))}
            </dt>
            <dd>
              {action.title}
              {action.scope && <span class="quiet"> {places[action.scope]}</span>}
            </dd>
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
