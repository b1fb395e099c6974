// The findings, whose places can be clicked, and the figures.
import type { Overlay } from "./overlay";
import { byId, make } from "./page_elements";
import { mm } from "./picked";
import type { Viewer } from "./viewer";

function toneOf(severity: string): string {
  return /ERROR/i.test(severity) ? "bad" : /WARN/i.test(severity) ? "warn" : "plain";
}

export function makeFindings(viewer: Viewer, overlay: Overlay): void {
  const { findings, figures, time_basis } = viewer.scene.header;
  byId("tab-findings").textContent = `Findings (${findings.length})`;
  const list = byId("findings");
  for (const finding of findings) {
    const { point } = finding;
    const box = point === null ? make("div", "finding") : make("button", "finding");
    box.dataset.tone = toneOf(finding.severity);
    const head = make("div");
    head.append(make("strong", "", finding.severity), make("code", "", finding.code));
    box.append(head, make("p", "", finding.message));
    if (point !== null) {
      (box as HTMLButtonElement).type = "button";
      box.append(make("span", "place", `Show X ${mm(point[0])}  Y ${mm(point[1])}  Z ${mm(point[2])}`));
      box.addEventListener("click", () => {
        overlay.focus = { point, text: finding.code };
        viewer.camera.target.set(...point);
        viewer.viewChanged();
      });
    }
    const item = make("li");
    item.append(box);
    list.append(item);
  }
  if (findings.length === 0) list.append(make("p", "hint", "There are no findings."));
  const rows = [...figures, ["times", time_basis]] as [string, string][];
  byId("figures").append(...rows.flatMap(([name, value]) => [make("dt", "", name), make("dd", "", value)]));
}
