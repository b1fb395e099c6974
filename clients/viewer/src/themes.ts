// Colours of the canvas in light and dark. Those of the page are in page.css.
import { PathClass } from "./path_vertices";

export type ThemeName = "light" | "dark";

export interface Theme {
  background: string;
  ink: string; // of signs on the part
  stock: string;
  section: string;
  paths: string[]; // by class, from rapid to cut without a kind
}

export const themes: Record<ThemeName, Theme> = {
  light: {
    background: "#f3f5f7",
    ink: "#14181d",
    stock: "#8c7a5b",
    section: "#b3541e",
    paths: ["#d03b4b", "#2d9150", "#0c93a6", "#8450c4", "#1f5fbf"],
  },
  dark: {
    background: "#14181d",
    ink: "#f4f6f8",
    stock: "#b8a27a",
    section: "#ff9a57",
    paths: ["#ff6b78", "#46c274", "#2fc4d8", "#b48cf0", "#5b9bff"],
  },
};

// Each kind of pass has a colour of its own; kinds that the page does not know take the next ones.
const knownPasses: Record<string, [string, string]> = {
  zigzag: ["#1f5fbf", "#5b9bff"],
  "zig-zag": ["#1f5fbf", "#5b9bff"],
  contour: ["#0a6f55", "#34c79c"],
  border: ["#b35309", "#ffa04d"],
  pencil: ["#a5146c", "#ff6fbe"],
  rest: ["#6b6a00", "#d6d33a"],
};
const otherPasses: [string, string][] = [
  ["#4b3fb5", "#9d92ff"],
  ["#7d4a1a", "#d59a61"],
  ["#3a6b1f", "#8fd066"],
  ["#7a2340", "#e57f9f"],
];

export function passColor(name: string, index: number, theme: ThemeName): string {
  const pair = Object.hasOwn(knownPasses, name) ? knownPasses[name]! : otherPasses[index % otherPasses.length]!;
  return pair[theme === "light" ? 0 : 1];
}

export const pathClassNames = ["Rapids", "Approach and retract", "Leads", "Links", "Passes"];

export function classColor(index: number, passes: string[], theme: ThemeName): string {
  if (index < PathClass.firstPass) return themes[theme].paths[index]!;
  const pass = index - PathClass.firstPass;
  return passColor(passes[pass] ?? "", pass, theme);
}
