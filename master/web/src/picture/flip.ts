// The FLIP error picture of two jobs, as the master paints it.
import { computed, effect, signal } from "@preact/signals";
import { urlOf } from "../app/api";
import { selectedJob, tellError } from "../app/state";
import { comparison, compares, framesQuery, metric, reference } from "./compare";
import { LayerData } from "./layer_data";

/// Of current and reference, once it is here.
export const flipPicture = signal<LayerData | null>(null);

/// It is to be shown but not here yet.
export const flipIsComing = computed(
  () => compares.value && comparison.value === "difference" && metric.value === "flip" && !flipPicture.value,
);

async function load(a: number, b: number, query: string, stop: AbortSignal): Promise<LayerData> {
  const response = await fetch(urlOf(`/jobs/${a}/difference/${b}/flip.png${query}`), { signal: stop });
  if (!response.ok) {
    const body = (await response.json().catch(() => ({}))) as { error?: string };
    throw new Error(body.error ?? `The FLIP picture: ${response.status} ${response.statusText}`);
  }
  const image = await createImageBitmap(await response.blob(), { colorSpaceConversion: "none" });
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext("2d")!;
  context.drawImage(image, 0, 0);
  return fromBytes(context.getImageData(0, 0, image.width, image.height));
}

function fromBytes(image: ImageData): LayerData {
  const data = new LayerData(image.width, image.height, 3, 1);
  const values = new Float32Array(image.width * image.height * 3);
  for (let i = 0; i < image.width * image.height; ++i)
    for (let c = 0; c < 3; ++c) values[i * 3 + c] = image.data[i * 4 + c]! / 255;
  data.put({ id: 0, x: 0, y: 0, width: image.width, height: image.height, stride: 1, channels: 3, values });
  return data;
}

export function startFlip(): () => void {
  return effect(() => {
    const [a, b] = [selectedJob.value, reference.value];
    flipPicture.value = null;
    if (comparison.value !== "difference" || metric.value !== "flip" || !a || !b) return;
    const stop = new AbortController();
    load(a.id, b.id, framesQuery.value, stop.signal).then(
      (data) => (flipPicture.value = data),
      (error: unknown) => {
        if (stop.signal.aborted) return;
        tellError(error);
        metric.value = "absolute";
      },
    );
    return () => stop.abort();
  });
}
