import { effect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { panelsShown } from "../app/layout";
import type { Watch } from "../app/types";
import { ComparePanel } from "./ComparePanel";
import { currentWatch, referenceWatch, shownEntry } from "./compare";
import { DisplayPanel } from "./DisplayPanel";
import { startFlip } from "./flip";
import { HistoryPanel } from "./HistoryPanel";
import { pinned } from "./history";
import { JobStatisticsPanel } from "./JobStatisticsPanel";
import { LayerBar } from "./LayerBar";
import { LegendPanel } from "./LegendPanel";
import { registerPicture } from "./picture_actions";
import { PictureCanvas } from "./PictureCanvas";
import { StatusLine } from "./StatusLine";
import { startStore, want } from "./store";
import { startCamera } from "./view_angle";
import { startView } from "./view_state";
import { ValuesPanel } from "./ValuesPanel";
import "./picture.css";
import "./side.css";

/// Asks for what is shown, what it is compared with, and what is pinned.
const startWanting = (): (() => void) =>
  effect(() => {
    const current = currentWatch.value;
    const others = current ? pinned.value.map((job): Watch => ({ ...current, job })) : [];
    want([current, referenceWatch.value, ...others].filter((each) => each !== null));
  });

/// The picture of the selected job with its maps, history and comparison.
export function PictureArea() {
  useEffect(() => {
    const stops = [startStore(), startView(), startWanting(), startFlip(), startCamera(), registerPicture()];
    return () => stops.forEach((stop) => stop());
  }, []);
  return (
    <section
      class="picture"
      aria-label="Picture"
      data-layer-state={shownEntry.value?.message.value?.state ?? "none"}
    >
      <LayerBar />
      <div class="picture-middle">
        <PictureCanvas />
        {panelsShown.value && (
          <div class="picture-side" role="complementary" aria-label="Settings and figures of the picture">
            <LegendPanel />
            <DisplayPanel />
            <ValuesPanel />
            <HistoryPanel />
            <ComparePanel />
            <JobStatisticsPanel />
          </div>
        )}
      </div>
      <StatusLine />
    </section>
  );
}
