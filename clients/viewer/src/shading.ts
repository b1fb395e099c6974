// How the part is shaded: what value or class gives the colour, and the scale of the legend.
import type { Header, Mesh, Scene } from "./scene";

export type ShadingId = "plain" | "region" | "slope" | "curvature" | "leftover" | "gouge" | "unreachable";

export interface Swatch {
  color: string;
  text: string;
}

export interface Scale {
  unit: string;
  low: number;
  high: number;
  stops: string[]; // colours at equal distances from low to high
  under: string; // colour of values below low
  over: string; // colour of values above high
  ticks: { value: number; text: string }[];
  mark: number | null; // a value that the part shows as a line
  notes: Swatch[]; // what colours outside the scale mean
}

export interface Shading {
  id: ShadingId;
  name: string;
  values: Float32Array | null; // per vertex, coloured by the scale
  scale: Scale | null;
  regionColors: Map<number, string> | null; // per region, for shadings of regions; -1 has one too
  swatches: Swatch[];
}

const plainGrey = "#b4bac2";
const unknownGrey = "#8b9099";
const blues = ["#f7fbff", "#d2e3f3", "#9ac8e0", "#529dcc", "#1c6cb1", "#08306b"];
const slopes = ["#fde725", "#a0da39", "#4ac16d", "#1fa187", "#277f8e", "#365c8d", "#46327e"];
const bends = ["#2166ac", "#6ba3cf", "#c3d8e8", "#f2f0ec", "#f2c3a4", "#d9765a", "#b2182b"];
const alarm = "#d7191c";
const reasonColors = ["#d7191c", "#e88f1a", "#7b3fa0", "#1b7fb8", "#b5367a", "#6b7a1e", "#3c3c99", "#00877a"];

// A number as a drawing shows it: as many digits as matter.
export function formatNumber(value: number, digits = 3): string {
  if (value === 0) return "0";
  const text = Number(value.toPrecision(digits)).toString();
  return text.replace("-", "\u2212");
}

// The next number of 1, 2, 5, 10, 20, ... that is not below `value`.
export function roundUp(value: number): number {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value) + 1e-9);
  for (const m of [1, 2, 5]) if (value <= m * power * (1 + 1e-9)) return m * power;
  return 10 * power;
}

// The absolute value below which `share` of the known values lie.
function quantile(values: Float32Array, share: number): number {
  const known = Float32Array.from(values.filter((v) => !Number.isNaN(v)), Math.abs).sort();
  return known.length === 0 ? 0 : known[Math.min(known.length - 1, Math.floor(share * known.length))]!;
}

function evenTicks(low: number, high: number, parts: number): Scale["ticks"] {
  return Array.from({ length: parts + 1 }, (_, i) => {
    const value = low + ((high - low) * i) / parts;
    return { value, text: formatNumber(Number(value.toPrecision(6))) };
  });
}

function slopeShading(header: Header, mesh: Mesh): Shading {
  const most = mesh.slope!.reduce((a, b) => Math.max(a, b), 0);
  const high = most > 90.5 ? 180 : 90;
  return {
    id: "slope",
    name: "Slope",
    values: mesh.slope,
    scale: {
      unit: "\u00b0",
      low: 0,
      high,
      stops: slopes,
      under: slopes[0]!,
      over: slopes[slopes.length - 1]!,
      ticks: evenTicks(0, high, high === 90 ? 6 : 4),
      mark: header.steep_angle,
      notes: [{ color: "#111111", text: `line: steep from ${formatNumber(header.steep_angle)}\u00b0 on` }],
    },
    regionColors: null,
    swatches: [],
  };
}

function curvatureShading(mesh: Mesh): Shading {
  const high = roundUp(quantile(mesh.curvature!, 0.98));
  return {
    id: "curvature",
    name: "Contour curvature",
    values: mesh.curvature,
    scale: {
      unit: "1/mm",
      low: -high,
      high,
      stops: bends,
      under: "#0b3c73",
      over: "#6d0a18",
      ticks: evenTicks(-high, high, 4),
      mark: null,
      notes: [
        { color: bends[bends.length - 2]!, text: "above 0: bends outward" },
        { color: bends[1]!, text: "below 0: bends inward" },
        { color: unknownGrey, text: "level: no contour" },
      ],
    },
    regionColors: null,
    swatches: [],
  };
}

function leftoverShading(header: Header, mesh: Mesh): Shading {
  const limit = header.scallop === null ? null : header.scallop + header.tolerance;
  const high = limit ?? roundUp(quantile(mesh.leftover!, 0.98));
  return {
    id: "leftover",
    name: "Leftover",
    values: mesh.leftover,
    scale: {
      unit: "mm",
      low: 0,
      high,
      stops: blues,
      under: "#f4e3b5",
      over: alarm,
      ticks: evenTicks(0, high, 3),
      mark: null,
      notes: [
        {
          color: alarm,
          text: `above ${formatNumber(high)} mm${limit === null ? "" : ": more than scallop + tolerance"}`,
        },
        { color: "#f4e3b5", text: "below 0" },
      ],
    },
    regionColors: null,
    swatches: [],
  };
}

function gougeShading(header: Header, mesh: Mesh): Shading {
  return {
    id: "gouge",
    name: "Gouge",
    values: mesh.gouge,
    scale: {
      unit: "mm",
      low: 0,
      high: header.tolerance,
      stops: ["#e9eef2", "#f6dfa0", "#eeb04e", "#e0812c"],
      under: "#e9eef2",
      over: "#8e0152",
      ticks: evenTicks(0, header.tolerance, 2),
      mark: null,
      notes: [{ color: "#8e0152", text: `above ${formatNumber(header.tolerance)} mm: more than the tolerance` }],
    },
    regionColors: null,
    swatches: [],
  };
}

// Triangles without a region are rare, and then the legend does not need them.
function noRegion(mesh: Mesh): Swatch[] {
  return mesh.region!.includes(-1) ? [{ color: unknownGrey, text: "no region" }] : [];
}

function regionShading(header: Header, mesh: Mesh): Shading {
  return {
    id: "region",
    name: "Region",
    values: null,
    scale: null,
    regionColors: new Map([[-1, unknownGrey], ...header.regions.map((r) => [r.id, r.color] as [number, string])]),
    swatches: [
      ...header.regions.map((r) => ({ color: r.color, text: r.name })),
      ...noRegion(mesh),
    ],
  };
}

function unreachableShading(header: Header, mesh: Mesh): Shading {
  const reasons = [...new Set(header.regions.map((r) => r.unreachable).filter((r) => r !== ""))];
  const colorOf = (reason: string): string =>
    reason === "" ? plainGrey : reasonColors[reasons.indexOf(reason) % reasonColors.length]!;
  return {
    id: "unreachable",
    name: "Unreachable",
    values: null,
    scale: null,
    regionColors: new Map([
      [-1, unknownGrey],
      ...header.regions.map((r) => [r.id, colorOf(r.unreachable)] as [number, string]),
    ]),
    swatches: [
      ...reasons.map((reason) => ({ color: colorOf(reason), text: reason })),
      { color: plainGrey, text: "reachable" },
      ...noRegion(mesh),
    ],
  };
}

// The shadings that the scene has data for. The first one is shown first.
export function shadingsOf(scene: Scene): Shading[] {
  const { header, mesh } = scene;
  if (mesh === null) return [];
  const shadings: Shading[] = [];
  if (mesh.region !== null) shadings.push(regionShading(header, mesh));
  if (mesh.slope !== null) shadings.push(slopeShading(header, mesh));
  if (mesh.curvature !== null) shadings.push(curvatureShading(mesh));
  if (mesh.leftover !== null) shadings.push(leftoverShading(header, mesh));
  if (mesh.gouge !== null) shadings.push(gougeShading(header, mesh));
  if (mesh.region !== null) shadings.push(unreachableShading(header, mesh));
  shadings.push({
    id: "plain",
    name: "Plain",
    values: null,
    scale: null,
    regionColors: new Map([[-1, plainGrey]]),
    swatches: [{ color: plainGrey, text: "surface" }],
  });
  return shadings;
}

export const colors = { plainGrey, unknownGrey };
