// Tabs and panels of the page.
import { byId, press } from "./page_elements";

const names = ["program", "findings", "figures"];

export function chooseTab(name: string): void {
  for (const n of names) {
    const tab = byId(`tab-${n}`);
    tab.setAttribute("aria-selected", String(n === name));
    tab.tabIndex = n === name ? 0 : -1;
    byId(`pane-${n}`).hidden = n !== name;
  }
}

export function makeTabs(): void {
  names.forEach((name, i) => {
    const tab = byId(`tab-${name}`);
    tab.addEventListener("click", () => chooseTab(name));
    tab.addEventListener("keydown", (event) => {
      const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
      if (step === 0) return;
      event.preventDefault();
      event.stopPropagation();
      const next = names[(i + step + names.length) % names.length]!;
      chooseTab(next);
      byId(`tab-${next}`).focus();
    });
  });
}

const narrow = matchMedia("(max-width: 860px)");

// On a narrow screen the panels lie over the picture, one at a time, and begin closed.
export function togglePanel(side: "left" | "right"): void {
  setPanel(side, byId(side).hidden);
}

function setPanel(side: "left" | "right", isShown: boolean): void {
  const other = side === "left" ? "right" : "left";
  if (isShown && narrow.matches) setPanel(other, false);
  byId(side).hidden = !isShown;
  press(byId(`show-${side}`), isShown);
}

export function makePanels(): void {
  for (const side of ["left", "right"] as const) byId(`show-${side}`).addEventListener("click", () => togglePanel(side));
  const arrange = (): void => {
    setPanel("left", !narrow.matches);
    setPanel("right", !narrow.matches);
    // There the legend lies on the picture.
    byId(narrow.matches ? "stage" : "legend-place").append(byId("legend"));
    byId<HTMLDetailsElement>("legend").open = !narrow.matches;
  };
  narrow.addEventListener("change", arrange);
  arrange();
}
