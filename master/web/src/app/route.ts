// The address after #: which page, which job, and how it is looked at; so that links and the back button work.
//   #/jobs/7?frame=12&layer=depth&reduce=mean    #/submit?from=7    #/workers
import { batch, effect, signal } from "@preact/signals";
import { chosenFrame } from "./frames";
import { layer, selectedId } from "./state";
import { type LayerChoice, reductions } from "./types";

export type Page = "jobs" | "submit" | "workers";
export type Query = Record<string, string>;

export interface Route {
  page: Page;
  job: number | null; // of the page "jobs"
  query: Query;
}

export function parse(hash: string): Route {
  const [path = "", query = ""] = hash.replace(/^#\/?/, "").split("?", 2);
  const [name, id] = path.split("/");
  const page: Page = name === "submit" || name === "workers" ? name : "jobs";
  const job = page === "jobs" && id !== undefined && /^\d{1,15}$/.test(id) ? Number(id) : null;
  return { page, job, query: Object.fromEntries(new URLSearchParams(query)) };
}

export function hashOf(route: Route): string {
  const job = route.page === "jobs" && route.job !== null ? `/${route.job}` : "";
  const query = new URLSearchParams(route.query).toString();
  return `#/${route.page}${job}${query ? `?${query}` : ""}`;
}

export function layerIn(query: Query): LayerChoice {
  const reduce = query.reduce ?? "";
  return {
    layer: query.layer ?? "picture",
    reduce: reductions.find((each) => each === reduce) ?? "majority",
    compat: query.compat === "1",
  };
}

export function queryOf(choice: LayerChoice): Query {
  return {
    ...(choice.layer === "picture" ? {} : { layer: choice.layer }),
    ...(choice.reduce === "majority" ? {} : { reduce: choice.reduce }),
    ...(choice.compat ? { compat: "1" } : {}),
  };
}

const frameQueryOf = (frame: number | null): Query => (frame === null ? {} : { frame: String(frame) });

/// Whether going from one to the other is a step that the back button undoes.
export function isStep(from: Route, to: Route): boolean {
  return from.page !== to.page || (from.job !== to.job && from.job !== null);
}

export const page = signal<Page>("jobs");
/// The job whose settings the form for a new one begins with.
export const cloned = signal<number | null>(null);
/// What else of the view is in the address: the picture's part, by keys of its own.
export const viewQuery = signal<Query>({});

export function openJob(id: number): void {
  selectedId.value = id;
  page.value = "jobs";
}
export function openSubmit(from: number | null = null): void {
  cloned.value = from;
  page.value = "submit";
}

/// To a page as it was left.
export function routeTo(to: Page): Route {
  switch (to) {
    case "workers":
      return { page: to, job: null, query: {} };
    case "submit":
      return { page: to, job: null, query: cloned.value === null ? {} : { from: String(cloned.value) } };
    case "jobs":
      return { page: to, job: selectedId.value, query: { ...queryOf(layer.value), ...frameQueryOf(chosenFrame.value), ...viewQuery.value } };
  }
}

function take(route: Route): void {
  page.value = route.page;
  if (route.page === "submit")
    cloned.value = /^\d+$/.test(route.query.from ?? "") ? Number(route.query.from) : null;
  if (route.page !== "jobs") return;
  const { layer: name, reduce, compat, frame, ...others } = route.query;
  chosenFrame.value = /^\d{1,10}$/.test(frame ?? "") ? Number(frame) : null;
  selectedId.value = route.job ?? selectedId.value;
  layer.value = layerIn({
    ...(name && { layer: name }),
    ...(reduce && { reduce }),
    ...(compat && { compat }),
  });
  viewQuery.value = others;
}

const restingTime = 200; // milliseconds

/// Until the result is called.
export function startRouting(): () => void {
  let known = ""; // the address as last read or written here
  let timer: ReturnType<typeof setTimeout> | undefined;
  const write = () => {
    const route = routeTo(page.value);
    const hash = hashOf(route);
    clearTimeout(timer);
    // Where a link has led is heard of later than it is in the address: it stays there.
    const put = (how: "pushState" | "replaceState") => {
      if (location.hash !== known) return;
      history[how](null, "", hash);
      known = location.hash;
    };
    if (hash === known) return;
    if (isStep(parse(known), route)) put("pushState");
    // Browsers limit how often; while the picture is moved only where it comes to rest counts.
    else timer = setTimeout(() => put("replaceState"), restingTime);
  };
  const follow = () => {
    known = location.hash;
    batch(() => take(parse(known)));
    write();
  };
  follow();
  addEventListener("hashchange", follow);
  const end = effect(write);
  return () => {
    end();
    clearTimeout(timer);
    removeEventListener("hashchange", follow);
  };
}
