// A tool of a file: its values go into the settings.
import { byId, option } from "../../viewer/src/page_elements";
import type { Choice } from "./settings";
import { type FileTool, readTools } from "./tool_file";

const names = ["tool-diameter", "flute-length", "shank-diameter", "stickout", "holder", "spindle", "feed", "plunge-feed", "tool-number", "holder-clearance"];
const maxBytes = 16 * 2 ** 20;

export function makeToolPanel(choice: Choice, changed: (name: string) => void, onError: (error: unknown) => void): void {
  const input = byId<HTMLInputElement>("tool-file");
  const list = byId<HTMLSelectElement>("tool-list");
  const note = byId("tool-note");
  let tools: FileTool[] = [];
  const take = (tool: FileTool): void => {
    for (const name of names) choice.set(name, tool.settings.get(name) ?? "");
    note.textContent = tool.note;
    changed("tool-diameter");
  };
  list.addEventListener("change", () => {
    const tool = tools[Number(list.value)];
    if (tool !== undefined) take(tool);
  });
  const read = async (file: File): Promise<void> => {
    if (file.size > maxBytes) throw new Error(`"${file.name}" has more than 16 MiB; it is no file of tools.`);
    const all = readTools(file.name, await file.text());
    tools = all.filter((t) => t.shape === "");
    if (tools.length === 0) {
      const others = all.slice(0, 5).map((t) => `${t.name} (${t.shape})`).join(", ");
      throw new Error(`"${file.name}" has no ball end mill. It has ${others === "" ? "no tools" : others}.`);
    }
    list.replaceChildren(...tools.map((t, i) => option(String(i), t.name)));
    list.hidden = tools.length < 2;
    take(tools[0]!);
  };
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (file !== undefined) read(file).catch(onError);
  });
}
