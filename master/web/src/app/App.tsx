import { PictureArea } from "../picture/PictureArea";

export function App() {
  return (
    <main>
      <PictureArea />
    </main>
  );
}
