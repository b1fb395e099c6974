// Reads tools from files, as `patchmill mill --tool` does (clients/cli/tool_file.cc): libraries of Fusion (.json), tool bits of
// FreeCAD (.fctb), tool tables of LinuxCNC (.tbl) and Patchmill's own (.json, docs/tool.json). What a file states becomes
// settings, so that it stands in the address.
import { brief } from "./text";

export interface FileTool {
  name: string;
  shape: string; // why it cannot be used; empty if it can
  settings: ReadonlyMap<string, string>; // by the name of the setting
  note: string;
}

type Json = Record<string, unknown>;

const inch = 25.4; // mm
const isObject = (value: unknown): value is Json => typeof value === "object" && value !== null && !Array.isArray(value);
const objectOf = (from: Json, key: string): Json => (isObject(from[key]) ? (from[key] as Json) : {});
const textOf = (from: Json, key: string): string => (typeof from[key] === "string" ? (from[key] as string) : "");
// Libraries write 0 for what they do not know.
function positiveOf(from: Json, key: string): number | undefined {
  const value = from[key];
  return typeof value === "number" && Number.isFinite(value) && value > 0 ? value : undefined;
}

// The shortest text of a length that a unit may have multiplied.
const written = (value: number): string => String(Number(value.toPrecision(12)));

class Tool {
  readonly #settings = new Map<string, string>();
  name = "";
  shape = "";
  note = "";

  set(name: string, value: number | undefined, unit = 1): void {
    if (value !== undefined) this.#settings.set(name, written(unit * value));
  }

  setHolder(segments: readonly (readonly [length: number, lower: number, upper: number])[]): void {
    if (segments.length > 0) this.#settings.set("holder", segments.map((s) => (s[1] === s[2] ? s.slice(0, 2) : s).map(written).join(",")).join(" "));
  }

  done(): FileTool {
    // Nobody has said how far above the tip the holder begins.
    if (!this.#settings.has("stickout") && this.#settings.delete("holder")) this.note += " The file states no stick-out, so its holder is left out.";
    if (this.shape === "" && !this.#settings.has("tool-diameter")) this.shape = "without a diameter";
    const number = this.#settings.get("tool-number");
    const diameter = this.#settings.get("tool-diameter");
    const name = [number === undefined ? "" : `T${number}`, this.name, diameter === undefined ? "" : `D ${brief(Number(diameter))}`].filter(Boolean).join(" ");
    return { name, shape: this.shape, settings: this.#settings, note: this.note.trim() };
  }
}

function segmentsOf(from: Json, key: string, unit: number): { list: [number, number, number][]; fault: string } {
  const object = objectOf(from, key);
  const own = textOf(object, "unit") === "inches" ? inch : textOf(object, "unit") === "millimeters" ? 1 : unit;
  const list: [number, number, number][] = [];
  for (const [k, segment] of (Array.isArray(object.segments) ? (object.segments as unknown[]) : []).entries()) {
    if (isObject(segment) && segment.height === 0) continue;
    const values = ["height", "lower-diameter", "upper-diameter"].map((name) => (isObject(segment) ? positiveOf(segment, name) : undefined));
    if (values.includes(undefined)) return { list, fault: `with segment ${k} of its ${key} unreadable` };
    list.push(values.map((v) => own * v!) as [number, number, number]);
  }
  return { list, fault: "" };
}

function fusionTool(from: Json): FileTool {
  const unit = textOf(from, "unit") === "inches" ? inch : 1;
  const tool = new Tool();
  tool.name = textOf(from, "description");
  tool.set("tool-number", positiveOf(objectOf(from, "post-process"), "number"));
  const geometry = objectOf(from, "geometry");
  const type = textOf(from, "type");
  if (type !== "ball end mill") tool.shape = type === "" ? "of no type" : type;
  else tool.set("tool-diameter", positiveOf(geometry, "DC"), unit);
  tool.set("flute-length", positiveOf(geometry, "LCF"), unit);
  const [shaft, holder] = [segmentsOf(from, "shaft", unit), segmentsOf(from, "holder", unit)];
  // The shank counts as a cylinder as wide as its widest segment.
  const shank = Math.max(unit * (positiveOf(geometry, "SFDM") ?? 0), ...shaft.list.flatMap(([, lower, upper]) => [lower, upper]));
  if (shank > 0) tool.set("shank-diameter", shank);
  tool.set("stickout", positiveOf(geometry, "LB"), unit);
  tool.setHolder(holder.list);
  if (tool.shape === "") tool.shape = shaft.fault || holder.fault;
  const presets = objectOf(from, "start-values").presets;
  if (Array.isArray(presets) && presets.length > 1) {
    tool.note = `The tool has ${presets.length} presets: state spindle speed and feeds yourself.`;
  } else if (Array.isArray(presets) && isObject(presets[0])) {
    tool.set("spindle", positiveOf(presets[0], "n"));
    tool.set("feed", positiveOf(presets[0], "v_f"), unit);
    tool.set("plunge-feed", positiveOf(presets[0], "v_f_plunge"), unit);
  }
  return tool.done();
}

// "6.0 mm", "0.25 in", or a number of mm.
function lengthOf(from: Json, key: string): number | undefined {
  const number = positiveOf(from, key);
  if (number !== undefined) return number;
  const match = /^([0-9.+\-eE]+)\s*(mm|in|inch|"|cm|)$/.exec(textOf(from, key).trim());
  const value = Number(match?.[1]);
  if (match === null || !(value > 0)) return undefined;
  return value * (match[2] === "cm" ? 10 : match[2] === "mm" || match[2] === "" ? 1 : inch);
}

function freecadTool(from: Json): FileTool {
  const parameters = objectOf(from, "parameter");
  const tool = new Tool();
  tool.name = textOf(from, "name");
  const shape = textOf(from, "shape").replace(/\.fcstd$/, "");
  if (!shape.toLowerCase().includes("ball")) tool.shape = shape === "" ? "of no shape" : shape;
  else tool.set("tool-diameter", lengthOf(parameters, "Diameter"));
  tool.set("flute-length", lengthOf(parameters, "CuttingEdgeHeight"));
  tool.set("shank-diameter", lengthOf(parameters, "ShankDiameter"));
  return tool.done();
}

const ownFields = {
  number: "tool-number",
  flute_length_mm: "flute-length",
  shank_diameter_mm: "shank-diameter",
  stickout_mm: "stickout",
  holder_clearance_mm: "holder-clearance",
  spindle_rpm: "spindle",
  feed_mm_per_min: "feed",
  plunge_feed_mm_per_min: "plunge-feed",
};

function ownTool(from: Json): FileTool {
  const tool = new Tool();
  tool.name = textOf(from, "name");
  const unknown = Object.keys(from).filter((key) => !(key in ownFields) && !["name", "ball_end", "holder", "coolant"].includes(key));
  if (unknown.length > 0) throw new Error(`The file is no tool: neither a library of Fusion ("data"), nor a tool bit of FreeCAD ("parameter"), nor Patchmill's own (docs/tool.json). It has "${unknown[0]!.slice(0, 40)}".`);
  tool.set("tool-diameter", positiveOf(objectOf(from, "ball_end"), "diameter_mm"));
  for (const [field, name] of Object.entries(ownFields)) tool.set(name, positiveOf(from, field));
  const holder = Array.isArray(from.holder) ? (from.holder as unknown[]) : [];
  const segments = holder.map((s) => ["length_mm", "lower_diameter_mm", "upper_diameter_mm"].map((key) => (isObject(s) ? (positiveOf(s, key) ?? 0) : 0)) as [number, number, number]);
  tool.setHolder(segments);
  return tool.done();
}

// "T1 P1 D6.0 Z+40.5 ;ball".
function tableTools(text: string): FileTool[] {
  const tools: FileTool[] = [];
  for (const [i, line] of text.split(/\r?\n/).entries()) {
    const [words = "", ...comment] = line.split(";");
    const tool = new Tool();
    let isTool = false;
    for (const word of words.split(/\s+/).filter(Boolean)) {
      const value = Number(word.slice(1));
      if (!/^[A-Za-z]/.test(word) || word.length < 2 || !Number.isFinite(value)) throw new Error(`Line ${i + 1}: "${word.slice(0, 30)}" is no letter with a number.`);
      const letter = word[0]!.toUpperCase();
      if (letter === "T") {
        tool.set("tool-number", value);
        isTool = true;
      } else if (letter === "D" && value > 0) tool.set("tool-diameter", value);
    }
    tool.name = comment.join(";").trim();
    if (isTool) tools.push(tool.done());
  }
  return tools;
}

// The tools of a file. It throws an error for the user if the file cannot be read.
export function readTools(name: string, text: string): FileTool[] {
  if (/\.tbl$/i.test(name)) return tableTools(text);
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch (error) {
    throw new Error(`The file is no JSON, and no tool table (.tbl): ${error instanceof Error ? error.message : ""}`);
  }
  if (!isObject(json)) throw new Error("The file is no tool: it is no JSON object.");
  if (Array.isArray(json.data)) return (json.data as unknown[]).filter(isObject).filter((t) => textOf(t, "type") !== "holder").map(fusionTool);
  if (isObject(json.parameter)) return [freecadTool(json)];
  return [ownTool(json)];
}
