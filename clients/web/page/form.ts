// The controls of the settings, made from their table.
import { byId, make, option } from "../../viewer/src/page_elements";
import type { Problem } from "./problems";
import { defaultCuttingData } from "./request";
import { type Choice, type Setting, settingOf, settings } from "./settings";

interface Control {
  setting: Setting;
  row: HTMLElement;
  focus: HTMLElement;
  fill: () => void;
  error: HTMLElement;
}

type Changed = (name: string) => void;

function note(setting: Setting): [HTMLElement, HTMLElement] {
  const help = make("p", "help", setting.help);
  help.id = `help-${setting.name}`;
  const error = make("p", "wrong");
  error.id = `wrong-${setting.name}`;
  error.hidden = true;
  return [help, error];
}

function labelled(setting: Setting, input: HTMLElement, id: string): { row: HTMLElement; error: HTMLElement } {
  const row = make("div", "setting");
  const label = make("label", "name", setting.label);
  label.htmlFor = id;
  const box = make("span", "field");
  box.append(input);
  if (setting.unit !== undefined) box.append(make("span", "unit", setting.unit));
  const [help, error] = note(setting);
  input.setAttribute("aria-describedby", `${help.id} ${error.id}`);
  label.title = setting.help;
  row.append(label, box, help, error);
  return { row, error };
}

function makeText(setting: Setting, choice: Choice, changed: Changed): Control {
  const isLong = setting.kind === "lines";
  const input = isLong ? make("textarea") : make("input");
  input.id = `set-${setting.name}`;
  input.placeholder = setting.hint ?? setting.default;
  input.spellcheck = false;
  if (input instanceof HTMLTextAreaElement) input.rows = 2;
  else {
    input.type = "text";
    input.autocomplete = "off";
    if (setting.kind === "number" || setting.kind === "whole") input.inputMode = "decimal";
  }
  input.addEventListener("input", () => {
    choice.set(setting.name, ...(isLong ? input.value.split("\n") : setting.kind === "list" ? input.value.split(/[,\s]+/) : [input.value]));
    changed(setting.name);
  });
  const { row, error } = labelled(setting, input, input.id);
  const fill = (): void => {
    const list = choice.list(setting.name);
    const value = isLong ? list.join("\n") : setting.kind === "list" ? list.join(", ") : choice.get(setting.name);
    if (document.activeElement !== input) input.value = value;
  };
  return { setting, row, focus: input, fill, error };
}

function makeChoice(setting: Setting, choice: Choice, changed: Changed): Control {
  const select = make("select");
  select.id = `set-${setting.name}`;
  for (const [value, text] of setting.choices ?? []) select.append(option(value, text));
  select.addEventListener("change", () => {
    choice.set(setting.name, select.value);
    changed(setting.name);
  });
  const { row, error } = labelled(setting, select, select.id);
  const fill = (): void => {
    const value = choice.get(setting.name);
    // A value of the address that the list does not have goes to the server, which says what is wrong with it.
    if (![...select.options].some((o) => o.value === value)) select.append(option(value, value));
    select.value = value;
  };
  return { setting, row, focus: select, fill, error };
}

function makeFlag(setting: Setting, choice: Choice, changed: Changed): Control {
  const row = make("div", "setting flag");
  const label = make("label", "check");
  const input = make("input");
  input.type = "checkbox";
  input.id = `set-${setting.name}`;
  label.title = setting.help;
  label.append(input, make("span", "", setting.label));
  const [help, error] = note(setting);
  input.setAttribute("aria-describedby", `${help.id} ${error.id}`);
  input.addEventListener("change", () => {
    choice.set(setting.name, input.checked ? "1" : "");
    changed(setting.name);
  });
  row.append(label, help, error);
  return { setting, row, focus: input, fill: () => void (input.checked = choice.isSet(setting.name)), error };
}

// A list of usual texts, and a field for any other.
function makeOpen(setting: Setting, usual: [string, string][], otherText: string, choice: Choice, changed: Changed): Control & { rename: (texts: Map<string, string>) => void } {
  const select = make("select");
  select.id = `set-${setting.name}`;
  for (const [value, text] of usual) select.append(option(value, text));
  select.append(option("\u0000", otherText));
  const input = make("input");
  input.type = "text";
  input.spellcheck = false;
  input.autocomplete = "off";
  input.placeholder = setting.hint ?? "";
  input.setAttribute("aria-label", `${setting.label}: ${otherText}`);
  const both = make("span", "both");
  both.append(select, input);
  const { row, error } = labelled(setting, both, select.id);
  let isOther = false;
  let last: string | null = null;
  const fill = (): void => {
    const value = choice.get(setting.name);
    const isUsual = usual.some(([v]) => v === value);
    // A value that came from elsewhere decides; one that is typed does not close its field.
    if (value !== last && document.activeElement !== input) isOther = !isUsual;
    last = value;
    select.value = isOther ? "\u0000" : value;
    input.hidden = !isOther;
    if (document.activeElement !== input) input.value = isOther && !isUsual ? value : "";
  };
  select.addEventListener("change", () => {
    isOther = select.value === "\u0000";
    if (!isOther) {
      choice.set(setting.name, select.value);
      changed(setting.name);
    }
    fill();
    if (isOther) input.focus();
  });
  input.addEventListener("input", () => {
    choice.set(setting.name, input.value);
    changed(setting.name);
  });
  const rename = (texts: Map<string, string>): void => {
    for (const o of select.options) o.textContent = texts.get(o.value) ?? usual.find(([v]) => v === o.value)?.[1] ?? otherText;
  };
  return { setting, row, focus: select, fill, error, rename };
}

const upNames: [string, string][] = [["z", "Z of the model"], ["y", "Y of the model"], ["x", "X of the model"], ["-z", "\u2212Z of the model"], ["-y", "\u2212Y of the model"], ["-x", "\u2212X of the model"], ["auto", "the axis that shows most"]];
const zeroNames: [string, string][] = [["", "origin, not stated"], ["origin", "origin of the model"], ["top-center", "top, middle"], ["bottom-corner", "bottom, corner"]];
const stockNames: [string, string][] = [["", "not stated"], ["block", "block as the part"], ["block,2", "block, 2 mm around"], ["block,5", "block, 5 mm around"]];

export class Form {
  readonly #choice: Choice;
  readonly #controls: Control[] = [];
  #rename: (texts: Map<string, string>) => void = () => {};

  constructor(choice: Choice, changed: Changed) {
    this.#choice = choice;
    for (const setting of settings) {
      if (["only", "avoid", "region"].includes(setting.name)) continue; // these have lists of their own
      const control = this.#make(setting, changed);
      this.#controls.push(control);
      byId(`${setting.isRare ? "more" : "group"}-${setting.group}`).append(control.row);
    }
    this.fill();
  }

  #make(setting: Setting, changed: Changed): Control {
    const choice = this.#choice;
    if (setting.name === "up") {
      const open = makeOpen(setting, upNames, "a plane face \u2026", choice, changed);
      this.#rename = open.rename;
      return open;
    }
    if (setting.name === "zero") return makeOpen(setting, zeroNames, "a point X,Y,Z \u2026", choice, changed);
    if (setting.name === "stock") return makeOpen(setting, stockNames, "block,MARGIN or cylinder,D \u2026", choice, changed);
    if (setting.kind === "flag") return makeFlag(setting, choice, changed);
    if (setting.kind === "choice") return makeChoice(setting, choice, changed);
    return makeText(setting, choice, changed);
  }

  // What each axis shows, behind its name.
  describeUp(notes: ReadonlyMap<string, string>): void {
    this.#rename(new Map(upNames.map(([value, text]) => [value, notes.has(value) ? `${text}: ${notes.get(value)}` : text])));
  }

  // The dialects of the server, in place of the one that all servers have.
  setPosts(posts: readonly { name: string; title: string }[]): void {
    const select = byId<HTMLSelectElement>("set-post");
    select.replaceChildren(...posts.map(({ name, title }) => option(name, title)));
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
    for (const group of ["tool", "finish", "stock", "area", "passes", "program"]) byId(`sum-${group}`).textContent = this.#summaryOf(group);
  }

  #summaryOf(group: string): string {
    const get = (name: string): string => this.#choice.get(name);
    const isSet = (name: string): boolean => this.#choice.isSet(name);
    if (group === "tool") return [`ball ${get("tool-diameter") || "6"} mm`, isSet("holder") ? "with holder" : ""].filter(Boolean).join(", ");
    if (group === "finish") return `scallop ${get("scallop")} mm${isSet("leave") ? `, leave ${get("leave")}` : ""}`;
    if (group === "stock") return [get("stock"), isSet("allowance") ? `allowance ${get("allowance")} mm` : "", isSet("obstacle") ? `${this.#choice.list("obstacle").length} clamps` : ""].filter(Boolean).join(", ") || "not stated";
    if (group === "area") {
      const count = (name: string, text: string): string => (isSet(name) ? `${this.#choice.list(name).length} ${text}` : "");
      return [isSet("only") ? count("only", "milled") : "all", count("avoid", "avoided"), count("region", "regions changed")].filter(Boolean).join(", ");
    }
    if (group === "passes") return { auto: "contours and lines", contour: "contours", zigzag: "zig-zag lines" }[get("strategy")] ?? get("strategy");
    return `${get("post")}, ${get("work-offset")}`;
  }

  // Marks the settings that are wrong; without a problem it takes all marks away.
  mark(problem: Problem | null): void {
    for (const { setting, error, focus } of this.#controls) {
      const texts = (problem?.items ?? []).filter((item) => item.setting === setting.name).map((item) => item.text);
      error.hidden = texts.length === 0;
      error.textContent = texts.join(" ");
      if (texts.length === 0) focus.removeAttribute("aria-invalid");
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
