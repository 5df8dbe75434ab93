import type { ComponentChildren } from "preact";
import { isBoolean, stored } from "../app/stored";
import type { Signal } from "@preact/signals";

const open = new Map<string, Signal<boolean>>();

/// A part of the side panel that can be folded, and stays so.
export function Section({
  title,
  aside,
  children,
}: {
  title: string;
  aside?: ComponentChildren;
  children: ComponentChildren;
}) {
  const name = `section.${title.toLowerCase().replace(/\W+/g, "-")}`;
  let shown = open.get(name);
  if (!shown) open.set(name, (shown = stored(name, true, isBoolean)));
  const isOpen = shown;
  return (
    <details
      class="section"
      open={isOpen.value}
      onToggle={(event) => (isOpen.value = event.currentTarget.open)}
    >
      <summary>
        <h3>{title}</h3>
        <span class="aside">{aside}</span>
      </summary>
      {isOpen.value && <div class="section-body">{children}</div>}
    </details>
  );
}
