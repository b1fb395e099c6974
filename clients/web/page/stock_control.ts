// The body of the stock: nothing, a block, a round bar, or an outline in plan.
import { make, option } from "../../viewer/src/page_elements";
import { type Changed, type Control, labelled } from "./controls";
import { around, type DrawRing, ringText } from "./plan";
import type { Choice, Setting } from "./settings";

const kinds: [string, string][] = [["", "not stated"], ["block", "block around the part"], ["cylinder", "round bar"], ["outline", "outline in plan"]];

const usualMargin = 5; // mm

// The kind of a body and what follows it.
function split(text: string): [kind: string, rest: string] {
  const [, kind = "", rest = ""] = /^(\w*)[,:]?\s*(.*)$/s.exec(text)!;
  return [kind, rest];
}

export function stockSummary(text: string): string {
  const [kind, rest] = split(text);
  if (kind === "outline") return `outline of ${rest.split(/\s+/).filter(Boolean).length} points`;
  if (kind === "cylinder") return `round bar ${rest.split(",")[0]!} mm`;
  return kind === "block" ? `block${rest === "" ? "" : ` + ${rest} mm`}` : text;
}

function field(parent: HTMLElement, id: string, text: string, hint: string): HTMLInputElement {
  const input = make("input");
  input.type = "text";
  input.id = id;
  input.autocomplete = "off";
  input.spellcheck = false;
  input.inputMode = "decimal";
  input.placeholder = hint;
  const label = make("label", "", text);
  label.htmlFor = id;
  parent.append(label, input);
  return input;
}

export function makeStockControl(setting: Setting, choice: Choice, changed: Changed, draw: DrawRing): Control {
  const select = make("select");
  select.id = "set-stock";
  for (const [value, text] of kinds) select.append(option(value, text));
  const { row, error } = labelled(setting, select, select.id);
  const parts = new Map(["block", "cylinder", "outline"].map((kind) => [kind, make("div", "stock-part")] as const));
  const margin = field(parts.get("block")!, "stock-margin", "around the part, mm", "0");
  const diameter = field(parts.get("cylinder")!, "stock-diameter", "diameter, mm", "");
  const center = field(parts.get("cylinder")!, "stock-center", "axis at X,Y", "middle of the part");
  const points = make("textarea");
  points.id = "stock-points";
  points.rows = 5;
  points.spellcheck = false;
  points.placeholder = "X,Y in each line";
  points.setAttribute("aria-label", "Points of the outline: X,Y in each line, mm, from the program zero");
  const drawButton = make("button", "", "Draw \u2026");
  drawButton.type = "button";
  drawButton.id = "stock-draw";
  parts.get("outline")!.append(points, drawButton);
  error.before(...parts.values());

  const set = (value: string): void => {
    choice.set("stock", value);
    changed("stock");
  };
  const tail = (...texts: string[]): string => texts.map((t) => t.trim()).filter((t) => t !== "").map((t) => `,${t}`).join("");
  const read = (): void => {
    if (select.value === "block") set(`block${tail(margin.value)}`);
    else if (select.value === "cylinder") set(`cylinder,${diameter.value.trim()}${tail(center.value)}`);
    else if (select.value === "outline") set(`outline: ${points.value.split("\n").map((l) => l.replace(/\s*,\s*/g, ",").trim()).filter(Boolean).join(" ")}`);
    else set("");
  };
  const fill = (): void => {
    const [kind, rest] = split(choice.get("stock"));
    const isKnown = kinds.some(([k]) => k === kind);
    if (!isKnown && ![...select.options].some((o) => o.value === kind)) select.append(option(kind, choice.get("stock").slice(0, 40)));
    select.value = kind;
    for (const [k, part] of parts) part.hidden = k !== kind;
    const show = (input: HTMLInputElement | HTMLTextAreaElement, value: string): void => {
      if (document.activeElement !== input) input.value = value;
    };
    const [first = "", ...others] = rest.split(",");
    show(margin, kind === "block" ? rest : "");
    show(diameter, kind === "cylinder" ? first : "");
    show(center, kind === "cylinder" ? others.join(",") : "");
    show(points, kind === "outline" ? rest.split(/\s+/).filter(Boolean).join("\n") : "");
  };
  const drawOutline = async (): Promise<void> => {
    const ring = points.value.split("\n").map((l) => l.split(",").map(Number)).filter((p) => p.length === 2 && p.every(Number.isFinite));
    const drawn = await draw({ title: "Stock in plan", setting: "stock", ring: ring as [number, number][] });
    if (drawn === null) return;
    points.value = "";
    set(`outline: ${drawn.points}`);
  };
  drawButton.addEventListener("click", () => void drawOutline());
  select.addEventListener("change", () => {
    // Values of another kind mean something else. A new body begins with one that the part fits into.
    for (const input of [margin, diameter, center, points]) input.value = "";
    const part = draw.part();
    if (part !== null) {
      diameter.value = String(Math.ceil(Math.hypot(part.max[0]! - part.min[0]!, part.max[1]! - part.min[1]!)));
      points.value = ringText(around(part, usualMargin)).replaceAll(" ", "\n");
    }
    read();
    const first = parts.get(select.value)?.querySelector<HTMLElement>("input, textarea");
    if (select.value !== "block") first?.focus();
  });
  for (const input of [margin, diameter, center, points]) input.addEventListener("input", read);
  const focusOf = (): HTMLElement => parts.get(select.value)?.querySelector<HTMLElement>("input, textarea") ?? select;
  return {
    setting,
    row,
    get focus() {
      return focusOf();
    },
    fill,
    error,
    mark: (items) => {
      for (const input of [select, margin, diameter, center, points]) input.removeAttribute("aria-invalid");
      if (items.length > 0) focusOf().setAttribute("aria-invalid", "true");
    },
  };
}
