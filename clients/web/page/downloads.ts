// Files that the page hands to the user.
import { toJsonString } from "@bufbuild/protobuf";
import { type Report, ReportSchema } from "../gen/patchmill/v1/report_pb.js";
import type { PackedScene } from "./scene";

const endings = new Map([["linuxcnc", "ngc"], ["heidenhain", "h"], ["siemens", "mpf"]]);

export const baseName = (file: string): string => file.replace(/\.[^.]*$/, "").replace(/[^\w.()+ -]+/g, "_").slice(0, 80) || "part";
export const programName = (file: string, dialect: string): string => `${baseName(file)}.${endings.get(dialect) ?? "nc"}`;

export function download(name: string, data: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([data], { type }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

// As the command line writes it: field names of the contract, zeros printed.
export function reportText(report: Report): string {
  return `${toJsonString(ReportSchema, report, { alwaysEmitImplicit: true, useProtoFieldName: true, prettySpaces: 1 })}\n`;
}

function base64(bytes: Uint8Array): string {
  const parts: string[] = [];
  const step = 3 * 8192;
  for (let at = 0; at < bytes.length; at += step) parts.push(btoa(String.fromCharCode(...bytes.subarray(at, at + step))));
  return parts.join("");
}

async function gzip(block: ArrayBuffer): Promise<Uint8Array> {
  const packed = new Blob([block]).stream().pipeThrough(new CompressionStream("gzip"));
  return new Uint8Array(await new Response(packed).arrayBuffer());
}

// The viewer's page with the scene in it, as --preview FILE.html writes it.
export async function pageText({ header, block }: PackedScene): Promise<string> {
  const response = await fetch("template.html");
  if (!response.ok) throw new Error(`The template of the 3-D page cannot be loaded (${response.status}).`);
  const template = await response.text();
  // No text of a client may end the script that holds the header.
  const json = JSON.stringify({ ...header, data_encoding: "gzip" }).replaceAll("<", "\\u003c");
  const parts: Record<string, string> = { "@PATCHMILL_SCENE@": json, "@PATCHMILL_DATA@": base64(await gzip(block)) };
  return template.replace(/@PATCHMILL_(?:SCENE|DATA)@/g, (marker) => parts[marker]!);
}
