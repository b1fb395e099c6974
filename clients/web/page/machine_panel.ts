// The machine: a table of its axes, and files.
import { byId, make } from "../../viewer/src/page_elements";
import type { Changed, Control } from "./controls";
import { download } from "./downloads";
import { axisNames, axisValues, machineSettings, machineText, makeMachine, readMachine } from "./machine";
import type { ProblemItem } from "./problems";
import { type Choice, machineFile, settingOf } from "./settings";

const maxBytes = 2 ** 20;

// One table for the settings of the three axes: a column for each. A setting has its values with commas
// between them.
export function makeAxes(choice: Choice, changed: Changed): Control[] {
  const table = make("div", "axes");
  const errors = make("div", "axes-wrong");
  const cells = axisNames.map((axis) => axisValues.map((value, row) => makeCell(axis, row, value.label)));

  function makeCell(axis: string, row: number, label: string): HTMLInputElement {
    const input = make("input");
    input.type = "text";
    input.inputMode = "decimal";
    input.autocomplete = "off";
    input.spellcheck = false;
    input.id = row === 0 ? `set-machine-${axis}` : `set-machine-${axis}-${row}`;
    input.setAttribute("aria-label", `${axis.toUpperCase()}: ${label}, ${axisValues[row]!.unit}`);
    input.setAttribute("aria-describedby", `wrong-machine-${axis}`);
    input.addEventListener("input", () => {
      const texts = cells[axisNames.indexOf(axis as "x")]!.map((cell) => cell.value.replaceAll(",", " ").trim());
      choice.set(`machine-${axis}`, texts.every((t) => t === "") ? "" : texts.join(","));
      changed(`machine-${axis}`);
    });
    return input;
  }

  table.append(make("span"), ...axisNames.map((axis) => make("b", "", axis.toUpperCase())));
  axisValues.forEach(({ label, unit }, row) => {
    const name = make("span", "", `${label} `);
    name.append(make("span", "unit", unit));
    table.append(name, ...cells.map((column) => column[row]!));
  });
  const rows = make("div", "setting-rows");
  rows.append(table, errors);

  return axisNames.map((axis, k) => {
    const name = `machine-${axis}`;
    const column = cells[k]!;
    const error = make("p", "wrong");
    error.id = `wrong-${name}`;
    error.hidden = true;
    errors.append(error);
    const fill = (): void => {
      const texts = choice.get(name).split(",");
      column.forEach((cell, row) => {
        if (document.activeElement !== cell) cell.value = (texts[row] ?? "").trim();
      });
    };
    const mark = (items: readonly ProblemItem[]): void => {
      column.forEach((cell, row) => {
        const isNumber = cell.value.trim() !== "" && Number.isFinite(Number(cell.value));
        // What the page finds has no field: cells without a number are marked.
        const isWrong = items.some(({ field }) => (field === "" ? !isNumber : field.endsWith(axisValues[row]!.field) || field.endsWith(".axes")));
        if (isWrong) cell.setAttribute("aria-invalid", "true");
        else cell.removeAttribute("aria-invalid");
      });
    };
    return { setting: settingOf(name), row: rows, focus: column[0]!, fill, error, mark };
  });
}

// What a machine looks like (docs/machine.json), to change its values.
const example: [name: string, value: string][] = [
  ["machine-x", "-400,0,10000,5000,500"],
  ["machine-y", "-250,0,10000,5000,500"],
  ["machine-z", "-200,0,5000,3000,300"],
  ["machine-corner", "0.02"],
  ["machine-spindle", "100,24000"],
  ["machine-name", "bench mill"],
];

export function makeMachinePanel(choice: Choice, changed: Changed, onError: (error: unknown) => void): void {
  const input = byId<HTMLInputElement>("machine-file");
  const take = (values: ReadonlyMap<string, string>): void => {
    for (const name of machineSettings) choice.set(name, values.get(name) ?? "");
    changed("machine-x");
  };
  const read = async (file: File): Promise<void> => {
    if (file.size > maxBytes) throw new Error(`"${file.name}" has more than 1 MiB; it is no machine.`);
    take(readMachine(file.name, await file.text()));
  };
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (file !== undefined) read(file).catch(onError);
  });
  byId("machine-example").addEventListener("click", () => take(new Map(example)));
  byId("machine-clear").addEventListener("click", () => take(new Map()));
  byId("machine-save").addEventListener("click", () => {
    try {
      const machine = makeMachine(choice);
      if (machine === undefined) throw new Error("There is no machine yet. Fill in the values of its axes.");
      download(machineFile, machineText(machine), "application/json");
    } catch (error) {
      onError(error);
    }
  });
}
