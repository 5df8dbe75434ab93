import { signal } from "@preact/signals";
import type { Filter } from "./order";

/// Of the job list.
export const filter = signal<Filter>({ state: "all", text: "" });
