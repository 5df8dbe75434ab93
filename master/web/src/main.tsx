import { render } from "preact";
import { App } from "./app/App";
import { startClock } from "./app/clock";
import { registerGeneral } from "./app/general_actions";
import { startKeys } from "./app/keys";
import { goLive } from "./app/live";
import { startRouting } from "./app/route";
import { startTheme } from "./app/theme";
import { registerJobs } from "./jobs/job_actions";
import "./app/style.css";

startTheme();
startRouting();
startClock();
registerGeneral();
registerJobs();
startKeys();
goLive();
render(<App />, document.getElementById("app")!);
