import { lazy } from "../app/lazy";
import { isShare, stored } from "../app/stored";
import { Splitter } from "../app/Splitter";
import { DialForm } from "./DialForm";
import { Log } from "./Log";
import { WorkerTable } from "./WorkerTable";
import "./workers.css";

const FarmChart = lazy("the chart", () => import("./FarmChart").then((part) => part.FarmChart));
const tableShare = stored("table-share", 0.6, isShare);

export function WorkersPage() {
  return (
    <div class="workers">
      <header>
        <h2>Farm, samples per second</h2>
        <DialForm />
      </header>
      <FarmChart />
      <div class="shared">
        <div class="part" style={{ flexGrow: tableShare.value }}>
          <WorkerTable />
        </div>
        <Splitter
          label="Height of the worker table"
          size={tableShare}
          split="rows"
          unit="share"
          least={0.15}
          most={0.85}
          initial={0.6}
        />
        <div class="part" style={{ flexGrow: 1 - tableShare.value }}>
          <Log />
        </div>
      </div>
    </div>
  );
}
