// Light or dark: as the system has it, unless the person chose the other.
import { computed, effect, signal } from "@preact/signals";
import { stored } from "./stored";

type Theme = "light" | "dark";
const chosen = stored<Theme | null>("theme", null, (value) => value === "light" || value === "dark");
const systemDark = signal(false);

export const theme = computed<Theme>(() => chosen.value ?? (systemDark.value ? "dark" : "light"));

export function toggleTheme(): void {
  const other: Theme = theme.value === "dark" ? "light" : "dark";
  chosen.value = other === (systemDark.value ? "dark" : "light") ? null : other;
}

export function startTheme(): void {
  const query = matchMedia("(prefers-color-scheme: dark)");
  systemDark.value = query.matches;
  query.addEventListener("change", () => (systemDark.value = query.matches));
  effect(() => {
    if (chosen.value) document.documentElement.dataset.theme = chosen.value;
    else delete document.documentElement.dataset.theme;
  });
}
