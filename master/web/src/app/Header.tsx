import { computed } from "@preact/signals";
import { actions } from "./actions";
import { many, short } from "./format";
import { Icon } from "./Icon";
import { hashOf, page, routeTo, type Page } from "./route";
import { logOut, person } from "./session";
import { jobs, link, raysShown, workers } from "./state";
import { theme } from "./theme";
import { rates } from "../workers/throughput";
import "./header.css";

const pages: { page: Page; title: string }[] = [
  { page: "jobs", title: "Jobs" },
  { page: "workers", title: "Workers" },
  { page: "submit", title: "New job" },
];

const summary = computed(() => {
  const there = workers.value.filter((worker) => worker.state !== "dialling" && worker.state !== "banned");
  const busy = there.filter((worker) => worker.state === "busy");
  const delivered = rates.value.farm[rates.value.farm.length - 1] ?? 0;
  const running = jobs.value.filter((job) => job.state === "running").length;
  const waiting = jobs.value.filter((job) => job.state === "waiting").length;
  return [
    there.length === 0 ? "no workers" : `${busy.length} of ${many(there.length, "worker")} busy`,
    ...(delivered > 0 ? [`${short(delivered)} samples/s`] : []),
    ...(running + waiting > 0 ? [`${running} running, ${waiting} waiting`] : []),
  ];
});

const words = { connecting: "connecting", open: "connected", lost: "connection lost" };

export function Header() {
  return (
    <header class="header">
      <h1>rayfarm</h1>
      <nav aria-label="Pages">
        {pages.map((entry) => (
          <a
            key={entry.page}
            href={entry.page === "submit" ? "#/submit" : hashOf(routeTo(entry.page))}
            aria-current={page.value === entry.page ? "page" : undefined}
          >
            {entry.title}
          </a>
        ))}
      </nav>
      <p class="summary" title="The farm now">
        <span
          class={`dot ${link.value}`}
          role="img"
          aria-label={words[link.value]}
          title={words[link.value]}
        />
        {summary.value.map((part) => (
          <span key={part}>{part}</span>
        ))}
      </p>
      <div class="tools" role="toolbar" aria-label="View">
        <Tool id="palette" icon="search" />
        <Tool id="panels" icon="panel" />
        <Tool id="rays" icon="rays" pressed={raysShown.value} />
        <Tool id="theme" icon={theme.value === "dark" ? "sun" : "moon"} />
        <Tool id="help" text="?" />
        {person.value && (
          <button
            class="plain"
            title={`You are ${person.value.name ? `${person.value.name}, ` : ""}${person.value.role}`}
            onClick={logOut}
          >
            Log out
          </button>
        )}
      </div>
    </header>
  );
}

/// A button for an action that is also on a key.
function Tool({
  id,
  icon,
  text,
  pressed,
}: {
  id: string;
  icon?: Parameters<typeof Icon>[0]["name"];
  text?: string;
  pressed?: boolean;
}) {
  const action = actions.value.find((one) => one.id === id);
  if (!action) return null;
  const key = action.keys[0];
  return (
    <button
      class="plain"
      aria-label={action.title}
      aria-pressed={pressed}
      title={key ? `${action.title} (${key})` : action.title}
      onClick={action.run}
    >
      {icon ? <Icon name={icon} /> : text}
    </button>
  );
}
