// The legend of the shading: a scale with units, or the colours of regions and reasons.
import { byId, make, option } from "./page_elements";
import type { Scale, ShadingId, Swatch } from "./shading";
import type { Viewer } from "./viewer";

function swatchRow({ color, text }: Swatch): HTMLElement {
  const row = make("div", "swatch");
  const chip = make("i");
  chip.style.background = color;
  row.append(chip, make("span", "", text));
  return row;
}

function scaleRows(scale: Scale): HTMLElement[] {
  const unit = make("div", "unit", `in ${scale.unit === "\u00b0" ? "degrees" : scale.unit}`);
  const bar = make("div", "scale");
  bar.style.background = `linear-gradient(to right, ${scale.stops.join(", ")})`;
  const ticks = make("div", "ticks");
  const share = (value: number): number => (value - scale.low) / (scale.high - scale.low);
  scale.ticks.forEach(({ value, text }, i) => {
    const tick = make("span", i === 0 ? "first" : i === scale.ticks.length - 1 ? "last" : "", text);
    tick.style.left = `${100 * share(value)}%`;
    ticks.append(tick);
  });
  if (scale.mark !== null && scale.mark > scale.low && scale.mark < scale.high) {
    const mark = make("div");
    Object.assign(mark.style, { position: "absolute", left: `${100 * share(scale.mark)}%`, top: "-2px", bottom: "-2px", borderLeft: "2px solid #111" });
    bar.append(mark);
  }
  return [unit, bar, ticks, ...scale.notes.map(swatchRow)];
}

export function makeLegend(viewer: Viewer): void {
  const select = byId<HTMLSelectElement>("shading");
  if (viewer.shadings.length === 0) {
    byId("legend").hidden = true;
    return;
  }
  for (const shading of viewer.shadings) select.append(option(shading.id, shading.name));
  select.addEventListener("change", () => viewer.setShading(select.value as ShadingId));
  const fill = (): void => {
    const { shading } = viewer;
    if (shading === null) return;
    select.value = shading.id;
    byId("legend-title").textContent = `Part: ${shading.name.toLowerCase()}`;
    byId("legend-body").replaceChildren(
      ...(shading.scale !== null ? scaleRows(shading.scale) : shading.swatches.map(swatchRow)),
    );
  };
  viewer.on("shading", fill);
  fill();
}
