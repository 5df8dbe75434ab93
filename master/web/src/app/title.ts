// The tab's title: how far the farm is, also when another tab is looked at.
import { effect } from "@preact/signals";
import { percent } from "./format";
import { jobs } from "./state";

export function startTitle(): void {
  effect(() => {
    const running = jobs.value.find((job) => job.state === "running");
    document.title = running
      ? `${percent(running.pixels_done, running.pixels_total)} % ${running.name} - rayfarm`
      : "rayfarm";
  });
}
