// The page's program: reads the scene of the page and shows it, or says why it cannot.
import { type Page, showPage } from "./page";
import { readPage } from "./page_data";
import { byId, make } from "./page_elements";
import type { Picked } from "./picked";
import { SceneError } from "./scene";
import type { ShadingId } from "./shading";

function showError(error: unknown): void {
  const box = byId("error");
  const isScene = error instanceof SceneError;
  const message = error instanceof Error ? error.message : String(error);
  box.replaceChildren(make("h2", "", isScene ? "The scene cannot be shown" : "The page cannot draw"), make("p", "", message));
  box.hidden = false;
  byId("loading").hidden = true;
  for (const id of ["legend", "player", "left", "right"]) byId(id).hidden = true;
  for (const button of document.querySelectorAll<HTMLButtonElement>("#bar button")) button.disabled = true;
}

// What tests and the console may use. All coordinates of pixels are those of the canvas.
export interface PatchmillView {
  ready: Promise<void>; // resolves when the first picture is drawn; rejects if the scene cannot be shown
  state: () => Record<string, unknown>; // time, place and tip of the tool, view, shading, layers, section, measured points
  setTime: (seconds: number) => void;
  setShading: (id: ShadingId) => void;
  pick: (x: number, y: number) => Picked | null; // as the hover shows it
  project: (point: [number, number, number]) => { x: number; y: number; depth: number };
  orbit: (yaw: number, pitch: number) => void; // degrees
  pixel: (x: number, y: number) => number[]; // draws, waits, and reads one pixel: red, green, blue, alpha
  wait: () => void; // in an animation frame: until the picture of this frame is drawn
}

function makeView(start: Promise<Page>): PatchmillView {
  let page: Page | null = null;
  const need = (): Page => {
    if (page === null) throw new Error("The page has no scene.");
    return page;
  };
  return {
    ready: start.then((p) => {
      page = p;
      p.viewer.readPixel(0, 0);
    }),
    state: () => {
      const { viewer, measure, playback } = need();
      return {
        time: viewer.time,
        total: viewer.timeline?.total ?? 0,
        ...viewer.place,
        tip: viewer.tip,
        yaw: viewer.camera.yaw,
        pitch: viewer.camera.pitch,
        height: viewer.camera.height,
        target: viewer.camera.target.toArray(),
        isOrthographic: viewer.camera.isOrthographic,
        shading: viewer.shading?.id ?? null,
        theme: viewer.theme,
        layers: viewer.layers.map((l) => ({ ...l })),
        pathPart: viewer.pathPart,
        pathPoint: viewer.pathPoint,
        section: { ...viewer.section },
        measured: measure.points,
        distance: measure.distance,
        isRunning: playback.isRunning,
        speed: playback.speed,
        frames: viewer.frames,
        drawnSegments: viewer.drawnSegments,
        levelSizes: viewer.levelSizes,
      };
    },
    setTime: (seconds) => need().viewer.setTime(seconds),
    setShading: (id) => need().viewer.setShading(id),
    pick: (x, y) => need().viewer.pick(x, y),
    project: (point) => need().viewer.camera.project(point),
    orbit: (yaw, pitch) => {
      need().viewer.camera.orbit(yaw, pitch);
      need().viewer.viewChanged();
    },
    pixel: (x, y) => need().viewer.readPixel(x, y),
    wait: () => void need().viewer.waitForPixel(0, 0),
  };
}

async function start(): Promise<Page> {
  document.documentElement.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  // The page is drawn once with its note that it loads.
  await new Promise((resolve) => setTimeout(resolve));
  const page = showPage(await readPage(document));
  byId("loading").hidden = true;
  return page;
}

const started = start();
started.catch(showError);
const view = makeView(started);
view.ready.catch(() => {}); // it is shown
(window as unknown as { patchmillView: PatchmillView }).patchmillView = view;
