// Hands on the form for a new job and on the job column.
import type { Locator, Page } from "playwright-core";

export const details = (page: Page): Locator => page.locator(".job-details");
export const submitButton = (page: Page): Locator => page.getByRole("button", { name: "Submit" });
export const listed = (page: Page): Locator => page.getByRole("listbox", { name: "Jobs" }).getByRole("option");

/// Fills the form for a job of the sphere flake, small unless told otherwise.
export async function fillForm(
  page: Page,
  job: { name: string; depth?: number; width?: number; height?: number; spp?: number; hold?: boolean },
): Promise<void> {
  await page.keyboard.press("Shift+N");
  await page.getByRole("radio", { name: "The master's scenes" }).check();
  await page.getByRole("radio", { name: /^sphere_flake/ }).check();
  await page.getByLabel("depth", { exact: true }).fill(String(job.depth ?? 2));
  await page.getByLabel("Width", { exact: true }).fill(String(job.width ?? 80));
  await page.getByLabel("Height", { exact: true }).fill(String(job.height ?? 60));
  await page.getByLabel("Samples per pixel").fill(String(job.spp ?? 4));
  await page.getByLabel("Name", { exact: true }).fill(job.name);
  await page.getByLabel("Hold").setChecked(job.hold ?? false);
}

/// Submits the form; the new job is chosen then.
export async function submit(page: Page, name: string): Promise<void> {
  await submitButton(page).click();
  await details(page).getByRole("heading", { name, exact: true }).waitFor();
}

/// Waits until the job that is chosen is in that state.
export const isNow = (page: Page, state: string): Promise<void> =>
  details(page).getByText(state, { exact: true }).waitFor();
