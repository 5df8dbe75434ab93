// Values of pixels as people read them.
import { duration } from "../app/format";

/// So many significant digits, no longer than needed; whole numbers as they are up to a million.
export function plain(value: number, digits = 4): string {
  if (Number.isNaN(value)) return "NaN";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e6) return minus(String(value));
  if (size >= 1e6 || size < 1e-4) return minus(Number(value.toPrecision(digits - 1)).toExponential());
  return minus(String(Number(value.toPrecision(digits))));
}

const minus = (text: string): string => text.replaceAll("-", "−");

/// With as many decimals at each number, for values under one another.
export function fixed(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return plain(value);
  return minus(value.toFixed(decimals));
}

/// For a field that takes numbers: five digits, no longer than there is room for.
export function fieldText(value: number): string {
  const short = Number(value.toPrecision(5));
  const size = Math.abs(short);
  return short !== 0 && (size < 1e-3 || size >= 1e7) ? short.toExponential() : String(short);
}

/// What the values of a range are typed in: times in a unit of their size, others as they are.
export function fieldUnit(unit: string, highest: number): { name: string; size: number } {
  if (unit !== "seconds") return { name: "", size: 1 };
  if (highest < 1e-3) return { name: "µs", size: 1e-6 };
  return highest < 1 ? { name: "ms", size: 1e-3 } : { name: "s", size: 1 };
}

/// Also of very short times, as a ray takes.
export function timeText(seconds: number): string {
  if (seconds === 0) return "0 s";
  if (seconds < 1e-3) return `${plain(seconds * 1e6, 3)} µs`;
  if (seconds < 1) return `${plain(seconds * 1e3, 3)} ms`;
  return duration(seconds);
}
