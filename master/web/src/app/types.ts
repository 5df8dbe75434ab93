// The master's answers, as /api/v1/openapi.json describes them.

export type Vec3 = [number, number, number];

export type JobState = "waiting" | "running" | "paused" | "done" | "cancelled" | "failed";

export interface Settings {
  width: number;
  height: number;
  spp: number;
  sampler: string;
  seed: number;
  frame: number;
  max_depth: number;
  min_importance: number;
  shadows: boolean;
  reflections: boolean;
  refractions: boolean;
}

export interface Counters {
  primary: number;
  reflected: number;
  refracted: number;
  shadow: number;
  primary_hits: number;
  secondary_hits: number;
  rays: number;
  misses: number;
  lost: number;
  bad_samples: number;
}

/// Of a still first and last are the same.
export interface JobFrames {
  first: number;
  last: number;
  step: number;
  total: number;
  sent: number; // whose scenes have come
  done: number;
  current: number | null; // the first that is not done
}

export interface Job {
  id: number;
  name: string;
  output: string;
  state: JobState;
  message: string;
  priority: number;
  scene_hash: string;
  settings: Settings;
  parameters: Record<string, string>;
  frames: JobFrames;
  pixels_done: number;
  pixels_total: number;
  counters: Counters;
  age_seconds: number;
  elapsed_seconds: number;
  eta_seconds: number | null;
  tiles_given_back: number;
  tiles_doubled: number;
  tiles_shared: number;
  verify: string;
  tiles_checked: number;
  seconds_wasted: number;
  rays_wasted: number;
}

export interface Worker {
  name: string;
  kind: "local" | "remote";
  state: "idle" | "busy" | "drained" | "banned" | "dialling";
  message?: string;
  address: string;
  cpu: string;
  version: string;
  threads: number;
  leases: number;
  tiles: number;
  pixels: number;
  samples_per_second: number;
  age_seconds: number;
}

export interface LogLine {
  number: number;
  age_seconds: number;
  warning: boolean;
  worker: string;
  text: string;
}

export interface Parameter {
  name: string;
  type: "int" | "number" | "string" | "boolean" | "choice";
  default: string;
  help: string;
  choices: string[];
  min: number | null;
  max: number | null;
}

export interface ImageDefaults {
  width: number | null;
  height: number | null;
  spp: number | null;
}

export interface SceneEntry {
  name: string;
  title: string;
  script: string;
  error?: string;
  parameters: Parameter[];
  image: ImageDefaults;
  animation: { start: number; stop: number; fps: number } | null;
}

export type Scale = "depth" | "count" | "normal" | "label";

/// A map that the master can make of a job.
export interface MapEntry {
  name: string;
  title: string;
  unit: string;
  channels: number;
  scale: Scale;
  reduces: boolean;
  compat: boolean;
  help: string;
}

export const reductions = ["majority", "second", "third", "fourth", "mean", "closest", "median"] as const;
export type Reduction = (typeof reductions)[number];

/// What a picture view shows of a job: "picture" or a map.
export interface LayerChoice {
  layer: string;
  reduce: Reduction;
  compat: boolean;
}

export interface Watch extends LayerChoice {
  job: number;
  frame?: number; // of an animation
}

/// How a watched layer stands; `watch` is its place in the list of watches.
export interface LayerMessage {
  type: "layer";
  watch: number;
  id: number;
  job: number;
  frame?: number;
  layer: string;
  width: number;
  height: number;
  step: number;
  channels: number;
  state: "making" | "done" | "failed";
  progress: number;
  message: string;
  range: [number, number] | null;
  labels?: string[];
}

/// A part of a layer: the value at each stride-th pixel, which fills its square.
export interface TileMessage {
  id: number;
  x: number;
  y: number;
  width: number;
  height: number;
  stride: number;
  channels: number;
  values: Float32Array;
}
