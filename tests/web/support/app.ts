// The app in headless Chromium, as a person would use it.
import { mkdirSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { type Browser, type Page, chromium } from "playwright-core";

const screenshots =
  process.env.RAYFARM_SCREENSHOTS ?? join(process.env.RAYFARM_BUILD ?? tmpdir(), "rayfarm-screenshots");

export interface App {
  page: Page;
  /// What the browser complained about, and requests to others than the master; a test of a healthy app expects it to
  /// be empty.
  complaints: string[];
  close(): Promise<void>;
}

interface View {
  width?: number;
  height?: number;
  dark?: boolean;
  density?: number; // screen pixels a CSS pixel
}

let browser: Browser | null = null;

export async function openApp(url: string, view: View = {}): Promise<App> {
  browser ??= await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--enable-unsafe-swiftshader"],
  });
  const context = await browser.newContext({
    viewport: { width: view.width ?? 1366, height: view.height ?? 768 },
    colorScheme: view.dark ? "dark" : "light",
    deviceScaleFactor: view.density ?? 1,
    acceptDownloads: true,
    ignoreHTTPSErrors: true, // of a farm's own authority
  });
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on("console", (message) => {
    // Reading frames back for screenshots makes the software renderer warn.
    if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver Message/.test(message.text()))
      complaints.push(message.text());
  });
  const judge = (asked: string): void => {
    if (new URL(asked).host !== new URL(url).host && !/^(blob|data):/.test(asked))
      complaints.push(`asks another host: ${asked}`);
  };
  page.on("request", (request) => judge(request.url()));
  page.on("websocket", (socket) => judge(socket.url()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(url);
  return { page, complaints, close: () => context.close() };
}

export async function closeBrowser(): Promise<void> {
  await browser?.close();
  browser = null;
}

/// For people to look at; those of tests/web/screenshots were made with RAYFARM_SCREENSHOTS=that folder.
export async function screenshot(page: Page, name: string): Promise<void> {
  mkdirSync(screenshots, { recursive: true });
  await page.screenshot({ path: join(screenshots, `${name}.png`) });
}
