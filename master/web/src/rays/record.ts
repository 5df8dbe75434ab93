// What is known of a ray, in words.
import { plain as short } from "../picture/format";
import type { Vec3 } from "../app/types";
import {
  endWords,
  fateWords,
  kindWords,
  type Entry,
  type LightEntry,
  type RayEntry,
  type TracedSample,
} from "./trace";
import { lengthOf, minus, times } from "./vec";

export interface Field {
  label: string;
  text: string;
  color?: Vec3; // linear, shown as a patch beside the text
}

const numbers = (v: Vec3): string => v.map((x) => short(x)).join(", ");
const field = (label: string, text: string): Field => ({ label, text });
const colored = (label: string, color: Vec3): Field => ({ label, text: numbers(color), color });

const capital = (text: string): string => text[0]!.toUpperCase() + text.slice(1);

/// "reflected ray → floor"
export function nameOf(entry: Entry): string {
  switch (entry.what) {
    case "ray":
      return `${kindWords[entry.ray.kind]} → ${entry.ray.hit?.name ?? "nothing"}`;
    case "light":
      return `light ${entry.light.light} ${fateWords(entry.light)}`;
    case "untraced":
      return `${kindWords[entry.untraced.kind]} not traced`;
  }
}

export function fieldsOf(entry: Entry, sample: TracedSample): Field[] {
  const [x, y] = sample.film;
  const where =
    sample.sample === "centre"
      ? "centre of the pixel"
      : `${sample.sample}, film ${short(x, 6)}, ${short(y, 6)}`;
  switch (entry.what) {
    case "ray":
      return [field("Ray", capital(nameOf(entry))), field("Sample", where), ...ofRay(entry)];
    case "light":
      return [field("Shadow ray", capital(nameOf(entry))), field("Sample", where), ...ofLight(entry)];
    case "untraced":
      return [
        field("Ray", capital(nameOf(entry))),
        field("Sample", where),
        field("Weight", short(entry.untraced.weight)),
        field("Why", entry.untraced.why === "importance" ? "too little importance" : entry.untraced.why),
      ];
  }
}

function ofRay({ ray }: RayEntry): Field[] {
  const { hit } = ray;
  const end = hit
    ? [
        field("End", numbers(hit.point)),
        field("Length", short(hit.distance, 6)),
        field("Solid", `${hit.name}, ${hit.entering ? "entering" : "leaving"}`),
        field("Normal", numbers(hit.normal)),
        colored("Surface", hit.surface_color),
      ]
    : [field("Direction", numbers(ray.direction))];
  return [
    field("Origin", numbers(ray.origin)),
    ...end,
    field("Depth", String(ray.depth)),
    field("Weight", short(ray.weight)),
    field("Importance", short(ray.importance)),
    colored("Colour", ray.color),
    ...(ray.glows ?? []).map(({ glow, color }) => colored(`Glow shell ${glow}`, color)),
    colored("Adds", ray.contribution),
    field("Ended", endWords(ray)),
  ];
}

function ofLight({ ray, light }: LightEntry): Field[] {
  const from = ray.hit!.point;
  const places = light.at
    ? [
        field("Origin", numbers(from)),
        field("Light at", numbers(light.at)),
        field("Distance", short(lengthOf(minus(light.at, from)))),
      ]
    : [];
  const blocker = light.blocker
    ? [
        field("Blocked by", light.blocker.name),
        field("Blocked at", numbers(light.blocker.point)),
        field("After", short(lengthOf(minus(light.blocker.point, from)))),
      ]
    : [];
  return [
    ...places,
    ...blocker,
    field("Importance", short(ray.importance)),
    colored("Colour", light.color),
    colored("Adds", times(light.color, ray.importance)),
    field("Ended", fateWords(light)),
  ];
}
