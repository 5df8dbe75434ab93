// Traces that `rayfarm trace --json` printed: see tests/data/traces.
import { readFileSync } from "node:fs";
import type { PixelTrace } from "../../../master/web/src/rays/trace";

const read = (name: string): PixelTrace =>
  JSON.parse(readFileSync(new URL(`../../data/traces/${name}.json`, import.meta.url), "utf8")) as PixelTrace;

/// One sample with reflected and refracted rays, through a solid with a piece taken out.
export const glass = read("glass");
/// All sixteen samples of a pixel at the edge of a ball.
export const edge = read("edge");
