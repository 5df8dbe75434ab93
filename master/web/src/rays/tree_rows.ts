// Which lines of the ray tree are open, and where the arrow keys lead.
import type { Entry } from "./trace";

/// Ids that are opened or closed against the rule: all is open, but of several samples each is closed.
export type Toggled = ReadonlySet<string>;

export interface TreeRow {
  entry: Entry;
  parent: boolean; // has lines below it
  open: boolean;
}

export function rowsOf(entries: readonly Entry[], samples: number, toggled: Toggled): TreeRow[] {
  const rows: TreeRow[] = [];
  let closedLevel = Infinity; // what is deeper is hidden
  entries.forEach((entry, i) => {
    if (entry.level > closedLevel) return;
    const parent = (entries[i + 1]?.level ?? 0) > entry.level;
    const open = parent && (entry.level > 0 || samples === 1) !== toggled.has(entry.id);
    closedLevel = parent && !open ? entry.level : Infinity;
    rows.push({ entry, parent, open });
  });
  return rows;
}

export type Move = { select: string } | { toggle: string } | null;

/// What a key does from the selected row (or from none), as trees do everywhere.
export function moveOf(key: string, rows: readonly TreeRow[], selected: string | null): Move {
  const index = rows.findIndex((row) => row.entry.id === selected);
  const row = rows[index];
  const to = (target: TreeRow | undefined): Move => (target ? { select: target.entry.id } : null);
  switch (key) {
    case "ArrowDown":
      return to(rows[index + 1]);
    case "ArrowUp":
      return to(rows[Math.max(0, index - 1)]);
    case "Home":
      return to(rows[0]);
    case "End":
      return to(rows.at(-1));
    case "ArrowRight":
      if (!row?.parent) return null;
      return row.open ? to(rows[index + 1]) : { toggle: row.entry.id };
    case "ArrowLeft":
      if (row?.open) return { toggle: row.entry.id };
      return row?.entry.parent ? { select: row.entry.parent } : null;
    case "Enter":
    case " ":
      return row?.parent ? { toggle: row.entry.id } : null;
  }
  return null;
}

/// Lines above the entry that would have to open for it to be seen.
export function closedAbove(entries: readonly Entry[], rows: readonly TreeRow[], id: string): string[] {
  const parents = new Map(entries.map((entry) => [entry.id, entry.parent]));
  const closed: string[] = [];
  const open = new Map(rows.map((row) => [row.entry.id, row.open]));
  for (let at = parents.get(id) ?? null; at !== null; at = parents.get(at) ?? null)
    if (open.get(at) === false) closed.push(at);
  return closed;
}
