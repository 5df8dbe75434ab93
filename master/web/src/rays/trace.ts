// The rays behind a pixel, as the master tells them (GET /jobs/ID/trace), and as one list.
import type { Vec3 } from "../app/types";

export type RayKind = "primary" | "reflected" | "refracted";
export type LightFate = "ambient" | "reached" | "blocked" | "behind";

export interface RayHit {
  leaf: number;
  name: string;
  distance: number;
  point: Vec3;
  normal: Vec3;
  surface_color: Vec3;
  entering: boolean;
}

/// A light as a hit sees it.
export interface LightAtHit {
  light: number;
  fate: LightFate;
  color: Vec3;
  at?: Vec3; // not for ambient light
  blocker?: { leaf: number; name: string; point: Vec3 };
}

export interface Untraced {
  kind: RayKind;
  weight: number;
  why: string;
}

export interface TracedRay {
  kind: RayKind;
  depth: number;
  weight: number;
  importance: number;
  origin: Vec3;
  direction: Vec3;
  color: Vec3;
  contribution: Vec3;
  end: "missed" | "depth" | "light" | "importance" | null;
  hit: RayHit | null;
  lights: LightAtHit[];
  glows?: { glow: number; color: Vec3 }[]; // what glow shells on the way added
  rays: TracedRay[];
  not_traced: Untraced[];
}

/// Along the ray; out is null where it never gets out.
export interface Stretch {
  in: number;
  out: number | null;
}

export interface CsgStory {
  leaves: { leaf: number; name: string; stretches: Stretch[] }[];
  material: Stretch[];
}

export interface TracedSample {
  sample: number | "centre";
  film: [number, number];
  color: Vec3;
  ray: TracedRay;
  csg: CsgStory;
}

export interface PixelTrace {
  pixel: [number, number];
  samples: TracedSample[];
  truncated?: boolean; // more rays than are told
}

/// A line of the ray tree: a ray, a light that its hit asks for, or a ray that was not traced. The id says the way
/// from the sample: "3.1.l0" is light 0 at the end of ray 1 of sample 3's primary ray.
interface Place {
  id: string;
  parent: string | null;
  level: number; // 0 for primary rays
  sample: number; // index into the trace's samples
}
export type RayEntry = Place & { what: "ray"; ray: TracedRay };
export type LightEntry = Place & { what: "light"; ray: TracedRay; light: LightAtHit };
export type UntracedEntry = Place & { what: "untraced"; untraced: Untraced };
export type Entry = RayEntry | LightEntry | UntracedEntry;

/// All lines, a parent before its children.
export function entriesOf(trace: PixelTrace): Entry[] {
  const entries: Entry[] = [];
  const append = (ray: TracedRay, id: string, parent: string | null, level: number, sample: number) => {
    entries.push({ what: "ray", id, parent, level, sample, ray });
    const below = { parent: id, level: level + 1, sample };
    ray.lights.forEach((light, i) =>
      entries.push({ what: "light", id: `${id}.l${i}`, ...below, ray, light }),
    );
    ray.rays.forEach((next, i) => append(next, `${id}.${i}`, id, level + 1, sample));
    ray.not_traced.forEach((untraced, i) =>
      entries.push({ what: "untraced", id: `${id}.u${i}`, ...below, untraced }),
    );
  };
  trace.samples.forEach((sample, i) => append(sample.ray, String(i), null, 0, i));
  return entries;
}

/// Of a ray below the primary ray of its sample: its place in depth-first order, a parent before its children, without
/// rays to lights; -1 when it is none of them.
export function rayNumberOf(primary: TracedRay, ray: TracedRay): number {
  const rays: TracedRay[] = [];
  const append = (next: TracedRay): void => {
    rays.push(next);
    next.rays.forEach(append);
  };
  append(primary);
  return rays.indexOf(ray);
}

export const kindWords: Record<RayKind, string> = {
  primary: "camera ray",
  reflected: "reflected ray",
  refracted: "refracted ray",
};

/// Why the ray's path goes no further; "followed" where it does.
export function endWords(ray: TracedRay): string {
  switch (ray.end) {
    case null:
      return "followed by further rays";
    case "missed":
      return "missed everything: the background";
    case "depth":
      return "the deepest recursion is reached";
    case "importance":
      return "what follows is of too little importance";
    case "light":
      return "the surface sends no further rays";
  }
}

export function fateWords(light: LightAtHit): string {
  switch (light.fate) {
    case "ambient":
      return "ambient";
    case "reached":
      return "reached";
    case "blocked":
      return light.blocker ? `blocked by ${light.blocker.name}` : "blocked right at the surface";
    case "behind":
      return "behind the surface";
  }
}
