import type { ComponentType } from "preact";
import { JobColumn } from "../jobs/JobColumn";
import { Submit } from "../jobs/Submit";
import { PictureArea } from "../picture/PictureArea";
import { WorkersPage } from "../workers/WorkersPage";
import { Confirm } from "./confirm";
import { Header } from "./Header";
import { Help } from "./Help";
import { columnShown, columnWidth, panelsShown, pictureShare, raysBeside } from "./layout";
import { lazy } from "./lazy";
import { Login } from "./Login";
import { LostBanner, Notices } from "./Notices";
import { Palette } from "./Palette";
import { page } from "./route";
import { Splitter } from "./Splitter";
import { raysShown } from "./state";
import "./layout.css";

const RaysArea: ComponentType = lazy("the rays", () =>
  import("../rays/RaysArea").then((part) => part.RaysArea),
);

export function App() {
  const withColumn = columnShown.value && panelsShown.value;
  return (
    <>
      <Header />
      <LostBanner />
      <div class="below-header">
        {withColumn && (
          <>
            <aside style={{ width: columnWidth.value }} aria-label="Jobs">
              <JobColumn />
            </aside>
            <Splitter
              label="Width of the job column"
              size={columnWidth}
              split="columns"
              unit="pixels"
              least={240}
              most={720}
              initial={340}
            />
          </>
        )}
        <main>
          <Viewer hidden={page.value !== "jobs"} />
          {page.value === "submit" && <Submit />}
          {page.value === "workers" && <WorkersPage />}
        </main>
      </div>
      <Notices />
      <Palette />
      <Help />
      <Confirm />
      <Login />
    </>
  );
}

/// Picture and rays; kept while other pages are shown, so that their views are found as they were left.
function Viewer({ hidden }: { hidden: boolean }) {
  const beside = raysBeside();
  const share = raysShown.value ? pictureShare.value : 1;
  return (
    <div class={`viewer ${beside ? "columns" : "rows"}`} hidden={hidden}>
      <div class="area" style={{ flexGrow: share }} data-scope="picture">
        <PictureArea />
      </div>
      {raysShown.value && (
        <>
          <Splitter
            label="Room of the picture beside the rays"
            size={pictureShare}
            split={beside ? "columns" : "rows"}
            unit="share"
            least={0.2}
            most={0.8}
            initial={0.5}
          />
          <div class="area" style={{ flexGrow: 1 - share }} data-scope="rays">
            <RaysArea />
          </div>
        </>
      )}
    </div>
  );
}
