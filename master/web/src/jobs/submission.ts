// The form for a new job as values: what is typed, what is wrong with it in words, what is sent.
import { bytes, count } from "../app/format";
import { isAnimation } from "../app/frames";
import type { ImageDefaults, Job, JobFrames, Parameter } from "../app/types";

export type Source = "farm" | "script" | "job";
export type NumberName =
  "width" | "height" | "spp" | "seed" | "frame" | "max_depth" | "min_importance" | "priority";
export type SwitchName = "shadows" | "reflections" | "refractions";

export interface Form {
  source: Source;
  scene: string; // of the master's, by name
  script: { name: string; text: string };
  job: number | null; // whose scene it is
  parameters: Record<string, string>; // "" or missing: the default
  numbers: Record<NumberName, string>; // "": the scene's own, or the default
  frames: string; // "0-99:2" of an animation; "": the one of the numbers
  sampler: string;
  switches: Record<SwitchName, boolean>;
  name: string;
  verify: string; // of verifications
  hold: boolean;
}

/// What the chosen scene declares.
export interface Declared {
  parameters: Parameter[];
  image: ImageDefaults;
  animation: { start: number; stop: number; fps: number } | null;
}
export const nothingDeclared: Declared = {
  parameters: [],
  image: { width: null, height: null, spp: null },
  animation: null,
};

/// How far workers are believed, as the master has it, and in words.
export const verifications: Record<string, string> = {
  none: "are believed",
  "audit=0.01": "are checked, 1 % of the tiles",
  "audit=0.1": "are checked, 10 % of the tiles",
  "quorum=2": "render each tile twice",
};
export const samplers = ["sobol", "jitter", "regular", "random", "adapt1"];
export const largestScript = 1024 * 1024; // bytes
const mostMegapixels = 500;

interface Rule {
  label: string;
  least: number;
  most: number;
  whole: boolean;
  initial: number;
}
/// The limits are the master's (RenderSettings); the largest seed is the largest number that JSON keeps exact.
export const rules: Record<NumberName, Rule> = {
  width: { label: "Width", least: 1, most: 60_000, whole: true, initial: 640 },
  height: { label: "Height", least: 1, most: 60_000, whole: true, initial: 480 },
  spp: { label: "Samples per pixel", least: 1, most: 1 << 20, whole: true, initial: 16 },
  seed: { label: "Seed", least: 0, most: Number.MAX_SAFE_INTEGER, whole: true, initial: 0 },
  frame: { label: "Frame", least: 0, most: 0xffffffff, whole: true, initial: 0 },
  max_depth: { label: "Depth", least: 0, most: 100, whole: true, initial: 12 },
  min_importance: { label: "Least importance", least: 0, most: 1, whole: false, initial: 0.05 },
  priority: { label: "Priority", least: 0, most: 99, whole: true, initial: 50 },
};
export const numberNames = Object.keys(rules) as NumberName[];

export const emptyForm = (): Form => ({
  source: "farm",
  scene: "",
  script: { name: "", text: "" },
  job: null,
  parameters: {},
  numbers: {
    width: "",
    height: "",
    spp: "",
    seed: "",
    frame: "",
    max_depth: "",
    min_importance: "",
    priority: "",
  },
  frames: "",
  sampler: "sobol",
  switches: { shadows: true, reflections: true, refractions: true },
  name: "",
  verify: "none",
  hold: false,
});

const textOfFrames = ({ first, last, step }: JobFrames): string =>
  `${first}-${last}${step > 1 ? `:${step}` : ""}`;

/// A job's settings to be changed. The scene is the job's own; of a job that ended badly the master keeps none, and
/// those of an animation are made by its script: then the scene is chosen anew, first of all by the job's name.
export function formOf(job: Job): Form {
  const s = job.settings;
  const keepsScene = job.state !== "cancelled" && job.state !== "failed" && !isAnimation(job);
  const texts = Object.fromEntries(
    numberNames.map((name) => [name, String(name === "priority" ? job.priority : s[name])]),
  ) as Record<NumberName, string>;
  return {
    ...emptyForm(),
    source: keepsScene ? "job" : "farm",
    scene: job.name,
    job: keepsScene ? job.id : null,
    parameters: { ...job.parameters },
    numbers: texts,
    frames: isAnimation(job) ? textOfFrames(job.frames) : "",
    sampler: s.sampler,
    switches: { shadows: s.shadows, reflections: s.reflections, refractions: s.refractions },
    name: job.name,
    verify: job.verify in verifications ? job.verify : "none",
  };
}

/// What a number is when it is left empty.
export function defaultOf(name: NumberName, image: ImageDefaults): number {
  return (name in image ? image[name as keyof ImageDefaults] : null) ?? rules[name].initial;
}

function numberFault(
  text: string,
  label: string,
  whole: boolean,
  least: number | null,
  most: number | null,
): string | null {
  const value = Number(text);
  if (!Number.isFinite(value) || (whole && !/^[+-]?\d+$/.test(text.trim())))
    return `${label} must be ${whole ? "a whole number" : "a number"}, is "${text}".`;
  if (least !== null && value < least) return `${label} must be ${least} or more, is ${text}.`;
  if (most !== null && value > most)
    return `${label} must be ${whole ? count(most) : most} or less, is ${text}.`;
  return null;
}

export function parameterFault(parameter: Parameter, text: string): string | null {
  if (text === "") return null;
  const { name, type, min, max, choices } = parameter;
  if (type === "int" || type === "number") return numberFault(text, name, type === "int", min, max);
  if (type === "choice" && !choices.includes(text))
    return `${name} must be ${choices.join(" or ")}, is "${text}".`;
  return null;
}

/// The last frame of an animation; the first is 0. As the master counts.
export const lastFrame = ({ start, stop, fps }: NonNullable<Declared["animation"]>): number =>
  Math.floor((stop - start) * fps + 1e-6);

const mostFrames = 10_000; // of a job

/// "A-B" or "A-B:step"; null when it is neither.
export function framesOf(text: string): { first: number; last: number; step: number } | null {
  const parts = /^\s*(\d{1,9})\s*-\s*(\d{1,9})\s*(?::\s*(\d{1,9})\s*)?$/.exec(text);
  if (!parts) return null;
  return { first: Number(parts[1]), last: Number(parts[2]), step: Number(parts[3] ?? 1) };
}

function framesFault(text: string, animation: Declared["animation"]): string | null {
  const frames = framesOf(text);
  if (!frames) return `Frames are written as 0-99, or 0-99:2 for each second one, not "${text}".`;
  if (!animation) return "The scene has no animation: leave the frames empty.";
  if (frames.step === 0) return "The step must be 1 or more.";
  if (frames.last < frames.first) return "The first frame comes after the last.";
  if (frames.last > lastFrame(animation)) return `The animation's last frame is ${lastFrame(animation)}.`;
  if ((frames.last - frames.first) / frames.step >= mostFrames)
    return `A job has ${count(mostFrames)} frames at most.`;
  return null;
}

export type Faults = Partial<Record<string, string>>; // by field; a parameter p is "parameter p"

/// What is wrong with the form, in words; empty when it can be sent.
export function faultsOf(form: Form, declared: Declared): Faults {
  const faults: Faults = {};
  if (form.source === "farm" && form.scene === "") faults.source = "Choose a scene.";
  if (form.source === "script" && form.script.text.trim() === "")
    faults.source = "Choose a .lua file, or paste a script.";
  if (form.source === "script" && new Blob([form.script.text]).size > largestScript)
    faults.source = "The script is longer than 1 MB.";
  if (form.source !== "job")
    for (const parameter of declared.parameters) {
      const fault = parameterFault(parameter, form.parameters[parameter.name] ?? "");
      if (fault) faults[`parameter ${parameter.name}`] = fault;
    }
  for (const name of numberNames) {
    const text = form.numbers[name];
    const { label, whole, least, most } = rules[name];
    const fault = text.trim() === "" ? null : numberFault(text, label, whole, least, most);
    if (fault) faults[name] = fault;
  }
  const value = (name: NumberName) =>
    form.numbers[name].trim() === "" ? defaultOf(name, declared.image) : Number(form.numbers[name]);
  if (!faults.width && !faults.height && value("width") * value("height") > mostMegapixels * 1e6)
    faults.height = `A picture has ${mostMegapixels} megapixels at most; this one would have ${count((value("width") * value("height")) / 1e6)}.`;
  const root = Math.floor(Math.sqrt(value("spp")));
  if (!faults.spp && ["jitter", "regular", "adapt1"].includes(form.sampler) && root * root !== value("spp"))
    faults.spp = `${form.sampler} wants a square number of samples, as ${root * root} or ${(root + 1) * (root + 1)}.`;
  const fault = form.source === "job" || form.frames.trim() === "" ? null : framesFault(form.frames, declared.animation);
  if (fault) faults.frames = fault;
  if (form.name.length > 200) faults.name = "The name is longer than 200 characters.";
  return faults;
}

/// The body of POST /jobs. What was left empty is the master's to fill in.
export function bodyOf(form: Form, declared: Declared): Record<string, unknown> {
  const settings: Record<string, unknown> = { ...form.switches };
  if (form.sampler !== "sobol") settings.sampler = form.sampler;
  for (const name of numberNames)
    if (name !== "priority" && form.numbers[name].trim() !== "") settings[name] = Number(form.numbers[name]);
  const parameters = Object.fromEntries(
    declared.parameters
      .map(({ name }) => [name, form.parameters[name] ?? ""] as const)
      .filter(([, value]) => value !== ""),
  );
  const scenes: Record<Source, Record<string, unknown>> = {
    farm: { scene_name: form.scene, parameters },
    script: { script: form.script.text, script_name: form.script.name || "pasted.lua", parameters },
    job: { scene_of: form.job },
  };
  return {
    ...scenes[form.source],
    settings,
    ...(form.source !== "job" && form.frames.trim() !== "" && { frames: framesOf(form.frames) }),
    ...(form.name.trim() && { name: form.name.trim() }),
    ...(form.numbers.priority.trim() && { priority: Number(form.numbers.priority) }),
    ...(form.verify !== "none" && { verify: form.verify }),
    ...(form.hold && { hold: true }),
  };
}

/// Why a file is not taken, told from its name and size alone.
export function fileFault(file: { name: string; size: number }): string | null {
  if (file.size > largestScript) return `${file.name} has ${bytes(file.size)}; a script has 1 MB at most.`;
  if (!/\.lua$/i.test(file.name)) return `${file.name} is no .lua file.`;
  return null;
}
