// Which job is shown when nobody chose one yet.
import { effect } from "@preact/signals";
import { jobs, selectedId } from "../app/state";

/// The running one, else the newest.
export function startSelection(): void {
  effect(() => {
    if (selectedId.value !== null || jobs.value.length === 0) return;
    const running = jobs.value.find((job) => job.state === "running");
    selectedId.value = (running ?? jobs.value[jobs.value.length - 1]!).id;
  });
}
