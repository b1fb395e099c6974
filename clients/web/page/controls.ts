// Controls of single settings: each shows its value, takes a new one, and has a place for what is wrong with
// it.
import { make, option } from "../../viewer/src/page_elements";
import type { ProblemItem } from "./problems";
import type { Choice, Setting } from "./settings";

export interface Control {
  setting: Setting;
  row: HTMLElement;
  focus: HTMLElement;
  fill: () => void;
  error: HTMLElement;
  mark?: (items: readonly ProblemItem[]) => void; // marks what is wrong, where that is not `focus`
}

export type Changed = (name: string) => void;

export function note(setting: Setting): [HTMLElement, HTMLElement] {
  const help = make("p", "help", setting.help);
  help.id = `help-${setting.name}`;
  const error = make("p", "wrong");
  error.id = `wrong-${setting.name}`;
  error.hidden = true;
  return [help, error];
}

export function labelled(setting: Setting, input: HTMLElement, id: string): { row: HTMLElement; error: HTMLElement } {
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

export function makeText(setting: Setting, choice: Choice, changed: Changed): Control {
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

export function makeChoice(setting: Setting, choice: Choice, changed: Changed): Control {
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
    // A value of the address that the list does not have goes to the server, which says what is wrong with
    // it.
    if (![...select.options].some((o) => o.value === value)) select.append(option(value, value));
    select.value = value;
  };
  return { setting, row, focus: select, fill, error };
}

export function makeFlag(setting: Setting, choice: Choice, changed: Changed): Control {
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
export function makeOpen(setting: Setting, usual: [string, string][], otherText: string, choice: Choice, changed: Changed): Control & { rename: (texts: Map<string, string>) => void } {
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

// Shows the help of the setting that has the focus. What lies below moves by it, so it waits until a click
// has ended: else the button that was pressed would no longer lie under the pointer, and the click would be
// lost.
export function followHelp(settings: HTMLElement): void {
  let isPressed = false;
  const show = (): void => {
    const row = document.activeElement?.closest(".setting") ?? null;
    for (const other of settings.querySelectorAll(".setting.helped")) if (other !== row) other.classList.remove("helped");
    row?.classList.add("helped");
  };
  const showSoon = (): void => {
    if (!isPressed) show();
  };
  const release = (): void => {
    isPressed = false;
    window.setTimeout(show); // the click comes first
  };
  settings.addEventListener("pointerdown", () => (isPressed = true));
  for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, release);
  settings.addEventListener("focusin", showSoon);
  settings.addEventListener("focusout", () => window.setTimeout(showSoon));
}
