// A shading of the viewer that shows which faces are milled and which are avoided.
import { make, option } from "../../../viewer/src/page_elements";
import { colors, type Shading, type ShadingId } from "../../../viewer/src/shading";
import type { Viewer } from "../../../viewer/src/viewer";
import type { Mark } from "./api";

export const marksId = "marks" as ShadingId;
const levels: readonly Mark[] = ["none", "milled", "avoided"];
const palette = [colors.plainGrey, "#4f9bd9", "#d9705b"];

export class MarkShading {
  readonly #viewer: Viewer;
  readonly #shading: Shading;
  readonly #names: readonly string[];
  #isAllMilled = true;

  constructor(viewer: Viewer) {
    this.#viewer = viewer;
    this.#names = viewer.scene.header.surfaces;
    const vertices = (viewer.scene.mesh?.position.length ?? 0) / 3;
    this.#shading = {
      id: marksId,
      name: "Milled and avoided",
      values: new Float32Array(vertices),
      scale: { unit: "", low: 0, high: levels.length - 1, stops: palette, under: palette[0]!, over: palette[2]!, ticks: [], mark: null, notes: [] },
      regionColors: null,
      swatches: [],
    };
    viewer.shadings.push(this.#shading);
    document.getElementById("shading")?.append(option(marksId, this.#shading.name));
    viewer.on("shading", () => this.#showLegend());
  }

  set(of: ReadonlyMap<string, Mark>, isAllMilled: boolean): void {
    const { mesh } = this.#viewer.scene;
    this.#isAllMilled = isAllMilled;
    if (mesh === null || mesh.surface === null) return;
    const values = this.#shading.values!;
    const level = this.#names.map((name) => levels.indexOf(of.get(name) ?? "none"));
    // Vertices belong to one patch each.
    for (let i = 0; i < mesh.index.length; i++) values[mesh.index[i]!] = level[mesh.surface[Math.floor(i / 3)]!]!;
    if (this.#viewer.shading?.id === marksId) this.#viewer.setShading(marksId);
  }

  #showLegend(): void {
    if (this.#viewer.shading?.id !== marksId) return;
    const texts = [this.#isAllMilled ? "milled: nothing is chosen" : "left as it is", "milled", "avoided"];
    const rows = texts.map((text, i) => {
      const row = make("div", "swatch");
      const chip = make("i");
      chip.style.background = palette[i]!;
      row.append(chip, make("span", "", text));
      return row;
    });
    document.getElementById("legend-body")?.replaceChildren(...rows.filter((_, i) => i !== 1 || !this.#isAllMilled));
  }
}
