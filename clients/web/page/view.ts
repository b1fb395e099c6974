// The picture: a frame with the viewer for each scene. A new frame takes the place of the old one when it is drawn.
import { byId, make } from "../../viewer/src/page_elements";
import type { Clicked, FrameApi, FrameWindow, Mark } from "./frame/api";
import type { Box, PackedScene } from "./scene";

export interface ViewEvents {
  onClick: (clicked: Clicked) => void;
  onFile: (file: File) => void;
  onTheme: (isDark: boolean) => void;
}

export class View {
  readonly #events: ViewEvents;
  readonly #stage = byId("frames");
  #frame: HTMLIFrameElement | null = null;
  #next: HTMLIFrameElement | null = null;
  #box = ""; // of the scene that is shown
  #isProgram = false;
  #isPicking = false;
  #isDark = false;

  constructor(events: ViewEvents) {
    // A file of the frame cannot be read any more when the frame is gone; a copy of this page can.
    this.#events = { ...events, onFile: (file) => events.onFile(new File([file], file.name)) };
  }

  // Shows a scene. The view stays when the part lies as before.
  async show(scene: PackedScene, isProgram: boolean): Promise<void> {
    this.#next?.remove();
    const frame = make("iframe", "next");
    frame.title = isProgram ? "The program in 3-D" : "The part in 3-D";
    this.#next = frame;
    const loaded = new Promise((resolve) => frame.addEventListener("load", resolve, { once: true }));
    frame.src = "frame.html";
    this.#stage.append(frame);
    await loaded;
    if (this.#next !== frame) return; // a newer scene has come
    const api = (frame.contentWindow as FrameWindow | null)?.patchmillFrame;
    if (api === undefined) throw new Error("The 3-D view did not load.");
    const box = JSON.stringify(scene.header.box as Box);
    const before = this.api?.view() ?? null;
    const view = before !== null && box === this.#box ? before : null;
    const isOther = isProgram !== this.#isProgram;
    if (view !== null && isOther) view.shading = null;
    try {
      api.show(scene.header, scene.block, { isProgram, isDark: this.#isDark, view, isFitted: isOther, ...this.#events });
    } catch (error) {
      frame.remove();
      this.#next = null;
      throw error;
    }
    api.setPicking(this.#isPicking && !isProgram);
    this.#frame?.remove();
    frame.classList.remove("next");
    this.#frame = frame;
    this.#next = null;
    this.#box = box;
    this.#isProgram = isProgram;
    byId("empty").hidden = true;
  }

  // Takes the picture away.
  clear(): void {
    this.#next?.remove();
    this.#frame?.remove();
    this.#frame = this.#next = null;
    this.#box = "";
    byId("empty").hidden = false;
  }

  get api(): FrameApi | null {
    return (this.#frame?.contentWindow as FrameWindow | null)?.patchmillFrame ?? null;
  }

  setPicking(on: boolean): void {
    this.#isPicking = on;
    this.api?.setPicking(on);
  }

  setDark(isDark: boolean): void {
    this.#isDark = isDark;
    this.api?.setDark(isDark);
  }

  mark(marks: ReadonlyMap<string, Mark>, isAllMilled: boolean): void {
    this.api?.mark(marks, isAllMilled);
  }
}
