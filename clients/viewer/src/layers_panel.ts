// Switches of what is drawn, and the section plane.
import { byId, make, press } from "./page_elements";
import { mm } from "./picked";
import type { Axis } from "./section_plane";
import type { PathPart, Viewer } from "./viewer";

export function makeLayers(viewer: Viewer): void {
  const box = byId("layers");
  const rows = viewer.layers.map((layer) => {
    const label = make("label", "check");
    const input = make("input");
    input.type = "checkbox";
    input.dataset.layer = layer.id;
    input.addEventListener("change", () => viewer.show(layer.id, input.checked));
    label.append(input);
    const chip = make("span", "chip");
    if (layer.color !== null) label.append(chip);
    label.append(make("span", "", layer.name));
    box.append(label);
    return { layer, input, chip };
  });
  const part = byId<HTMLSelectElement>("path-part");
  const point = byId<HTMLSelectElement>("path-point");
  const every = byId<HTMLInputElement>("every-pass");
  every.addEventListener("change", () => viewer.setEveryPass(every.checked));
  byId("every-row").hidden = viewer.timeline === null;
  byId("part-row").hidden = viewer.timeline === null;
  byId("point-row").hidden = viewer.timeline === null || viewer.scene.mesh === null;
  part.addEventListener("change", () => viewer.setPathPart(part.value as PathPart));
  point.addEventListener("change", () => {
    const note = byId("loading");
    point.disabled = true;
    viewer
      .setPathPoint(point.value as "tip" | "contact", (share) => {
        note.hidden = false;
        note.textContent = `Finding the contact points: ${Math.round(100 * share)} %`;
      })
      .finally(() => {
        note.hidden = true;
        point.disabled = false;
      });
  });
  const fill = (): void => {
    for (const { layer, input, chip } of rows) {
      input.checked = layer.isShown;
      if (layer.color !== null) chip.style.background = layer.color;
    }
    every.checked = viewer.isEveryPassDrawn;
    part.value = viewer.pathPart;
    point.value = viewer.pathPoint;
  };
  viewer.on("layers", fill);
  fill();
}

// Puts the section plane across an axis, or takes it away.
export function chooseAxis(viewer: Viewer, axis: Axis | null): void {
  if (axis === null) {
    viewer.setSection({ axis });
    return;
  }
  const [low, high] = viewer.sectionRange(axis);
  viewer.setSection({ axis, position: (low + high) / 2 });
  byId("section-controls").scrollIntoView({ block: "nearest" });
}

export function makeSection(viewer: Viewer): void {
  const slider = byId<HTMLInputElement>("section-position");
  const cutsPath = byId<HTMLInputElement>("section-path");
  const buttons = [...document.querySelectorAll<HTMLButtonElement>("[data-axis]")];
  for (const button of buttons) {
    button.addEventListener("click", () => chooseAxis(viewer, (button.dataset.axis || null) as Axis | null));
  }
  slider.addEventListener("input", () => viewer.setSection({ position: Number(slider.value) }));
  byId("section-flip").addEventListener("click", () => viewer.setSection({ isFlipped: !viewer.section.isFlipped }));
  cutsPath.addEventListener("change", () => viewer.setSection({ cutsPath: cutsPath.checked }));
  const fill = (): void => {
    const { axis, position, isFlipped } = viewer.section;
    for (const button of buttons) press(button, button.dataset.axis === (axis ?? ""));
    byId("section-controls").hidden = axis === null;
    if (axis === null) return;
    const [low, high] = viewer.sectionRange(axis);
    Object.assign(slider, { min: String(low), max: String(high), step: String((high - low) / 500) });
    slider.value = String(position);
    slider.setAttribute("aria-valuetext", `${mm(position)} mm`);
    byId("section-value").textContent = `${axis.toUpperCase()} ${isFlipped ? "\u2265" : "\u2264"} ${mm(position, 2)} mm`;
  };
  viewer.on("section", fill);
  fill();
}
