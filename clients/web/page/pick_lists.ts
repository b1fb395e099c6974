// The lists of what is milled and avoided, beside the picture: all that a click does can be done here, too.
import { byId, make, option } from "../../viewer/src/page_elements";
import type { Choice } from "./settings";
import { changeOf, type RegionRow, setChange, type Surface } from "./surfaces";

const mostRows = 250;
const usualChanges: [string, string][] = [["", "as all"], ["off", "off"], ["contour", "contours"], ["zigzag", "lines"]];

export class PickLists {
  readonly #choice: Choice;
  readonly #changed: (name: string) => void;
  readonly #filter = byId<HTMLInputElement>("surface-filter");
  #surfaces: readonly Surface[] = [];
  #regions: readonly RegionRow[] = [];

  constructor(choice: Choice, changed: (name: string) => void) {
    this.#choice = choice;
    this.#changed = changed;
    this.#filter.addEventListener("input", () => this.fill());
    byId("text-mill").addEventListener("click", () => this.#takeText("only"));
    byId("text-avoid").addEventListener("click", () => this.#takeText("avoid"));
    byId("clear-area").addEventListener("click", () => {
      for (const name of ["only", "avoid", "region"]) choice.set(name);
      changed("only");
    });
  }

  // "f12+" is a face with its smooth neighbours; the server knows the other texts of a selection, too.
  #takeText(list: "only" | "avoid"): void {
    const input = byId<HTMLInputElement>("by-text");
    const texts = input.value.split(",").map((t) => t.trim()).filter((t) => t !== "");
    if (texts.length === 0) return;
    for (const text of texts) {
      this.#choice.toggle(list === "only" ? "avoid" : "only", text, false);
      this.#choice.toggle(list, text, true);
    }
    input.value = "";
    this.#changed(list);
  }

  setSurfaces(surfaces: readonly Surface[], areFaces: boolean): void {
    this.#surfaces = surfaces;
    byId("surfaces-title").textContent = surfaces.length === 0 ? "Faces" : `${areFaces ? "Faces" : "Patches"} (${surfaces.length})`;
    this.fill();
  }

  setRegions(regions: readonly RegionRow[]): void {
    this.#regions = regions;
    this.fill();
  }

  // Turns milled or avoided on, or off if it is on.
  toggle(selector: string, list: "only" | "avoid"): void {
    const isIn = this.#choice.list(list).includes(selector);
    this.#choice.toggle(list === "only" ? "avoid" : "only", selector, false);
    this.#choice.toggle(list, selector, !isIn);
    this.#changed(list);
  }

  toggleRegion(id: number): void {
    const region = this.#regions.find((r) => r.id === id);
    if (region === undefined) return;
    setChange(this.#choice, region.place, changeOf(this.#choice, region.place) === "off" ? "" : "off");
    this.#changed("region");
  }

  #button(selector: string, list: "only" | "avoid", name: string): HTMLButtonElement {
    const button = make("button", "", list === "only" ? "mill" : "avoid");
    button.type = "button";
    button.dataset.is = list;
    button.setAttribute("aria-pressed", String(this.#choice.list(list).includes(selector)));
    button.setAttribute("aria-label", `${button.textContent} ${name}`);
    button.addEventListener("click", () => this.toggle(selector, list));
    return button;
  }

  #surfaceRow({ name, selector, what }: Surface): HTMLElement {
    const row = make("li");
    row.dataset.key = `surface ${selector}`;
    const text = make("span", "what", what === "" ? name : `${name} `);
    if (what !== "") text.append(make("span", "", what));
    row.append(text, this.#button(selector, "only", name), this.#button(selector, "avoid", name));
    return row;
  }

  // Names that the address has and the list does not, such as "kind=cylinder".
  #otherRows(): HTMLElement[] {
    const known = new Set(this.#surfaces.map((s) => s.selector));
    const others = [...new Set([...this.#choice.list("only"), ...this.#choice.list("avoid")])].filter((s) => !known.has(s));
    return others.map((selector) => this.#surfaceRow({ name: selector, selector, what: "chosen by this text", isPlane: false }));
  }

  #regionRow({ id, place, name, color }: RegionRow): HTMLElement {
    const row = make("li");
    row.dataset.key = `region ${place}`;
    const chip = make("i");
    chip.style.background = color;
    const select = make("select");
    const change = changeOf(this.#choice, place);
    for (const [value, text] of usualChanges) select.append(option(value, text));
    if (!usualChanges.some(([value]) => value === change)) select.append(option(change, change));
    select.value = change;
    select.setAttribute("aria-label", `How region ${id} is cut`);
    select.addEventListener("change", () => {
      setChange(this.#choice, place, select.value);
      this.#changed("region");
    });
    row.append(chip, make("span", "what", id < 0 ? name : `${id} ${name}`), select);
    return row;
  }

  fill(): void {
    const words = this.#filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = this.#surfaces.filter(({ name, what }) => words.every((w) => `${name} ${what}`.toLowerCase().includes(w)));
    this.#replace(byId("surfaces"), [...this.#otherRows(), ...found.slice(0, mostRows).map((s) => this.#surfaceRow(s))]);
    const more = found.length - mostRows;
    byId("surfaces-more").textContent = more > 0 ? `${more} more: the filter finds them.` : "";
    this.#filter.hidden = this.#surfaces.length < 12;
    const places = new Set(this.#regions.map((r) => r.place));
    const others = this.#choice.list("region").filter((t) => !places.has(t.split(":")[0]!));
    const rows = this.#regions.map((r) => this.#regionRow(r));
    rows.push(...others.map((t) => this.#regionRow({ id: -1, place: t.split(":")[0]!, name: `at ${t.split(":")[0]}`, color: "transparent" })));
    this.#replace(byId("regions"), rows);
  }

  // Puts new rows in and leaves the focus where it is.
  #replace(list: HTMLElement, rows: HTMLElement[]): void {
    const focused = document.activeElement;
    const key = focused?.closest<HTMLElement>("li")?.dataset.key;
    const place = key === undefined ? -1 : [...focused!.closest("li")!.querySelectorAll("button, select")].indexOf(focused!);
    const isHere = list.contains(focused);
    const { scrollTop } = list;
    list.replaceChildren(...rows);
    list.scrollTop = scrollTop;
    if (isHere) rows.find((r) => r.dataset.key === key)?.querySelectorAll<HTMLElement>("button, select")[place]?.focus({ preventScroll: true });
  }
}
