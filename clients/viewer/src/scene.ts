// The scene: the header and the typed arrays that a Patchmill program hands to the viewer.
// Lengths are in mm, angles in degrees, feeds in mm/min and times in s.

import type { ProgramText } from "./program_text";

export type Point3 = [number, number, number];

export interface Finding {
  severity: string;
  code: string;
  message: string;
  point: Point3 | null;
}

export interface Holder {
  stickout: number;
  profile: [number, number][]; // height above the lower face of the holder, radius
}

export interface Tool {
  ball_diameter: number;
  flute_length: number | null;
  shank_diameter: number;
  holder: Holder | null;
}

export interface Stock {
  outline: [number, number][];
  bottom: number;
  top: number;
}

export interface Clamp {
  name: string;
  outline: [number, number][];
  top: number;
}

export interface Region {
  id: number;
  name: string;
  color: string;
  unreachable: string;
}

export interface Border {
  name: string;
  color: string;
  first: number;
  count: number;
}

export interface Section {
  name: string;
  first_move: number;
}

export interface Header {
  title: string;
  made_by: string;
  outcome: string;
  figures: [string, string][];
  findings: Finding[];
  box: { min: Point3; max: Point3 };
  tolerance: number;
  scallop: number | null;
  steep_angle: number;
  tool: Tool;
  stock: Stock | null;
  clamps: Clamp[];
  regions: Region[];
  surfaces: string[];
  borders: Border[];
  passes: string[];
  sections: Section[];
  time_basis: string;
}

export interface Mesh {
  position: Float32Array;
  index: Uint32Array;
  normal: Float32Array | null;
  slope: Float32Array | null;
  curvature: Float32Array | null;
  leftover: Float32Array | null;
  gouge: Float32Array | null;
  region: Int32Array | null;
  surface: Uint32Array | null;
}

export interface Arcs {
  move: Uint32Array;
  plane: Uint8Array;
  center: Float32Array;
  turns: Float32Array;
}

export interface Path {
  tip: Float32Array;
  kind: Uint8Array;
  passKind: Uint8Array | null;
  region: Int32Array | null;
  pass: Int32Array | null;
  feed: Float32Array | null;
  seconds: Float32Array | null;
  line: Uint32Array | null;
  arcs: Arcs | null;
}

export interface Scene {
  header: Header;
  mesh: Mesh | null;
  borderPosition: Float32Array | null;
  path: Path | null;
  program: ProgramText | null;
}

// The kinds of moves, as path.kind numbers them.
export const Kind = { rapid: 1, approach: 2, plunge: 3, lead: 4, cut: 5, link: 6, retract: 7 } as const;
export const kindNames = ["", "rapid", "approach", "plunge", "lead", "cut", "link", "retract"];
// The pass kind and the pass of a move between passes.
export const betweenPasses = 255;

// Says what is wrong with a scene. Its message is for the user.
export class SceneError extends Error {}
