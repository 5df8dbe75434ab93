// The farm at a glance: jobs, workers, and the selected job's picture as it comes together.
"use strict";

const api = "/api/v1";
const byId = (id) => document.getElementById(id);
let selected = null;      // id of the job whose picture is shown
let pictureState = "";    // what the shown picture was made of

async function get(path) {
  const response = await fetch(api + path);
  if (!response.ok) throw new Error((await response.json()).error);
  return response.json();
}

function row(cells) {
  const tr = document.createElement("tr");
  for (const cell of cells) {
    const td = document.createElement("td");
    td.append(cell);
    tr.append(td);
  }
  return tr;
}

function progress(job) {
  const bar = document.createElement("progress");
  bar.max = job.pixels_total;
  bar.value = job.pixels_done;
  const span = document.createElement("span");
  span.append(bar, ` ${Math.floor((100 * job.pixels_done) / job.pixels_total)} %`);
  return span;
}

const clock = (seconds) =>
  seconds === null ? "" : `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;

function jobRow(job) {
  const { width, height, spp } = job.settings;
  const tr = row([String(job.id), job.name, job.state, progress(job), clock(job.eta_seconds),
                  String(job.priority), `${width}\u00d7${height}`, String(spp)]);
  tr.tabIndex = 0;
  tr.title = job.message;
  tr.setAttribute("aria-selected", String(job.id === selected));
  tr.onclick = () => { selected = job.id; showPicture(job); };
  tr.onkeydown = (event) => { if (event.key === "Enter") tr.onclick(); };
  return tr;
}

function workerRow(worker) {
  const speed = worker.samples_per_second;
  return row([worker.name, worker.state, String(worker.threads), String(worker.tiles),
              speed > 0 ? Math.round(speed).toLocaleString() : "", worker.address]);
}

function showPicture(job) {
  byId("picture-section").hidden = job.pixels_done === 0;
  byId("picture-title").textContent = `Job ${job.id}: ${job.name}`;
  const state = `${job.id}-${job.pixels_done}`;
  if (job.pixels_done === 0 || state === pictureState) return;
  pictureState = state;
  const next = new Image();  // shown when it is whole, so that nothing flickers
  next.onload = () => { byId("picture").src = next.src; };
  next.src = `${api}/jobs/${job.id}/picture.png?state=${state}`;
  byId("picture").alt = `Picture of job ${job.id}, ${job.name}`;
}

function showJobs(jobs) {
  if (selected === null && jobs.length > 0) selected = jobs[jobs.length - 1].id;
  byId("jobs").replaceChildren(...jobs.map(jobRow).reverse());
  byId("no-jobs").hidden = jobs.length > 0;
  const job = jobs.find((one) => one.id === selected);
  if (job) showPicture(job);
}

// Asks again when there is news, and at least each two seconds for the workers' sake.
async function run() {
  let revision = 0;
  for (;;) {
    try {
      const news = await get(`/jobs?after=${revision}&wait=2`);
      revision = news.revision;
      showJobs(news.jobs);
      byId("workers").replaceChildren(...(await get("/workers")).workers.map(workerRow));
      byId("status").textContent = "connected";
    } catch (error) {
      byId("status").textContent = `the master does not answer: ${error.message}`;
      revision = 0;
    }
    await new Promise((done) => setTimeout(done, 300));
  }
}

run();
