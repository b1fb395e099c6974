// Numbers and names as the command line writes them (clients/cli/text.cc).
import { type Diagnostic, Severity } from "../gen/patchmill/v1/diagnostic_pb.js";
import { UnreachableReason } from "../gen/patchmill/v1/region_pb.js";
import type { Report } from "../gen/patchmill/v1/report_pb.js";
import { settings } from "./settings";

export const fixed = (value: number, digits: number): string => (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits);

// A number with at most this many digits that count.
export const brief = (value: number, digits = 4): string => String(Number(value.toPrecision(digits)));

// "1 error", "2 errors".
export const counted = (count: number, what: string): string => `${count} ${what}${count === 1 ? "" : "s"}`;

// The name of a value of a generated enumeration, without the prefix.
export function shortName(type: Record<number, string>, value: number): string {
  return type[value] ?? String(value);
}

export const severityName = (severity: Severity): string =>
  severity === Severity.ERROR ? "ERROR" : severity === Severity.WARNING ? "WARNING" : "INFO";

// "2.1 % of the area (CONCAVE 2.0 %, UNDERCUT 0.1 %)".
export function uncutShare(report: Report): string {
  const { totalAreaMm2: total, unreachable } = report;
  if (unreachable.length === 0 || !(total > 0)) return "nothing";
  const share = (area: number): string => {
    const percent = (100 * area) / total;
    return percent < 0.1 ? "less than 0.1 %" : `${fixed(percent, 1)} %`;
  };
  const reasons = unreachable.map((p) => `${shortName(UnreachableReason, p.reason)} ${share(p.areaMm2)}`).join(", ");
  return `${share(report.unreachableAreaMm2)} of the area (${reasons})`;
}

// A message with the labels of the page in place of the options of the command line.
export function inWords(message: string): string {
  return message.replace(/(?<![\w-])--([a-z][a-z-]*[a-z])/g, (whole, name: string) => {
    const label = settings.find((s) => s.name === name)?.label;
    return label === undefined ? whole : `\u201c${label}\u201d`;
  });
}

// A message of the server as a sentence. One that begins with the path of a field stays.
export function sentence(message: string): string {
  const isProse = /^(?!patchmill)[a-z]+[ ,:]/.test(message);
  return `${isProse ? message[0]!.toUpperCase() + message.slice(1) : message}${/[.!?]$/.test(message) ? "" : "."}`;
}

// Where a finding is: a face, a patch, a line.
export function placeOf({ where }: Diagnostic): string {
  if (where === undefined) return "";
  if (where.faceId !== "") return `face ${where.faceId}`;
  if (where.patchId !== "") return `patch ${where.patchId}`;
  if (where.patchIndex !== undefined) return `patch ${where.patchIndex}`;
  return where.line === undefined ? "" : `line ${where.line}`;
}

export function bytesText(bytes: number): string {
  if (bytes < 1024) return `${bytes} bytes`;
  return bytes < 2 ** 20 ? `${fixed(bytes / 1024, 1)} KiB` : `${fixed(bytes / 2 ** 20, 1)} MiB`;
}

export function durationText(seconds: number): string {
  const s = Math.round(seconds);
  if (s < 60) return `${s} s`;
  return s < 3600 ? `${Math.floor(s / 60)} min ${s % 60} s` : `${Math.floor(s / 3600)} h ${Math.floor((s % 3600) / 60)} min`;
}
