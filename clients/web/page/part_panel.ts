// What is known of the part: its size, what each axis shows, and the findings.
import { byId, make } from "../../viewer/src/page_elements";
import type { Diagnostic } from "../gen/patchmill/v1/diagnostic_pb.js";
import { Severity } from "../gen/patchmill/v1/diagnostic_pb.js";
import type { CheckModelResponse } from "../gen/patchmill/v1/model_service_pb.js";
import { UpAxis } from "../gen/patchmill/v1/setup_pb.js";
import { brief, counted, fixed, inWords, placeOf, sentence, severityName } from "./text";

const hundredths = (mm: number): string => String(Number(fixed(mm, 2)));
const mostFindings = 200; // rows
const toneOf = (severity: Severity): string => (severity === Severity.ERROR ? "bad" : severity === Severity.WARNING ? "warn" : "plain");

export function findingRow(finding: Diagnostic, show: ((finding: Diagnostic) => void) | null): HTMLElement {
  const row = make("li");
  row.dataset.tone = toneOf(finding.severity);
  const place = placeOf(finding);
  row.append(make("b", "", severityName(finding.severity)), make("code", "", ` ${finding.code}${place === "" ? "" : `, ${place}`}`), make("p", "", sentence(inWords(finding.message))));
  if (finding.where?.point !== undefined && show !== null) {
    const button = make("button", "", "Show the place");
    button.type = "button";
    button.addEventListener("click", () => show(finding));
    row.append(button);
  }
  return row;
}

const upNames: Partial<Record<UpAxis, string>> = { [UpAxis.Z]: "z", [UpAxis.Y]: "y", [UpAxis.X]: "x", [UpAxis.NEG_Z]: "-z", [UpAxis.NEG_Y]: "-y", [UpAxis.NEG_X]: "-x" };

// What each axis would show, by the name of the axis.
export function upNotes({ upDirections, bestUp }: CheckModelResponse): Map<string, string> {
  const notes = new Map<string, string>();
  for (const { up, facingAreaMm2, hiddenAreaMm2 } of upDirections) {
    const seen = brief(Math.max(0, facingAreaMm2 - hiddenAreaMm2), 3);
    notes.set(upNames[up] ?? "", `shows ${seen} mm2${up === bestUp ? ", most" : ""}`);
  }
  return notes;
}

// Offers to turn the axis up that shows most, where another one is up.
export function showUpHint({ bestUp }: CheckModelResponse, up: string, turn: (up: string) => void): void {
  const best = upNames[bestUp];
  const box = byId("up-hint");
  box.hidden = best === undefined || up === best || !Object.values(upNames).includes(up);
  if (best === undefined) return;
  box.querySelector("span")!.textContent = `${best.toUpperCase().replace("-", "\u2212")} of the model shows more to the tool.`;
  const button = box.querySelector("button")!;
  button.textContent = "Turn it up";
  button.onclick = () => turn(best);
}

// What is odd about part and ball: it is said before a job runs for hours.
export function sizeNote({ box }: CheckModelResponse, ball: number): string {
  if (box?.min === undefined || box.max === undefined || !(ball > 0)) return "";
  const sides = [box.max.xMm - box.min.xMm, box.max.yMm - box.min.yMm, box.max.zMm - box.min.zMm];
  const longest = Math.max(...sides);
  if (longest > 100 * ball) return `The part is ${brief(longest, 3)} mm long, and the ball has ${brief(ball)} mm: the job takes long. A larger ball or scallop makes it shorter. Or is the unit of the file another one (Scale)?`;
  if (longest < ball) return `The part is ${brief(longest, 3)} mm long, and the ball has ${brief(ball)} mm. Is the unit of the file another one (Scale)?`;
  return "";
}

// The picture of the faces, until the regions are there.
function showFaces({ picture }: CheckModelResponse): void {
  const image = byId<HTMLImageElement>("faces-picture");
  if (image.src !== "") URL.revokeObjectURL(image.src);
  image.hidden = picture === undefined;
  if (picture === undefined) return image.removeAttribute("src");
  image.src = URL.createObjectURL(new Blob([new Uint8Array(picture.data)], { type: "image/svg+xml" }));
}

export function showPart(check: CheckModelResponse, show: (finding: Diagnostic) => void): void {
  const { box, diagnostics } = check;
  showFaces(check);
  const rows: [string, string][] = [];
  if (box?.min !== undefined && box.max !== undefined) {
    const [a, b] = [box.min, box.max];
    const size = [b.xMm - a.xMm, b.yMm - a.yMm, b.zMm - a.zMm].map(hundredths).join(" \u00d7 ");
    rows.push(["Z", `${hundredths(a.zMm)} to ${hundredths(b.zMm)} mm`]);
    byId("sum-part").textContent = `${size} mm`;
  } else byId("sum-part").textContent = "cannot be used";
  rows.push([check.faceCount > 0 ? "faces, patches" : "patches", check.faceCount > 0 ? `${check.faceCount}, ${check.patchCount}` : String(check.patchCount)]);
  if (check.minConcaveRadiusMm !== undefined) rows.push(["smallest inner radius", `${brief(check.minConcaveRadiusMm)} mm`]);
  byId("size").replaceChildren(...rows.flatMap(([n, v]) => [make("dt", "", n), make("dd", "", v)]));
  byId("size").hidden = false;

  const count = (severity: Severity): number => diagnostics.filter((d) => d.severity === severity).length;
  const [errors, warnings] = [count(Severity.ERROR), count(Severity.WARNING)];
  const sorted = [...diagnostics].sort((a, b) => b.severity - a.severity);
  const items = sorted.slice(0, mostFindings).map((d) => findingRow(d, show));
  if (sorted.length > mostFindings) items.push(make("li", "soft", `${sorted.length - mostFindings} more are not listed.`));
  byId("findings").replaceChildren(...items);
  byId("findings-title").textContent = `Findings: ${counted(errors, "error")}, ${counted(warnings, "warning")}, ${counted(diagnostics.length - errors - warnings, "note")}`;
  byId("findings-box").hidden = diagnostics.length === 0;
  byId<HTMLDetailsElement>("findings-box").open = errors + warnings > 0;
}

export function clearPart(): void {
  byId("size").hidden = true;
  byId("findings-box").hidden = true;
  byId("up-hint").hidden = true;
  byId("faces-picture").hidden = true;
  byId("sum-part").textContent = "";
}
