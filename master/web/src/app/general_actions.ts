// What the shell itself does on keys.
import { register } from "./actions";
import { helpShown } from "./Help";
import { columnShown, panelsShown, raysBeside, raysPlace } from "./layout";
import { openPalette } from "./Palette";
import { openSubmit, page } from "./route";
import { logOut, person } from "./session";
import { raysShown } from "./state";
import { toggleTheme } from "./theme";

export const registerGeneral = (): (() => void) =>
  register([
    {
      id: "palette",
      title: "Find an action, a layer or a job",
      group: "General",
      keys: ["Ctrl+K"],
      run: openPalette,
    },
    {
      id: "help",
      title: "Show all keys",
      group: "General",
      keys: ["?"],
      run: () => (helpShown.value = true),
    },
    {
      id: "panels",
      title: "Hide or show the panels",
      group: "General",
      keys: ["H", "Tab"],
      run: () => (panelsShown.value = !panelsShown.value),
    },
    {
      id: "column",
      title: "Hide or show the job column",
      group: "General",
      keys: ["Shift+H"],
      run: () => {
        columnShown.value = !columnShown.value;
        panelsShown.value = true;
      },
    },
    {
      id: "rays",
      title: "Hide or show the ray visualizer",
      group: "Rays",
      keys: ["V"],
      run: () => {
        raysShown.value = !raysShown.value;
        page.value = "jobs";
      },
    },
    {
      id: "rays-place",
      title: "Rays beside or below the picture",
      group: "Rays",
      keys: ["Shift+V"],
      enabled: () => raysShown.value,
      run: () => (raysPlace.value = raysBeside() ? "below" : "beside"),
    },
    { id: "theme", title: "Light or dark", group: "General", keys: ["Shift+T"], run: toggleTheme },
    {
      id: "page-jobs",
      title: "Go to the picture",
      group: "General",
      keys: ["Escape"],
      enabled: () => page.value !== "jobs",
      run: () => (page.value = "jobs"),
    },
    {
      id: "page-workers",
      title: "Go to the workers",
      group: "General",
      keys: ["Shift+W"],
      run: () => (page.value = "workers"),
    },
    {
      id: "log-out",
      title: "Log out",
      group: "General",
      keys: [],
      enabled: () => person.value !== null,
      run: logOut,
    },
    { id: "page-submit", title: "New job", group: "Jobs", keys: ["Shift+N"], run: () => openSubmit() },
  ]);
