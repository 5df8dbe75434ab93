import { listShare } from "../app/layout";
import { Splitter } from "../app/Splitter";
import { selectedId } from "../app/state";
import { JobDetails } from "./JobDetails";
import { JobList } from "./JobList";
import "./jobs.css";

export function JobColumn() {
  const withDetails = selectedId.value !== null;
  return (
    <div class="job-column" data-scope="jobs">
      <div class="part" style={{ flexGrow: withDetails ? listShare.value : 1 }}>
        <JobList />
      </div>
      {withDetails && (
        <>
          <Splitter
            label="Height of the job list"
            size={listShare}
            split="rows"
            unit="share"
            least={0.15}
            most={0.85}
            initial={0.5}
          />
          <div class="part" style={{ flexGrow: 1 - listShare.value }}>
            <JobDetails />
          </div>
        </>
      )}
    </div>
  );
}
