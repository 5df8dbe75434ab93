import { now } from "./clock";
import { ago } from "./format";
import { Icon } from "./Icon";
import { retry } from "./live";
import { dismiss, loginWanted, lostSince, notices } from "./state";
import "./notices.css";

/// Over the page while the master is out of reach; goes by itself.
export function LostBanner() {
  const since = lostSince.value;
  if (since === null || loginWanted.value) return null;
  return (
    <div class="lost-banner">
      <span role="status">The connection to the master is lost; what you see may be old.</span>
      <span>Lost {ago((now.value - since) / 1000)}, trying again until it answers.</span>
      <button onClick={retry}>Try now</button>
    </div>
  );
}

export function Notices() {
  return (
    <ul class="notices" aria-live="polite" aria-label="Messages">
      {notices.value.map((notice) => (
        <li key={notice.id} class={notice.kind} role={notice.kind === "error" ? "alert" : undefined}>
          <span>{notice.text}</span>
          <button class="plain" aria-label="Dismiss" onClick={() => dismiss(notice.id)}>
            <Icon name="close" />
          </button>
        </li>
      ))}
    </ul>
  );
}
