const width = 72;
const height = 20;
const shown = 60; // values

/// The last minute as a line, from 0 to its highest.
export function Sparkline({ values, label }: { values: readonly number[]; label: string }) {
  const last = values.slice(-shown);
  const highest = Math.max(...last, 1e-9);
  const x = (index: number) => ((index + shown - last.length) / (shown - 1)) * width;
  const y = (value: number) => height - 1 - (value / highest) * (height - 2);
  const points = last.map((value, index) => `${x(index).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
  return (
    <svg class="sparkline" width={width} height={height} role="img" aria-label={label}>
      <polyline points={points} />
    </svg>
  );
}
