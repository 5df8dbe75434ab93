import { signal } from "@preact/signals";
import { actions, type Action, type Group } from "./actions";
import { Dialog } from "./Dialog";
import { Icon } from "./Icon";
import "./help.css";

export const helpShown = signal(false);

const groups: Group[] = ["General", "Jobs", "Picture", "Layers", "Rays"];
const places = { picture: "with the focus on it", rays: "in the 3D view", jobs: "in the job list" };

interface Line {
  keys: string[];
  title: string;
}

/// One for each action on keys, or for each family of them.
function linesOf(listed: readonly Action[]): Line[] {
  const lines = new Map<string, Line>();
  for (const { id, title, family, keys } of listed) {
    const before = lines.get(family ?? id)?.keys ?? [];
    lines.set(family ?? id, { keys: [...before, ...keys], title: family ?? title });
  }
  return [...lines.values()].filter(({ keys }) => keys.length > 0);
}

/// Lines by group; those that count only in a place are apart.
function sectionsOf(all: readonly Action[]): { title: string; lines: Line[] }[] {
  const scopes: Action["scope"][] = [undefined, "picture", "jobs", "rays"];
  return groups
    .flatMap((group) =>
      scopes.map((scope) => ({
        title: scope ? `${group}, ${places[scope]}` : group,
        lines: linesOf(all.filter((one) => one.group === group && one.scope === scope)),
      })),
    )
    .filter(({ lines }) => lines.length > 0);
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
          {sectionsOf(actions.value).map(({ title, lines }) => (
            <KeyGroup key={title} title={title} lines={lines} />
          ))}
        </div>
      </div>
    </Dialog>
  );
}

function KeyGroup({ title, lines }: { title: string; lines: Line[] }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {lines.map((line) => (
          <div key={line.title}>
            <dt>
              {line.keys.map((key) => (
                <Keys key={key} keys={key} />
              ))}
            </dt>
            <dd>{line.title}</dd>
          </div>
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
