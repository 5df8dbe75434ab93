// A selection's values as a table, in the form of the master's files: one line per image row, semicolons, after a
// line that says what it is; vectors as columns; what is not there yet is empty.
import type { LayerData, Rect } from "./layer_data";

export function numberText(value: number): string {
  if (Number.isNaN(value)) return "nan";
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  // The shortest text that reads back as the same float.
  for (let digits = 1; digits < 9; ++digits) {
    const short = Number(value.toPrecision(digits));
    if (Math.fround(short) === Math.fround(value)) return String(short);
  }
  return String(Number(value.toPrecision(9)));
}

export function csvOf(data: LayerData, area: Rect, title: string): string {
  const lines = [`# ${title}`];
  for (let y = area.y; y < area.y + area.height; ++y) {
    const cells: string[] = [];
    for (let x = area.x; x < area.x + area.width; ++x) {
      const values = data.at(x, y);
      for (let c = 0; c < data.channels; ++c) cells.push(values ? numberText(values[c]!) : "");
    }
    lines.push(cells.join(";"));
  }
  return lines.join("\n") + "\n";
}
