/// The picture of the selected job with its maps, history and comparison.
export function PictureArea() {
  return <section aria-label="Picture" />;
}
