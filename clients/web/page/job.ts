// Runs a job: takes the stream of answers until its report. A stream without a report is void.
import type { RegionMap } from "../gen/patchmill/v1/region_pb.js";
import { Outcome, type Progress, type Report } from "../gen/patchmill/v1/report_pb.js";
import type { Setup } from "../gen/patchmill/v1/setup_pb.js";
import type { MeshBlock, PathBlock } from "../gen/patchmill/v1/toolpath_pb.js";
import type { GenerateProgramRequest } from "../gen/patchmill/v1/toolpath_service_pb.js";
import { toolpaths } from "./calls";

export interface JobResult {
  version: string;
  setup: Setup | undefined;
  regions: RegionMap | undefined;
  mesh: MeshBlock[];
  paths: PathBlock[];
  program: Uint8Array | null; // null: there is none
  picture: Uint8Array;
  report: Report;
}


function concat(parts: readonly Uint8Array[]): Uint8Array {
  const all = new Uint8Array(parts.reduce((sum, p) => sum + p.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

const hasProgram = ({ outcome }: Report): boolean => outcome === Outcome.COMPLETE || outcome === Outcome.COMPLETE_WHERE_REACHABLE;

// The digest can be checked where the browser has one: over https, and from this machine.
async function isWhole(program: Uint8Array, { programSizeBytes, programSha256 }: Report): Promise<boolean> {
  if (program.length !== programSizeBytes) return false;
  if (!window.isSecureContext || programSha256.length === 0) return true;
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", new Uint8Array(program)));
  return digest.every((byte, i) => byte === programSha256[i]);
}

export async function runJob(request: GenerateProgramRequest, signal: AbortSignal, onProgress: (progress: Progress) => void): Promise<JobResult> {
  let [version, report]: [string, Report | null] = ["", null];
  let setup: Setup | undefined;
  let regions: RegionMap | undefined;
  const mesh: MeshBlock[] = [];
  const paths: PathBlock[] = [];
  const program: Uint8Array[] = [];
  const picture: Uint8Array[] = [];
  for await (const { event } of toolpaths.generateProgram(request, { signal })) {
    if (event.case === "accepted") [version, setup] = [event.value.serverVersion, event.value.resolvedJob?.setup];
    else if (event.case === "progress") onProgress(event.value);
    else if (event.case === "regions") regions = event.value;
    else if (event.case === "mesh") mesh.push(event.value);
    else if (event.case === "pathBlock") paths.push(event.value);
    else if (event.case === "program") program.push(event.value.data);
    else if (event.case === "artifact") picture.push(event.value.data);
    else if (event.case === "report") report = event.value;
  }
  if (report === null) throw new Error("The answer ended before its report. Nothing of it is kept, because nothing of it was verified.");
  const text = concat(program);
  if (hasProgram(report) && !(await isWhole(text, report))) throw new Error("The program did not arrive whole. Nothing of it is kept.");
  return { version, setup, regions, mesh, paths, program: hasProgram(report) ? text : null, picture: concat(picture), report };
}
