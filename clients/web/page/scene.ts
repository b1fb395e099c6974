// Makes the scene that the viewer shows out of the answers, as the command line does (clients/cli/scene.cc).
import type { Report } from "../gen/patchmill/v1/report_pb.js";
import { Outcome } from "../gen/patchmill/v1/report_pb.js";
import type { Diagnostic } from "../gen/patchmill/v1/diagnostic_pb.js";
import { BorderKind, type BorderLine, type Region, RegionKind, type RegionMap, Slope, UnreachableReason } from "../gen/patchmill/v1/region_pb.js";
import type { Setup } from "../gen/patchmill/v1/setup_pb.js";
import type { Tool } from "../gen/patchmill/v1/tool_pb.js";
import { ArcPlane, type MeshBlock, type PathBlock } from "../gen/patchmill/v1/toolpath_pb.js";
import { joined, SceneBuffers } from "./scene_buffers";
import { fixed, severityName, shortName, uncutShare } from "./text";

export interface SceneSource {
  title: string;
  version: string; // of the server; empty if it is not known
  setup: Setup | undefined;
  tool: Tool | undefined;
  tolerance: number;
  scallop: number;
  steepAngle: number;
  regions: RegionMap | undefined;
  mesh: MeshBlock[];
  paths: PathBlock[];
  program: Uint8Array | null;
  report: Report | null;
  findings: Diagnostic[];
}

// A header as the viewer reads it, and its block.
export interface PackedScene {
  header: Record<string, unknown>;
  block: ArrayBuffer;
  surfaces: string[];
}

type Rgb = [number, number, number];

const reasonColors: Partial<Record<UnreachableReason, Rgb>> = {
  [UnreachableReason.CONCAVE]: [150, 120, 165],
  [UnreachableReason.FLOOR]: [165, 150, 105],
  [UnreachableReason.SHANK]: [95, 145, 140],
  [UnreachableReason.HOLDER]: [70, 110, 150],
  [UnreachableReason.OUTSIDE]: [175, 175, 180],
};

export function colorOf(region: Region): string {
  const isSteep = region.slope === Slope.STEEP;
  let rgb: Rgb = [120, 120, 120];
  if (region.kind === RegionKind.MOUNTAIN) rgb = isSteep ? [230, 120, 95] : [250, 205, 175];
  else if (region.kind === RegionKind.BASIN) rgb = isSteep ? [95, 145, 225] : [180, 212, 250];
  else if (region.kind === RegionKind.NEUTRAL) rgb = isSteep ? [120, 185, 110] : [205, 232, 195];
  else rgb = reasonColors[region.unreachableReason] ?? rgb;
  if (region.unreachableReason === UnreachableReason.STRATEGY) rgb = [245, 220, 90];
  const shift = ((region.id % 3) - 1) * 9;
  return `#${rgb.map((c) => Math.min(255, Math.max(0, c + shift)).toString(16).padStart(2, "0")).join("")}`;
}

// A forced strategy leaves its mark on regions that passes cross; those are reached.
function isUnreached(region: Region): boolean {
  return region.kind === RegionKind.UNREACHABLE;
}

export function regionName(region: Region): string {
  if (isUnreached(region)) {
    return `${shortName(UnreachableReason, region.unreachableReason)}: ${fixed(region.areaMm2, 1)} mm2, ${fixed(region.deepestLeftoverMm, 2)} mm stays`;
  }
  return `${shortName(RegionKind, region.kind)}, ${shortName(Slope, region.slope)}`.toLowerCase() + `: ${fixed(region.areaMm2, 1)} mm2`;
}

// Regions that are not cut are grey.
const skippedColor = "#b9bec4";
const isCut = (region: Region): boolean => !region.skipped && (region.areaMm2 === 0 || region.selectedAreaMm2 > 0);

function regionItems(map: RegionMap | undefined): unknown[] {
  return (map?.regions ?? []).map((region) => {
    const note = isCut(region) ? "" : region.skipped ? ", off" : ", not selected";
    return {
      id: region.id,
      name: `${region.id} ${regionName(region)}${note}`,
      color: isCut(region) ? colorOf(region) : skippedColor,
      unreachable: isUnreached(region) ? shortName(UnreachableReason, region.unreachableReason) : "",
    };
  });
}

function lengthOf({ pointsMm: p, closed }: BorderLine): number {
  let sum = 0;
  const count = p.length / 3;
  for (let i = closed ? 0 : 1; i < count; i++) {
    const [a, b] = [3 * ((i + count - 1) % count), 3 * i];
    sum += Math.hypot(p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!);
  }
  return sum;
}

const borderColors: Partial<Record<BorderKind, string>> = {
  [BorderKind.SLOPE]: "#c2410c",
  [BorderKind.CURVATURE]: "#0f766e",
  [BorderKind.SILHOUETTE]: "#7c3aed",
  [BorderKind.WATERSHED]: "#1d4ed8",
  [BorderKind.SEAM]: "#be185d",
  [BorderKind.STRATEGY]: "#854d0e",
  [BorderKind.OPEN_EDGE]: "#808080",
};

function addBorders(map: RegionMap | undefined, buffers: SceneBuffers): unknown[] {
  const lines = map?.borderLines ?? [];
  const lengths = new Map<BorderKind, number>();
  for (const line of lines) lengths.set(line.kind, (lengths.get(line.kind) ?? 0) + lengthOf(line));
  const items: unknown[] = [];
  const positions: number[] = [];
  for (const line of lines) {
    const { pointsMm: p, kind, closed } = line;
    if (p.length < 6) continue;
    const name = shortName(BorderKind, kind).toLowerCase().replaceAll("_", " ");
    items.push({
      name: `${name}: ${fixed(lengths.get(kind)!, 1)} mm`,
      color: borderColors[kind] ?? "#303030",
      first: positions.length / 3,
      count: p.length / 3 + (closed ? 1 : 0),
    });
    for (const v of p) positions.push(v);
    if (closed) positions.push(p[0]!, p[1]!, p[2]!);
  }
  buffers.add("border.position", Float32Array.from(positions));
  return items;
}

export interface Box {
  min: [number, number, number];
  max: [number, number, number];
}

function boxOf(position: Float32Array): Box {
  const min: Box["min"] = [Infinity, Infinity, Infinity];
  const max: Box["max"] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < position.length; i++) {
    const [k, v] = [i % 3, position[i]!];
    if (v < min[k]!) min[k] = v;
    if (v > max[k]!) max[k] = v;
  }
  return { min, max };
}

function addMesh(blocks: MeshBlock[], buffers: SceneBuffers): { surfaces: string[]; box: Box } {
  const position = joined(Float32Array, blocks, (b) => b.positionMm);
  const curvature = joined(Float32Array, blocks, (b) => b.contourCurvaturePerMm);
  // The page counts outward bends as positive.
  for (let i = 0; i < curvature.length; i++) curvature[i] = -curvature[i]!;
  const index = joined(Uint32Array, blocks, (b) => b.corners);
  let first = 0;
  let at = 0;
  for (const block of blocks) {
    for (let i = 0; i < block.corners.length; i++) index[at++]! += first;
    first += block.slopeDeg.length;
  }
  const surface = joined(Uint32Array, blocks, (b) => b.patchIndex);
  const surfaces: string[] = [];
  for (const { patchNames } of blocks) for (const name of patchNames) surfaces.push(name === "" ? `patch ${surfaces.length}` : name);
  const patches = surface.reduce((most, s) => Math.max(most, s + 1), 0);
  while (surfaces.length < patches) surfaces.push(`patch ${surfaces.length}`);
  const leftover = joined(Float32Array, blocks, (b) => b.leftoverMm);
  const gouge = joined(Float32Array, blocks, (b) => b.gougeMm);
  buffers.add("mesh.position", position);
  buffers.add("mesh.normal", joined(Float32Array, blocks, (b) => b.normal));
  buffers.add("mesh.slope", joined(Float32Array, blocks, (b) => b.slopeDeg));
  buffers.add("mesh.curvature", curvature);
  if (leftover.length > 0) buffers.add("mesh.leftover", leftover);
  if (gouge.length > 0) buffers.add("mesh.gouge", gouge);
  buffers.add("mesh.index", index);
  buffers.add("mesh.region", joined(Int32Array, blocks, (b) => b.regionId));
  buffers.add("mesh.surface", surface);
  return { surfaces, box: boxOf(position) };
}

const passNames = ["zig-zag", "contour", "border", "pencil", "rest"];
const betweenPasses = 255;

function addPaths(blocks: PathBlock[], buffers: SceneBuffers): { sections: unknown[]; passes: string[] } {
  const sections: unknown[] = [];
  const kind = joined(Uint8Array, blocks, (b) => b.kind);
  const passKind = new Uint8Array(kind.length).fill(betweenPasses);
  const region = new Int32Array(kind.length).fill(-1);
  const pass = new Int32Array(kind.length).fill(-1);
  const arcMove: number[] = [];
  const arcPlane: number[] = [];
  let last = "";
  let move = 0;
  let isKnown = false;
  for (const block of blocks) {
    for (let i = 0; i < block.line.length; i++, move++) {
      const k = block.passKind[i] ?? 0;
      if (k > 0) passKind[move] = k - 1;
      isKnown ||= k > 0;
      region[move] = block.regionId[i] ?? -1;
      pass[move] = block.passIndex[i] ?? -1;
      // A section begins where the region or the kind of the passes changes.
      const key = `${k} ${region[move]}`;
      if (k > 0 && key !== last) {
        last = key;
        const passes = `${passNames[k - 1] ?? "other"} passes`;
        sections.push({ name: region[move]! < 0 ? passes : `region ${region[move]}: ${passes}`, first_move: move });
      }
      const plane = block.arcPlane[i] ?? ArcPlane.UNSPECIFIED;
      if (plane === ArcPlane.UNSPECIFIED) continue;
      arcMove.push(move);
      arcPlane.push(plane);
    }
  }
  const passes = isKnown ? passNames : [];
  if (kind.length === 0) return { sections, passes };
  buffers.add("path.tip", joined(Float32Array, blocks, (b) => b.tipMm));
  buffers.add("path.kind", kind);
  buffers.add("path.pass_kind", passKind);
  buffers.add("path.region", region);
  buffers.add("path.pass", pass);
  buffers.add("path.feed", joined(Float32Array, blocks, (b) => b.feedMmPerMin));
  buffers.add("path.seconds", joined(Float32Array, blocks, (b) => b.seconds));
  buffers.add("path.line", joined(Uint32Array, blocks, (b) => b.line));
  if (arcMove.length > 0) {
    buffers.add("arc.move", Uint32Array.from(arcMove));
    buffers.add("arc.plane", Uint8Array.from(arcPlane));
    buffers.add("arc.center", joined(Float32Array, blocks, (b) => b.arcCenterMm));
    buffers.add("arc.turns", joined(Float32Array, blocks, (b) => b.arcTurns));
  }
  return { sections, passes };
}

function toolItem(tool: Tool | undefined): unknown {
  const diameter = tool?.cutter.value?.diameterMm ?? 6;
  const profile: [number, number][] = [];
  let height = 0;
  for (const { lengthMm, lowerDiameterMm, upperDiameterMm } of tool?.holder ?? []) {
    profile.push([height, lowerDiameterMm / 2]);
    height += lengthMm;
    profile.push([height, upperDiameterMm / 2]);
  }
  return {
    ball_diameter: diameter,
    flute_length: tool?.fluteLengthMm ?? null,
    shank_diameter: tool?.shankDiameterMm ?? diameter,
    holder: profile.length === 0 ? null : { stickout: tool?.stickoutMm ?? 0, profile },
  };
}

function pairs(xy: readonly number[]): [number, number][] {
  return Array.from({ length: xy.length >> 1 }, (_, i) => [xy[2 * i]!, xy[2 * i + 1]!]);
}

// The stock has no lower end; it is drawn down to the lowest point of the part. A stock with a model of its own is drawn as the box of that.
function stockItem({ setup, report }: SceneSource, part: Box): unknown {
  const stock = setup?.stock;
  if (stock?.body.case === undefined) return null;
  const top = report?.setupSheet?.stockTopZMm ?? stock.topZMm ?? part.max[2];
  const item = (outline: [number, number][]): unknown => ({ bottom: part.min[2], top, outline });
  if (stock.body.case === "model") {
    const { min, max } = report?.setupSheet?.stockModelBox ?? {};
    if (min === undefined || max === undefined) return null;
    return item([[min.xMm, min.yMm], [max.xMm, min.yMm], [max.xMm, max.yMm], [min.xMm, max.yMm]]);
  }
  if (stock.body.case === "block") {
    const { marginMm: m } = stock.body.value;
    const [x0, x1, y0, y1] = [part.min[0] - m, part.max[0] + m, part.min[1] - m, part.max[1] + m];
    return item([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]);
  }
  if (stock.body.case === "outline") return item(pairs(stock.body.value.outlineXyMm));
  const { diameterMm, centerXyMm } = stock.body.value;
  const [x, y] = centerXyMm.length === 2 ? centerXyMm : [(part.min[0] + part.max[0]) / 2, (part.min[1] + part.max[1]) / 2];
  const corners = 96;
  const at = (k: number): [number, number] => {
    const angle = (2 * Math.PI * k) / corners;
    return [x! + (diameterMm / 2) * Math.cos(angle), y! + (diameterMm / 2) * Math.sin(angle)];
  };
  return item(Array.from({ length: corners }, (_, k) => at(k)));
}

function clampItems(setup: Setup | undefined): unknown[] {
  return (setup?.obstacles ?? []).map(({ id, outlineXyMm, topZMm }, k) => ({
    name: id === "" ? `obstacle #${k}` : id,
    outline: pairs(outlineXyMm),
    top: topZMm,
  }));
}

// The figures of the summary of `mill`, in its words.
export function figuresOf(report: Report): [string, string][] {
  const rows: [string, string][] = [
    ["largest gouge", `${fixed(report.maxGougeMm, 4)} mm`],
    ["largest leftover", `${fixed(report.maxLeftoverMm, 4)} mm`],
    ["not reached", uncutShare(report)],
    ["lowest tip", `Z ${fixed(report.tipZMinMm, 4)}`],
    ["feed length", `${fixed(report.cutLengthMm / 1000, 2)} m`],
    ["rapid length", `${fixed(report.rapidLengthMm / 1000, 2)} m`],
  ];
  if (report.estimatedTimeS > 0) rows.push(["time", `${fixed(report.estimatedTimeS / 60, 1)} min (${report.timeBasis})`]);
  rows.push(["retracts", String(report.retractCount)], ["stick-out at least", `${fixed(report.requiredStickoutMm, 1)} mm`]);
  const offset = report.setupSheet?.workOffset ?? "";
  if (offset !== "") rows.push(["work offset", offset]);
  return rows;
}

function findingItem({ severity, code, message, where }: Diagnostic): unknown {
  const p = where?.point;
  return { severity: severityName(severity), code, message, point: p === undefined ? null : [p.xMm, p.yMm, p.zMm] };
}

// The triangles of a scene: corners, and three of them for each.
export function trianglesOf({ header, block }: PackedScene): { position: Float32Array; index: Uint32Array } {
  const table = header.buffers as SceneBuffers["table"];
  const [position, index] = [table["mesh.position"]!, table["mesh.index"]!];
  return { position: new Float32Array(block, position.offset, position.count), index: new Uint32Array(block, index.offset, index.count) };
}

export function packScene(source: SceneSource): PackedScene {
  const buffers = new SceneBuffers();
  const { surfaces, box } = addMesh(source.mesh, buffers);
  const borders = addBorders(source.regions, buffers);
  const { sections, passes } = addPaths(source.paths, buffers);
  if (source.program !== null && source.program.length > 0) buffers.add("program.text", source.program);
  const { report } = source;
  const header = {
    version: 1,
    title: source.title,
    made_by: `patchmill ${source.version}`.trim(),
    outcome: report === null || report.outcome === Outcome.UNSPECIFIED ? "" : shortName(Outcome, report.outcome),
    time_basis: report?.timeBasis ?? "",
    figures: report === null || report.outcome === Outcome.UNSPECIFIED ? [] : figuresOf(report),
    findings: source.findings.map(findingItem),
    box,
    tolerance: source.tolerance,
    scallop: source.scallop,
    steep_angle: source.steepAngle,
    tool: toolItem(source.tool),
    stock: stockItem(source, box),
    clamps: clampItems(source.setup),
    regions: regionItems(source.regions),
    surfaces,
    borders,
    passes,
    sections,
    buffers: buffers.table,
  };
  return { header, block: buffers.block(), surfaces };
}
