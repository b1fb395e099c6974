// Makes the requests. They are those of the command line (clients/cli/job_options.cc, mill.cc), field by field, so that the
// same settings give the same bytes of a program.
import { create } from "@bufbuild/protobuf";
import { type SplitRegionsRequest, SplitRegionsRequestSchema } from "../gen/patchmill/v1/analysis_service_pb.js";
import { LengthUnit } from "../gen/patchmill/v1/geometry_pb.js";
import { type Job, JobSchema, Output, type Post, PostSchema } from "../gen/patchmill/v1/job_pb.js";
import { type ModelSource, ModelSourceSchema } from "../gen/patchmill/v1/model_pb.js";
import { type CheckModelRequest, CheckModelRequestSchema } from "../gen/patchmill/v1/model_service_pb.js";
import {
  BoundaryMode,
  CutDirection,
  EdgeRule,
  FeedsSchema,
  LeadsSchema,
  type Operation,
  OperationSchema,
  type RegionOverride,
  RegionOverrideSchema,
  type Selection,
  SelectionSchema,
  Strategy,
} from "../gen/patchmill/v1/operation_pb.js";
import { Coolant, type Tool, ToolSchema } from "../gen/patchmill/v1/tool_pb.js";
import { type GenerateProgramRequest, GenerateProgramRequestSchema } from "../gen/patchmill/v1/toolpath_service_pb.js";
import { isFile, type OwnPost, postTextOf } from "./own_post";
import type { Choice } from "./settings";
import { makePlacement, makeSetup } from "./setup";
import { flagOf, mustNumber, numberOf, numbersOf, pointOf, ringOf, SettingError, wireText, wordOf } from "./values";

export interface ModelFile {
  name: string;
  bytes: Uint8Array;
}

const statedFormats = ["bpt", "bv", "bez", "patches", "step", "stp", "p21", "iges", "igs"];
const cadFormats = ["step", "stp", "p21", "iges", "igs"];
export const knownEndings = [...statedFormats, "json", "pb"];

export const endingOf = (name: string): string => /\.([^./\\]+)$/.exec(name)?.[1]?.toLowerCase() ?? "";
export const isCad = (name: string): boolean => cadFormats.includes(endingOf(name));

const lengthUnits: Record<string, LengthUnit> = { "": LengthUnit.UNSPECIFIED, mm: LengthUnit.MILLIMETER, inch: LengthUnit.INCH, m: LengthUnit.METER };

export function makeSource(file: ModelFile, choice: Choice): ModelSource {
  const ending = endingOf(file.name);
  const skipFaces = choice.list("skip-face").map((id) => wireText(id, 200));
  const borderToleranceMm = numberOf(choice, "border-tolerance");
  const isDefault = skipFaces.length === 0 && borderToleranceMm === undefined;
  return create(ModelSourceSchema, {
    source: {
      case: "file",
      value: {
        content: file.bytes,
        // Others are known by their content.
        format: statedFormats.includes(ending) ? ending : "",
        lengthUnit: wordOf(choice, "length-unit", lengthUnits),
        ...(isDefault ? {} : { importOptions: { skipFaces, ...(borderToleranceMm === undefined ? {} : { borderToleranceMm }) } }),
      },
    },
  });
}

function makeHolder(text: string): { lengthMm: number; lowerDiameterMm: number; upperDiameterMm: number }[] {
  return text
    .split(/\s+/)
    .filter((t) => t !== "")
    .map((segment) => {
      const numbers = numbersOf(segment, [2, 3], "holder", "LENGTH,DIAMETER or LENGTH,LOWER,UPPER in mm");
      return { lengthMm: numbers[0]!, lowerDiameterMm: numbers[1]!, upperDiameterMm: numbers[numbers.length - 1]! };
    });
}

const coolants: Record<string, Coolant> = { off: Coolant.OFF, flood: Coolant.FLOOD, mist: Coolant.MIST, air: Coolant.AIR };
const defaultDiameter = 6;

// Spindle speed and feeds that nobody stated are those of the command line: 12000 rpm, 1200 and 400 mm/min at D 6.
export function defaultCuttingData(diameterMm: number, feed?: number): { spindle: number; feed: number; plunge: number } {
  const larger = Math.min(1, defaultDiameter / diameterMm);
  const smaller = Math.min(1, diameterMm / defaultDiameter);
  const third = feed !== undefined ? feed / 3 : Math.round(1200 * smaller) / 3;
  return { spindle: Math.max(1, Math.round(12000 * larger)), feed: Math.max(1, Math.round(1200 * smaller)), plunge: Math.max(1, Math.round(third)) };
}

function makeTool(choice: Choice): Tool {
  const diameterMm = numberOf(choice, "tool-diameter") ?? defaultDiameter;
  const number = numberOf(choice, "tool-number");
  const [spindle, feed, plunge] = [numberOf(choice, "spindle"), numberOf(choice, "feed"), numberOf(choice, "plunge-feed")];
  const usual = defaultCuttingData(diameterMm, feed);
  const tool = create(ToolSchema, {
    number: number ?? 1,
    numberIsDefault: number === undefined,
    cutter: { case: "ballEnd", value: { diameterMm } },
    coolant: wordOf(choice, "coolant", coolants),
    spindleRpm: spindle ?? usual.spindle,
    feedMmPerMin: feed ?? usual.feed,
    plungeFeedMmPerMin: plunge ?? usual.plunge,
    cuttingDataIsDefault: spindle === undefined || feed === undefined || plunge === undefined,
    holder: makeHolder(choice.get("holder")),
  });
  const lengths = { fluteLengthMm: "flute-length", shankDiameterMm: "shank-diameter", stickoutMm: "stickout", holderClearanceMm: "holder-clearance" };
  return Object.assign(tool, stated(choice, lengths));
}

const strategies: Record<string, Strategy> = { auto: Strategy.AUTO, contour: Strategy.CONTOUR, zigzag: Strategy.ZIGZAG };
const directions: Record<string, CutDirection> = { climb: CutDirection.CLIMB, conventional: CutDirection.CONVENTIONAL, either: CutDirection.EITHER };
const edgeRules: Record<string, EdgeRule> = { stop: EdgeRule.STOP, roll: EdgeRule.ROLL, extend: EdgeRule.EXTEND };
const modes: Record<string, BoundaryMode> = { contact: BoundaryMode.CONTACT, center: BoundaryMode.CENTER, inside: BoundaryMode.INSIDE, outside: BoundaryMode.OUTSIDE };

function makeSelection(choice: Choice): Selection | undefined {
  const [only, avoid, boundary] = [choice.list("only"), choice.list("avoid"), choice.list("boundary")];
  const millOutside = flagOf(choice, "outside");
  const offset = mustNumber(choice, "boundary-offset");
  const margin = mustNumber(choice, "avoid-margin");
  if (boundary.length === 0 && offset !== 0) throw new SettingError("boundary-offset", "The boundary has an offset, but there is no boundary.");
  if (avoid.length === 0 && margin !== 0) throw new SettingError("avoid-margin", "There is a distance to what is avoided, but nothing is avoided.");
  if (only.length + avoid.length + boundary.length === 0 && !millOutside) return undefined;
  const rings = boundary.map((text) => ringOf(text, "boundary"));
  return create(SelectionSchema, {
    patchIds: only.map((id) => wireText(id, 200)),
    avoidPatchIds: avoid.map((id) => wireText(id, 200)),
    ...(avoid.length === 0 ? {} : { avoidMarginMm: margin }),
    millOutside,
    ...(rings.length === 0
      ? {}
      : {
          boundaryXyMm: rings[0]!,
          moreBoundaryRings: rings.slice(1).map((xyMm) => ({ xyMm })),
          boundaryMode: wordOf(choice, "boundary-mode", modes),
          boundaryOffsetMm: offset,
        }),
  });
}

// "X,Y,Z:WORD[:WORD]".
function makeOverride(text: string): RegionOverride {
  const wrong = new SettingError("region", `"${text.slice(0, 60)}" must be X,Y,Z and then :off, or :auto, :contour, :zigzag, :angle=DEG, :scallop=MM.`);
  const [place = "", ...words] = text.split(":");
  if (words.length === 0) throw wrong;
  const change = create(RegionOverrideSchema, { at: pointOf(numbersOf(place, [3], "region", "X,Y,Z:off")) });
  for (const word of words) {
    const [name = "", value] = word.split("=", 2);
    if (value !== undefined) {
      const [number] = numbersOf(value, [1], "region", "a number");
      if (name === "angle") change.zigzagAngleDeg = number!;
      else if (name === "scallop") change.scallopMm = number!;
      else throw wrong;
    } else if (name === "off") change.skip = true;
    else if (name === "oneway" || name === "bothways") change.oneWayLines = name === "oneway";
    else if (Object.hasOwn(strategies, name)) change.strategy = strategies[name]!;
    else throw wrong;
  }
  return change;
}

// The fields whose settings are stated: an empty one has no field, so that the server's default counts.
function stated<K extends string>(choice: Choice, names: Record<K, string>): Partial<Record<K, number>> {
  const fields: Partial<Record<K, number>> = {};
  for (const [field, name] of Object.entries(names) as [K, string][]) {
    const value = numberOf(choice, name);
    if (value !== undefined) fields[field] = value;
  }
  return fields;
}

// How the tool comes onto passes, leaves them, and gets to the next one.
function makeMotion(choice: Choice): Pick<Operation, "leads" | "feeds"> {
  const leads = stated(choice, { radiusMm: "lead-radius", sweepDeg: "lead-sweep" });
  const feeds = stated(choice, { plungeAngleDeg: "plunge-angle", linkMmPerMin: "link-feed", leadMmPerMin: "lead-feed", cornerMmPerMin: "corner-feed" });
  return {
    leads: create(LeadsSchema, leads),
    feeds: create(FeedsSchema, { ...feeds, keepOnPasses: flagOf(choice, "keep-feed") }),
  };
}

function makeOperation(choice: Choice): Operation {
  const unreached = numberOf(choice, "max-unreached");
  if (unreached !== undefined && !(unreached >= 0 && unreached <= 100)) {
    throw new SettingError("max-unreached", `${unreached} must be in [0, 100] percent.`);
  }
  const selection = makeSelection(choice);
  return create(OperationSchema, {
    tool: makeTool(choice),
    scallopMm: mustNumber(choice, "scallop"),
    toleranceMm: mustNumber(choice, "tolerance"),
    stockToLeaveMm: mustNumber(choice, "leave"),
    steepAngleDeg: mustNumber(choice, "steep-angle"),
    strategy: wordOf(choice, "strategy", strategies),
    zigzagAngleDeg: mustNumber(choice, "zigzag-angle"),
    zigzagBendDeg: mustNumber(choice, "bend"),
    oneWayLines: flagOf(choice, "one-way"),
    contourSpirals: flagOf(choice, "spirals"),
    borderPasses: !flagOf(choice, "no-border-passes"),
    roundLines: !flagOf(choice, "no-round-lines"),
    zigzagAngleAuto: flagOf(choice, "auto-angle"),
    edgeRule: wordOf(choice, "edges", edgeRules),
    detail: mustNumber(choice, "detail"),
    contourDirection: wordOf(choice, "direction", directions),
    heights: {
      clearanceAboveMm: mustNumber(choice, "clearance"),
      highRapids: flagOf(choice, "high-rapids"),
      ...stated(choice, { floorZMm: "floor", topZMm: "top", approachGapMm: "approach-gap" }),
    },
    ...makeMotion(choice),
    acceptDepthMm: mustNumber(choice, "accept-depth"),
    ...(unreached === undefined ? {} : { maxUnreachedFraction: 0.01 * unreached }),
    ...(selection === undefined ? {} : { selection }),
    regionOverrides: choice.list("region").map(makeOverride),
  });
}

function makePost(choice: Choice, own: OwnPost | null): Post {
  const post = choice.get("post");
  return create(PostSchema, {
    ...(isFile(post) ? { postFile: postTextOf(post, own) } : { dialect: wireText(post, 100) }),
    ...(flagOf(choice, "no-arcs") ? { arcs: false } : {}),
    ...(flagOf(choice, "inch") ? { unit: LengthUnit.INCH } : {}),
    restartPoints: flagOf(choice, "restart-points"),
    ...stated(choice, { lineNumberStep: "line-numbers", controlDeviationMm: "control-deviation" }),
    programNumber: mustNumber(choice, "program-number"),
    workOffset: choice.get("work-offset"),
  });
}

function makeJob(file: ModelFile, choice: Choice): Job {
  return create(JobSchema, {
    source: makeSource(file, choice),
    setup: makeSetup(choice),
    operations: [makeOperation(choice)],
    name: wireText(file.name, 100),
  });
}

export function makeCheck(file: ModelFile, choice: Choice): CheckModelRequest {
  return create(CheckModelRequestSchema, {
    source: makeSource(file, choice),
    setup: makePlacement(choice),
    tool: { cutter: { case: "ballEnd", value: { diameterMm: numberOf(choice, "tool-diameter") ?? defaultDiameter } } },
    withFaces: true,
    withFacesPicture: true,
  });
}

export function makeSplit(file: ModelFile, choice: Choice): SplitRegionsRequest {
  return create(SplitRegionsRequestSchema, { job: makeJob(file, choice), outputs: [Output.REGIONS, Output.TESSELLATION] });
}

// Everything of a job is checked, and nothing is planned.
export function makeValidation(file: ModelFile, choice: Choice, own: OwnPost | null): GenerateProgramRequest {
  return create(GenerateProgramRequestSchema, { job: makeJob(file, choice), post: makePost(choice, own), validateOnly: true });
}

export function makeProgram(file: ModelFile, choice: Choice, own: OwnPost | null): GenerateProgramRequest {
  return create(GenerateProgramRequestSchema, {
    job: makeJob(file, choice),
    post: makePost(choice, own),
    outputs: [Output.PROGRESS, Output.PROGRAM, Output.REPORT, Output.PICTURE, Output.REGIONS, Output.PATH_BLOCKS, Output.TESSELLATION],
  });
}
