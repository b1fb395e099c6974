// The faces or patches of a part, and how a selection names them.
import type { SplitRegionsResponse } from "../gen/patchmill/v1/analysis_service_pb.js";
import { SurfaceKind } from "../gen/patchmill/v1/model_pb.js";
import type { CheckModelResponse, FaceInfo } from "../gen/patchmill/v1/model_service_pb.js";
import type { Mark } from "./frame/api";
import type { Choice } from "./settings";
import { brief, fixed, shortName } from "./text";

export interface Surface {
  name: string; // in the scene
  selector: string; // as Selection.patch_ids has it
  what: string;
  isPlane: boolean;
}

function describe({ face, areaMm2, minTiltDeg, maxTiltDeg }: FaceInfo): string {
  const kind = face === undefined || face.kind === SurfaceKind.UNSPECIFIED ? "" : shortName(SurfaceKind, face.kind).toLowerCase();
  const radius = face !== undefined && face.radiusMm > 0 ? ` R ${brief(face.radiusMm)}` : "";
  const [low, high] = [Math.round(minTiltDeg), Math.round(maxTiltDeg)];
  const tilt = low !== high ? `${low} to ${high}\u00b0` : low === 0 ? "level" : low === 90 ? "upright" : low === 180 ? "looks down" : `${low}\u00b0`;
  const name = face === undefined || face.name === "" ? "" : `${face.name}, `;
  return `${name}${face?.hollow === true ? "hollow " : ""}${kind}${radius}, ${brief(areaMm2)} mm2, ${tilt}`;
}

// Faces if the model has them, else its patches.
export function surfacesOf(check: CheckModelResponse | null, split: SplitRegionsResponse | null, names: readonly string[]): Surface[] {
  if (check !== null && check.faces.length > 0) {
    return check.faces
      .filter(({ face }) => face !== undefined && !face.skipped)
      .map((info) => ({ name: info.face!.id, selector: info.face!.id, what: describe(info), isPlane: info.face!.kind === SurfaceKind.PLANE }));
  }
  const ids = split?.patchIds ?? [];
  return names.map((name, i) => {
    const id = ids[i] ?? "";
    // A comma would divide the name on the command line.
    const isPlain = id !== "" && !id.includes(",") && ids.indexOf(id) === i;
    return { name, selector: isPlain ? id : `#${i}`, what: "", isPlane: false };
  });
}

export function marksOf(surfaces: readonly Surface[], choice: Choice): Map<string, Mark> {
  const [only, avoid] = [new Set(choice.list("only")), new Set(choice.list("avoid"))];
  return new Map(surfaces.map(({ name, selector }) => [name, avoid.has(selector) ? "avoided" : only.has(selector) ? "milled" : "none"]));
}

export interface RegionRow {
  id: number;
  place: string; // "X,Y,Z" of a point of it
  name: string;
  color: string;
}

export function changeOf(choice: Choice, place: string): string {
  const text = choice.list("region").find((t) => t.startsWith(`${place}:`));
  return text === undefined ? "" : text.slice(place.length + 1);
}

export function setChange(choice: Choice, place: string, change: string): void {
  const others = choice.list("region").filter((t) => !t.startsWith(`${place}:`));
  choice.set("region", ...others, change === "" ? "" : `${place}:${change}`);
}

export const placeText = (p: { xMm: number; yMm: number; zMm: number }): string => [p.xMm, p.yMm, p.zMm].map((v) => fixed(v, 3)).join(",");
