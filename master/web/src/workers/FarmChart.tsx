import { effect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { short, timeOfDay } from "../app/format";
import { theme } from "../app/theme";
import { rates } from "./throughput";

const shown = 300; // seconds

function chartIn(element: HTMLElement): uPlot {
  const color = (name: string) => {
    // A custom property is text; only where it is used does light-dark() become a colour.
    const probe = element.appendChild(document.createElement("i"));
    probe.style.color = `var(${name})`;
    const value = getComputedStyle(probe).color;
    probe.remove();
    return value;
  };
  const axis = {
    stroke: color("--quiet"),
    font: "11px system-ui",
    ticks: { show: false },
    grid: { stroke: color("--line"), width: 1 },
  };
  const chart = new uPlot(
    {
      width: element.clientWidth,
      height: element.clientHeight,
      legend: { show: false },
      cursor: { show: false },
      padding: [8, 32, 0, 0],
      scales: {
        x: {
          range(_, __, newest: number | null) {
            const last = newest || Date.now() / 1000;
            return [last - shown, last];
          },
        },
        y: { range: (_, __, most) => [0, Math.max(most, 100) * 1.05] },
      },
      axes: [
        { ...axis, size: 22, space: 80, values: (_, times) => times.map((seconds) => timeOfDay(1000 * seconds)) },
        { ...axis, size: 58, space: 28, values: (_, values) => values.map(short) },
      ],
      series: [
        {},
        { stroke: color("--accent"), fill: color("--chosen"), width: 1.5, points: { show: false } },
      ],
    },
    [[], []],
    element,
  );
  return chart;
}

/// Samples a second of the whole farm in the last minutes.
export function FarmChart() {
  const element = useRef<HTMLDivElement>(null);
  const { value: shade } = theme;
  useEffect(() => {
    const chart = chartIn(element.current!);
    const follow = effect(() => chart.setData([rates.value.times, rates.value.farm]));
    const sized = new ResizeObserver(([entry]) =>
      chart.setSize({ width: entry!.contentRect.width, height: entry!.contentRect.height }),
    );
    sized.observe(element.current!);
    return () => {
      sized.disconnect();
      follow();
      chart.destroy();
    };
  }, [shade]);
  return (
    <div
      class="farm-chart"
      ref={element}
      role="img"
      aria-label="Samples a second of the farm in the last five minutes"
    />
  );
}
