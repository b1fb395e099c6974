// The controls of the settings, made from their table.
import { byId, make, option } from "../../viewer/src/page_elements";
import { type Changed, type Control, followHelp, makeChoice, makeFlag, makeOpen, makeText } from "./controls";
import { makeAxes } from "./machine_panel";
import { settingOfFile } from "./own_post";
import type { DrawRing } from "./plan";
import type { Problem } from "./problems";
import { defaultCuttingData } from "./request";
import { type Choice, type Setting, settingOf, settings } from "./settings";
import { makeStockControl, stockSummary } from "./stock_control";

const upNames: [string, string][] = [["z", "Z of the model"], ["y", "Y of the model"], ["x", "X of the model"], ["-z", "\u2212Z of the model"], ["-y", "\u2212Y of the model"], ["-x", "\u2212X of the model"], ["auto", "the axis that shows most"]];
const zeroNames: [string, string][] = [["", "origin, not stated"], ["origin", "origin of the model"], ["top-center", "top, middle"], ["bottom-corner", "bottom, corner"]];

export class Form {
  readonly #choice: Choice;
  readonly #controls: Control[] = [];
  #rename: (texts: Map<string, string>) => void = () => {};

  constructor(choice: Choice, changed: Changed, draw: DrawRing) {
    this.#choice = choice;
    const axes = makeAxes(choice, changed);
    for (const setting of settings) {
      if (["only", "avoid", "region"].includes(setting.name)) continue; // these have lists of their own
      const control = axes.find((c) => c.setting === setting) ?? this.#make(setting, changed, draw);
      this.#controls.push(control);
      byId(`${setting.isRare ? "more" : "group"}-${setting.group}`).append(control.row);
    }
    followHelp(byId("settings"));
    this.fill();
  }

  #make(setting: Setting, changed: Changed, draw: DrawRing): Control {
    const choice = this.#choice;
    if (setting.name === "up") {
      const open = makeOpen(setting, upNames, "a plane face \u2026", choice, changed);
      this.#rename = open.rename;
      return open;
    }
    if (setting.name === "zero") return makeOpen(setting, zeroNames, "a point X,Y,Z \u2026", choice, changed);
    if (setting.name === "stock") return makeStockControl(setting, choice, changed, draw);
    if (setting.name === "boundary" || setting.name === "obstacle") return this.#makeRings(setting, changed, draw);
    if (setting.kind === "flag") return makeFlag(setting, choice, changed);
    if (setting.kind === "choice") return makeChoice(setting, choice, changed);
    return makeText(setting, choice, changed);
  }

  // Lines with outlines, and a button that draws one more.
  #makeRings(setting: Setting, changed: Changed, draw: DrawRing): Control {
    const choice = this.#choice;
    const control = makeText(setting, choice, changed);
    const button = make("button", "small", "Draw one \u2026");
    button.type = "button";
    button.addEventListener("click", () => {
      const title = setting.name === "boundary" ? "Boundary in plan" : "Clamp in plan";
      void draw({ title, setting: setting.name, ring: [] }).then((drawn) => {
        if (drawn === null) return;
        const lines = choice.list(setting.name);
        const head = setting.name === "boundary" ? "" : `clamp ${lines.length + 1}=${drawn.top},2: `;
        choice.set(setting.name, ...lines, `${head}${drawn.points}`);
        changed(setting.name);
      });
    });
    control.row.append(button);
    return control;
  }

  // What each axis shows, behind its name.
  describeUp(notes: ReadonlyMap<string, string>): void {
    this.#rename(new Map(upNames.map(([value, text]) => [value, notes.has(value) ? `${text.replace(" of the model", "")} ${notes.get(value)}` : text])));
  }

  // The dialects of the server, in place of the one that all servers have.
  setPosts(posts: readonly { name: string; title: string }[]): void {
    const select = byId<HTMLSelectElement>("set-post");
    select.replaceChildren(...posts.map(({ name, title }) => option(name, title)));
    this.fill();
  }

  // The post file of the user's own, among the dialects.
  addPost(fileName: string): void {
    const select = byId<HTMLSelectElement>("set-post");
    const value = settingOfFile(fileName);
    if (![...select.options].some((o) => o.value === value)) select.append(option(value, `own file: ${fileName}`));
    this.fill();
  }

  // The defaults of spindle speed and feeds depend on the ball.
  #hintCuttingData(): void {
    const [diameter, feed] = ["tool-diameter", "feed"].map((name) => Number(this.#choice.get(name)));
    const usual = defaultCuttingData(diameter! > 0 ? diameter! : 6, feed! > 0 ? feed : undefined);
    const hints = { spindle: usual.spindle, feed: usual.feed, "plunge-feed": usual.plunge };
    for (const [name, value] of Object.entries(hints)) byId<HTMLInputElement>(`set-${name}`).placeholder = `${value}, assumed`;
  }

  fill(): void {
    for (const { fill } of this.#controls) fill();
    this.#hintCuttingData();
    for (const group of ["tool", "finish", "stock", "area", "passes", "motion", "machine", "program"]) byId(`sum-${group}`).textContent = this.#summaryOf(group);
  }

  #summaryOf(group: string): string {
    const get = (name: string): string => this.#choice.get(name);
    const isSet = (name: string): boolean => this.#choice.isSet(name);
    if (group === "tool") return [`ball ${get("tool-diameter") || "6"} mm`, isSet("holder") ? "with holder" : ""].filter(Boolean).join(", ");
    if (group === "finish") return `scallop ${get("scallop")} mm${isSet("leave") ? `, leave ${get("leave")}` : ""}`;
    if (group === "stock") return [stockSummary(get("stock")), isSet("allowance") ? `allowance ${get("allowance")} mm` : "", isSet("obstacle") ? `${this.#choice.list("obstacle").length} clamps` : ""].filter(Boolean).join(", ") || "not stated";
    if (group === "area") {
      const count = (name: string, text: string): string => (isSet(name) ? `${this.#choice.list(name).length} ${text}` : "");
      return [isSet("only") ? count("only", "milled") : "all", count("avoid", "avoided"), count("region", "regions changed")].filter(Boolean).join(", ");
    }
    if (group === "passes") return { auto: "contours and lines", contour: "contours", zigzag: "zig-zag lines" }[get("strategy")] ?? get("strategy");
    if (group === "motion") {
      const count = settings.filter((s) => s.group === "motion" && isSet(s.name)).length;
      return count === 0 ? "defaults" : `${count} stated`;
    }
    if (group === "machine") return get("machine-name") || (["x", "y", "z"].some((axis) => isSet(`machine-${axis}`)) ? "stated" : "not stated");
    return `${get("post").replace(/^\.\//, "")}, ${get("work-offset")}`;
  }

  // Marks the settings that are wrong; without a problem it takes all marks away.
  mark(problem: Problem | null): void {
    for (const { setting, error, focus, mark } of this.#controls) {
      const items = (problem?.items ?? []).filter((item) => item.setting === setting.name);
      error.hidden = items.length === 0;
      error.replaceChildren(...items.flatMap(({ text, field }) => [`${text} `, ...(field === "" ? [] : [make("code", "", field)])]));
      if (mark !== undefined) mark(items);
      else if (items.length === 0) focus.removeAttribute("aria-invalid");
      else focus.setAttribute("aria-invalid", "true");
    }
  }

  // Opens the group of a setting and goes to its control.
  goTo(name: string): void {
    const control = this.#controls.find((c) => c.setting.name === name);
    const target = control?.focus ?? byId(`group-${settingOf(name).group}`);
    for (let e: HTMLElement | null = target; e !== null; e = e.parentElement) if (e instanceof HTMLDetailsElement) e.open = true;
    target.scrollIntoView({ block: "center" });
    target.focus();
  }
}
