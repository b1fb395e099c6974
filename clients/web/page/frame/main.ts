// The frame: the viewer's page with a scene that the front end hands over.
import { type Page, showPage } from "../../../viewer/src/page";
import { byId } from "../../../viewer/src/page_elements";
import { readScene } from "../../../viewer/src/read_scene";
import type { ShadingId } from "../../../viewer/src/shading";
import { chooseTab, togglePanel } from "../../../viewer/src/tabs";
import type { FrameApi, FrameWindow, Shown, View } from "./api";
import { MarkShading } from "./marks";

let page: Page | null = null;
let marks: MarkShading | null = null;
let isPicking = false;

const need = (): Page => {
  if (page === null) throw new Error("The view has no scene yet.");
  return page;
};

const isDark = (): boolean => document.documentElement.dataset.theme === "dark";

function followClicks({ onClick }: Shown): void {
  const canvas = byId<HTMLCanvasElement>("canvas");
  const { viewer } = need();
  const slop = 5; // px that a click may move
  let down: { x: number; y: number } | null = null;
  const choose = (x: number, y: number): void => {
    if (!isPicking || byId("measure").getAttribute("aria-pressed") === "true") return;
    const picked = viewer.pick(x, y, 0);
    if (picked?.kind !== "surface") return;
    // The name of a region begins with its id.
    const id = /^\d+/.exec(picked.region ?? "")?.[0];
    onClick({ surface: picked.surface, region: id === undefined ? null : Number(id) });
  };
  canvas.addEventListener("pointerdown", (event) => {
    down = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (down === null || Math.hypot(event.clientX - down.x, event.clientY - down.y) > slop) return;
    down = null;
    const box = canvas.getBoundingClientRect();
    choose(event.clientX - box.left, event.clientY - box.top);
  });
  canvas.addEventListener("keydown", (event) => {
    if (event.key === "Enter") choose(viewer.camera.width / 2, viewer.camera.heightPx / 2);
  });
}

function followFiles({ onFile }: Shown): void {
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file !== undefined) onFile(file);
  });
}

function setDark(wanted: boolean): void {
  if (isDark() !== wanted) byId("theme").click();
}

function restore(view: View, isFitted: boolean): void {
  const { viewer } = need();
  Object.assign(viewer.camera, { yaw: view.yaw, pitch: view.pitch, height: view.height });
  viewer.camera.target.set(...view.target);
  if (view.isOrthographic) byId("projection").click();
  if (isFitted) viewer.fit();
  if (view.shading !== null && viewer.shadings.some((s) => s.id === view.shading)) viewer.setShading(view.shading as ShadingId);
  viewer.viewChanged();
}

const api: FrameApi = {
  show: (header, block, shown) => {
    document.documentElement.dataset.theme = shown.isDark ? "dark" : "light";
    const scene = readScene(header, block);
    page = showPage(scene);
    marks = new MarkShading(page.viewer);
    byId("loading").hidden = true;
    byId("player").hidden = !shown.isProgram;
    byId("show-right").textContent = shown.isProgram ? "Program" : "Findings";
    byId("tab-program").hidden = !shown.isProgram;
    byId("tab-figures").hidden = !shown.isProgram;
    if (!shown.isProgram) chooseTab("findings");
    // There is room for one panel beside the settings.
    if (!byId("left").hidden) togglePanel("left");
    if (!byId("right").hidden && !shown.isProgram) togglePanel("right");
    followClicks(shown);
    followFiles(shown);
    setDark(shown.isDark);
    if (shown.view !== null) restore(shown.view, shown.isFitted);
    new MutationObserver(() => shown.onTheme(isDark())).observe(document.documentElement, { attributeFilter: ["data-theme"] });
  },
  view: () => {
    const { camera, shading } = need().viewer;
    const { yaw, pitch, height, isOrthographic } = camera;
    return { yaw, pitch, height, isOrthographic, target: camera.target.toArray(), shading: shading?.id ?? null };
  },
  setDark,
  setPicking: (on) => {
    isPicking = on;
    byId("canvas").classList.toggle("picking", on);
  },
  mark: (of, isAllMilled) => marks?.set(of, isAllMilled),
  shade: (id) => need().viewer.setShading(id as ShadingId),
  findPlace: (code, message) => {
    const found = [...document.querySelectorAll<HTMLElement>("button.finding")].find(
      (b) => b.querySelector("code")?.textContent === code && b.querySelector("p")?.textContent === message,
    );
    found?.click();
  },
  state: () => {
    const { viewer, playback } = need();
    const { time, place, tip, shading, theme, layers } = viewer;
    return {
      time,
      total: viewer.timeline?.total ?? 0,
      ...place,
      tip,
      shading: shading?.id ?? null,
      theme,
      layers: layers.map((l) => ({ ...l })),
      isRunning: playback.isRunning,
      regions: viewer.scene.header.regions.length,
      surfaces: viewer.scene.header.surfaces,
    };
  },
  pick: (x, y) => need().viewer.pick(x, y),
  project: (point) => need().viewer.camera.project(point),
  setTime: (seconds) => need().viewer.setTime(seconds),
  pixel: (x, y) => need().viewer.readPixel(x, y),
};

(window as FrameWindow).patchmillFrame = api;
