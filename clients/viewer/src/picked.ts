// What lies under a pixel, and how it is told.
import { type MeshHit, valueAt } from "./mesh_pick";
import type { PathHit } from "./path_pick";
import type { ProgramText } from "./program_text";
import { betweenPasses, kindNames, type Point3, type Scene } from "./scene";

export interface PickedSurface {
  kind: "surface";
  point: Point3;
  surface: string | null;
  region: string | null;
  unreachable: string;
  slope: number | null; // degrees
  curvature: number | null; // 1/mm
  leftover: number | null; // mm
  gouge: number | null; // mm
}

export interface PickedMove {
  kind: "move";
  point: Point3;
  move: number;
  share: number;
  moveKind: string;
  pass: string | null;
  region: string | null;
  feed: number | null; // mm/min, 0: rapid
  line: number; // 0: none
  text: string;
  behind: PickedSurface | null; // the surface under the same pixel
}

export type Picked = PickedSurface | PickedMove;

export function regionName(scene: Scene, id: number | undefined): string | null {
  return id === undefined || id < 0 ? null : (scene.header.regions.find((r) => r.id === id)?.name ?? null);
}

export function pickedSurface(scene: Scene, hit: MeshHit): PickedSurface {
  const mesh = scene.mesh!;
  const id = mesh.region?.[hit.triangle];
  return {
    kind: "surface",
    point: hit.point,
    surface: mesh.surface === null ? null : scene.header.surfaces[mesh.surface[hit.triangle]!]!,
    region: regionName(scene, id),
    unreachable: scene.header.regions.find((r) => r.id === id)?.unreachable ?? "",
    slope: valueAt(mesh, mesh.slope, hit),
    curvature: valueAt(mesh, mesh.curvature, hit),
    leftover: valueAt(mesh, mesh.leftover, hit),
    gouge: valueAt(mesh, mesh.gouge, hit),
  };
}

function passNameAt(scene: Scene, kind: number | undefined): string | null {
  const name = scene.header.passes[kind ?? betweenPasses];
  return name === undefined ? null : passName(name);
}

export function pickedMove(scene: Scene, hit: Pick<PathHit, "move" | "share" | "point">, program: ProgramText | null): PickedMove {
  const path = scene.path!;
  const { move } = hit;
  const line = path.line?.[move] ?? 0;
  return {
    kind: "move",
    point: hit.point,
    move,
    share: hit.share,
    moveKind: kindNames[path.kind[move]!]!,
    pass: passNameAt(scene, path.passKind?.[move]),
    region: regionName(scene, path.region?.[move]),
    feed: path.feed?.[move] ?? null,
    line,
    text: line > 0 && program !== null ? program.line(line) : "",
    behind: null,
  };
}

// The kinds of passes as the manual writes them; others stay as they are.
export function passName(kind: string): string {
  return kind === "zigzag" ? "zig-zag" : kind;
}

const minus = (text: string): string => text.replace("-", "\u2212");
export const mm = (value: number, digits = 3): string => minus((Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits));

// The rows of the hover: a name and a value each.
export function rowsOf(picked: Picked): [string, string][] {
  const rows: [string, string][] = [];
  const add = (name: string, value: string | null): void => {
    if (value !== null && value !== "") rows.push([name, value]);
  };
  add("X Y Z", picked.point.map((v) => mm(v)).join("  "));
  if (picked.kind === "move") {
    add("Move", picked.pass === null ? picked.moveKind : `${picked.moveKind}, ${picked.pass} pass`);
    add("Region", picked.region);
    add("Feed", picked.feed === null ? null : picked.feed === 0 ? "rapid" : `${Math.round(picked.feed)} mm/min`);
    add("Line", picked.line === 0 ? null : String(picked.line));
    add("Block", picked.text);
  }
  const surface = picked.kind === "surface" ? picked : picked.behind;
  if (surface === null) return rows;
  add("Surface", surface.surface);
  if (picked.kind === "surface") add("Region", surface.region);
  add("Unreachable", surface.unreachable);
  add("Leftover", surface.leftover === null ? null : `${mm(surface.leftover, 4)} mm`);
  add("Gouge", surface.gouge === null ? null : `${mm(surface.gouge, 4)} mm`);
  add("Slope", surface.slope === null ? null : `${mm(surface.slope, 1)}\u00b0`);
  add("Contour curv.", surface.curvature === null ? null : `${mm(surface.curvature, 4)} 1/mm`);
  return rows;
}
