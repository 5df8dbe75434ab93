// Numbers as people read them. Words and units are apart by a space, thousands by a narrow one.

const narrow = "\u202f";

export function count(value: number): string {
  return Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, narrow);
}

/// Three digits and a unit: 950, 1.24 k, 18.3 M.
export function short(value: number): string {
  const units = ["", " k", " M", " G", " T"];
  let unit = 0;
  while (Math.abs(value) >= 999.5 && unit + 1 < units.length) {
    value /= 1000;
    ++unit;
  }
  const digits = unit === 0 || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
  return value.toFixed(digits) + units[unit]!;
}

const two = (value: number): string => String(value).padStart(2, "0");

/// Two units at most: < 0.1 s, 0.4 s, 42 s, 3 min 05 s, 2 h 40 min, 3 d 4 h.
export function duration(seconds: number): string {
  if (seconds > 0 && seconds < 0.05) return "< 0.1 s";
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  const s = Math.round(seconds);
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${two(s % 60)} s`;
  const minutes = Math.floor(s / 60);
  if (minutes < 24 * 60) return `${Math.floor(minutes / 60)} h ${two(minutes % 60)} min`;
  const hours = Math.floor(minutes / 60);
  return `${Math.floor(hours / 24)} d ${hours % 24} h`;
}

/// 14:03:20
export const timeOfDay = (milliseconds: number): string => new Date(milliseconds).toLocaleTimeString("en-GB");

/// One unit: just now, 12 s ago, 3 min ago, 5 h ago, 2 d ago.
export function ago(seconds: number): string {
  if (seconds < 2) return "just now";
  if (seconds < 60) return `${Math.floor(seconds)} s ago`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  if (seconds < 24 * 3600) return `${Math.floor(seconds / 3600)} h ago`;
  return `${Math.floor(seconds / 24 / 3600)} d ago`;
}

/// Whole percents, rounded down: 100 only when all is there.
export function percent(done: number, total: number): number {
  return total > 0 ? Math.floor((100 * done) / total) : 0;
}

export function bytes(value: number): string {
  if (value < 1024) return `${value} bytes`;
  if (value < 1024 * 1024) return `${Math.round(value / 1024)} kB`;
  const mega = value / 1024 / 1024;
  return `${mega.toFixed(mega < 10 ? 1 : 0)} MB`;
}

/// 1 worker, 2 workers.
export function many(value: number, thing: string): string {
  return `${count(value)} ${thing}${value === 1 ? "" : "s"}`;
}
