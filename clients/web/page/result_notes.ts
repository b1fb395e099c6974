// What a user has to know of a result beside its figures: why areas stay uncut, and what nobody has stated.
import { make } from "../../viewer/src/page_elements";
import { UnreachableReason } from "../gen/patchmill/v1/region_pb.js";
import type { Report } from "../gen/patchmill/v1/report_pb.js";
import { fixed, inWords, sentence, shortName } from "./text";

type GoTo = (setting: string) => void;

// Each reason in words, and the setting that changes it.
const reasonTexts: Partial<Record<UnreachableReason, [text: string, setting: string]>> = {
  [UnreachableReason.UNDERCUT]: ["looks down or lies under something: turn the part for it", "up"],
  [UnreachableReason.CONCAVE]: ["inner corners that the ball is too large for", "tool-diameter"],
  [UnreachableReason.FLOOR]: ["the tip would go below the lowest tip", "floor"],
  [UnreachableReason.AVOIDED]: ["boundary, highest tip, clamps or avoided faces forbid it", "avoid"],
  [UnreachableReason.STRATEGY]: ["the chosen strategy cannot finish it", "strategy"],
  [UnreachableReason.HOLDER]: ["the holder is in the way: a longer stick-out helps", "stickout"],
  [UnreachableReason.SHANK]: ["the shank is in the way: longer flutes help", "flute-length"],
  [UnreachableReason.OUTSIDE]: ["upright outer walls, where the tool would stand beside the part", "outside"],
};

function link(text: string, setting: string, goTo: GoTo): HTMLButtonElement {
  const button = make("button", "link", text);
  button.type = "button";
  button.dataset.setting = setting;
  button.addEventListener("click", () => goTo(setting));
  return button;
}

function shareText(area: number, total: number): string {
  const percent = (100 * area) / total;
  return percent < 0.1 ? "less than 0.1 %" : `${fixed(percent, 1)} %`;
}

// "81.2 % of the area", or "nothing".
export function uncutText({ totalAreaMm2: total, unreachable, unreachableAreaMm2: area }: Report): string {
  return unreachable.length === 0 || !(total > 0) ? "nothing" : `${shareText(area, total)} of the area`;
}

// Why areas stay uncut, the largest one first.
export function uncutRows({ totalAreaMm2: total, unreachable }: Report, goTo: GoTo): HTMLElement[] {
  if (!(total > 0)) return [];
  return [...unreachable].sort((a, b) => b.areaMm2 - a.areaMm2).map(({ reason, areaMm2 }) => {
    const [text, setting] = reasonTexts[reason] ?? ["it is not reached", ""];
    const row = make("li", "", `${shareText(areaMm2, total)}: ${text} `);
    row.append(make("code", "", shortName(UnreachableReason, reason)), " ");
    if (setting !== "") row.append(link("Change it", setting, goTo));
    return row;
  });
}

const settingOfCode: Record<string, string> = {
  TOOL_NUMBER_ASSUMED: "tool-number",
  DEFAULT_CUTTING_DATA: "feed",
  ZERO_ASSUMED: "zero",
  STOCK_ASSUMED: "allowance",
  HOLDER_NOT_CHECKED: "holder",
};

// What nobody has stated, so that it is to be checked before the start.
export function assumedRows({ checkBeforeStartCodes: codes, diagnostics }: Report, goTo: GoTo): HTMLElement[] {
  const findings = codes.map((code) => ({ code, message: diagnostics.find((d) => d.code === code)?.message ?? "" }));
  return findings.map(({ code, message }) => {
    const row = make("li", "", `${sentence(inWords(message))} `);
    const setting = settingOfCode[code];
    if (setting !== undefined) row.append(link("State it", setting, goTo));
    return row;
  });
}
