import type { Vec3 } from "../app/types";

/// Of a linear colour, as a screen shows it. Source: IEC 61966-2-1.
export function cssOf(color: Vec3): string {
  const byte = (c: number) => Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  return `rgb(${color.map((c) => byte(Math.min(1, Math.max(0, c)))).join(" ")})`;
}
