/// The rays of the probed pixel in 3D, as a tree, and as spans. Loaded when it is first shown.
export function RaysArea() {
  return <section aria-label="Rays" />;
}
