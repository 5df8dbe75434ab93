// A real master with real workers on loopback, for the browser to look at.
import { type ChildProcess, execFile, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

const build = process.env.RAYFARM_BUILD ?? fileURLToPath(new URL("../../../build/tests", import.meta.url));
export const sceneFolder = fileURLToPath(new URL("../../../scenes", import.meta.url));

function program(name: string): string {
  return join(build, "bin", name);
}

/// Resolves with the first line that a program prints; rejects with what it said when it ends before.
function firstLine(child: ChildProcess): Promise<string> {
  return new Promise((resolve, reject) => {
    let out = "";
    let talk = "";
    child.stderr!.on("data", (text: Buffer) => (talk += text.toString()));
    child.stdout!.on("data", (text: Buffer) => {
      out += text.toString();
      const end = out.indexOf("\n");
      if (end >= 0) resolve(out.slice(0, end));
    });
    child.on("exit", (code) => reject(new Error(`ended with ${code}: ${talk}`)));
  });
}

async function ended(child: ChildProcess): Promise<void> {
  if (child.exitCode !== null || child.signalCode !== null) return;
  await new Promise((resolve) => child.once("exit", resolve));
}

export class Farm {
  readonly folder = mkdtempSync(join(tmpdir(), "rayfarm-web-"));
  url = "";
  private farmAddress = "127.0.0.1:0";
  private httpAddress = "127.0.0.1:0";
  private master: ChildProcess | null = null;
  private submitted = 0;
  private readonly workers = new Map<string, ChildProcess>();

  /// A started master; its own threads render too.
  static async start(options: { threads?: number; closed?: boolean } = {}): Promise<Farm> {
    const farm = new Farm(options.threads ?? 1, options.closed ?? false);
    await farm.startMaster();
    return farm;
  }
  private constructor(
    private readonly threads: number,
    private readonly closed: boolean, // encrypted, and asks also this PC for tokens
  ) {}

  /// Again at the same addresses, if it was started before.
  async startMaster(): Promise<void> {
    const args = ["--listen", this.farmAddress, "--http", this.httpAddress, "--threads", String(this.threads)];
    if (this.closed) args.push("--closed", "--state", this.file("state"));
    const child = spawn(program("rayfarm-master"), args, { stdio: ["ignore", "pipe", "pipe"] });
    this.master = child;
    const line = await firstLine(child); // rayfarm-master: workers 127.0.0.1:1, http http://127.0.0.1:2
    const said = /workers (\S+), http (https?:\/\/(\S+))/.exec(line);
    if (!said) throw new Error(`what is this? ${line}`);
    [, this.farmAddress, this.url, this.httpAddress] = said as unknown as [string, string, string, string];
  }

  async stopMaster(signal: NodeJS.Signals = "SIGTERM"): Promise<void> {
    const child = this.master;
    this.master = null;
    if (!child) return;
    child.kill(signal);
    await ended(child);
  }

  addWorker(name: string, threads = 1): void {
    const args = ["--master", this.farmAddress, "--name", name, "--threads", String(threads)];
    this.workers.set(name, spawn(program("rayfarm-worker"), args, { stdio: "ignore" }));
  }

  /// Runs the command against this master; what it printed. Rejects unless it exits with 0.
  async rayfarm(...args: string[]): Promise<string> {
    const env: NodeJS.ProcessEnv = { ...process.env, RAYFARM_MASTER: this.url };
    if (this.closed) env.RAYFARM_TOKEN_FILE = this.file("state/admin.token");
    const { stdout } = await promisify(execFile)(program("rayfarm"), args, {
      env,
      cwd: this.folder,
      maxBuffer: 256 * 1024 * 1024,
    });
    return stdout;
  }

  /// Submits a scene of the tree, with the settings of `rayfarm submit`; the job's number.
  async submit(scene: string, ...settings: string[]): Promise<number> {
    const output = ["-o", this.file(`job-${++this.submitted}.exr`)];
    const script = join(sceneFolder, `${scene}.lua`);
    return (JSON.parse(await this.rayfarm("submit", script, ...output, ...settings, "--json")) as { id: number }).id;
  }
  /// The same, and waits for its end.
  render(scene: string, ...settings: string[]): Promise<number> {
    return this.submit(scene, ...settings, "--wait");
  }

  file(name: string): string {
    return join(this.folder, name);
  }

  async stop(): Promise<void> {
    for (const child of this.workers.values()) child.kill("SIGKILL");
    await Promise.all([...this.workers.values()].map(ended));
    await this.stopMaster();
    rmSync(this.folder, { recursive: true, force: true });
  }
}
