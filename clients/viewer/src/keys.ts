// The keys of the page and their help.
import { byId, make } from "./page_elements";

export interface Key {
  keys: string[]; // as KeyboardEvent.key names them
  shown: string;
  help: string;
  act: (event: KeyboardEvent) => void;
}

const mouse: [string, string][] = [
  ["drag", "turn"],
  ["shift or right drag", "shift the picture"],
  ["wheel", "zoom at the pointer"],
  ["one finger, two fingers", "turn; shift and zoom"],
  ["click on a path", "set the time to it"],
];

export function makeHelp(keys: Key[]): void {
  const rows: [string, string][] = [...mouse, ...keys.map(({ shown, help }) => [shown, help] as [string, string])];
  byId("help-body").replaceChildren(
    ...rows.map(([shown, help]) => {
      const row = make("div");
      row.append(make("span", "", help), make("kbd", "", shown));
      return row;
    }),
  );
}

// Keys that a control uses itself are left to it.
function belongsTo(target: HTMLElement, key: string): boolean {
  if (target.closest("dialog[open]")) return true;
  if (target instanceof HTMLSelectElement) return key.length === 1 || key.startsWith("Arrow") || key === "Home" || key === "End" || key === "Enter";
  if (target instanceof HTMLInputElement && target.type === "range") return key.startsWith("Arrow") || key === "Home" || key === "End";
  if (target instanceof HTMLButtonElement || target.tagName === "SUMMARY") return key === " " || key === "Enter";
  if (target instanceof HTMLInputElement) return key === " ";
  return false;
}

export function followKeys(keys: Key[]): void {
  const byKey = new Map(keys.flatMap((k) => k.keys.map((name) => [name, k] as const)));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (event.target instanceof HTMLElement && belongsTo(event.target, event.key)) return;
    const key = byKey.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
    if (key === undefined) return;
    event.preventDefault();
    key.act(event);
  });
}
