// Everything that a key does, by name: keys, the help (?) and the palette (Ctrl+K) are made from this list.
import { signal } from "@preact/signals";

export type Group = "General" | "Jobs" | "Picture" | "Layers" | "Rays";

export interface Action {
  id: string;
  title: string; // as the palette shows it: "Zoom in"
  family?: string; // the help says this once for all that share it
  group: Group;
  keys: string[]; // "Shift+E", "Ctrl+K", "ArrowLeft", "?"; the first is shown
  /// The keys count only while the focus is inside [data-scope=...], and go before those of the others.
  scope?: "picture" | "rays" | "jobs";
  enabled?: () => boolean;
  run: () => void;
}

export const actions = signal<Action[]>([]);

/// Adds actions; the result takes them away again.
export function register(added: Action[]): () => void {
  actions.value = [...actions.value, ...added];
  return () => {
    actions.value = actions.value.filter((action) => !added.includes(action));
  };
}

/// "Shift+E" for a keyboard event; letters are upper case, a shifted sign is the sign itself ("?").
export function keyOf(event: KeyboardEvent): string {
  const letter = /^[a-z]$/i.test(event.key);
  const named = event.key.length > 1;
  const digit = /^Digit\d$/.test(event.code);
  const key = letter
    ? event.key.toUpperCase()
    : digit
      ? event.code.slice(5)
      : event.key === " "
        ? "Space"
        : event.key;
  const shift = event.shiftKey && (letter || named || digit);
  return `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${event.altKey ? "Alt+" : ""}${shift ? "Shift+" : ""}${key}`;
}
