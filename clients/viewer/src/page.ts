// Puts a viewer into the page and joins it with the controls.
import { makeFindings } from "./findings_panel";
import { Hover } from "./hover";
import { followKeys, type Key, makeHelp } from "./keys";
import { chooseAxis, makeLayers, makeSection } from "./layers_panel";
import { makeLegend } from "./legend";
import { Measure } from "./measure";
import { Overlay } from "./overlay";
import { byId, make, press } from "./page_elements";
import type { Picked } from "./picked";
import { Playback } from "./playback";
import { changeSpeed, makePlayer } from "./player";
import { followPointer } from "./pointer";
import { ProgramPanel } from "./program_panel";
import type { Scene } from "./scene";
import type { StandardView } from "./camera";
import { makePanels, makeTabs, togglePanel } from "./tabs";
import type { ThemeName } from "./themes";
import { Viewer } from "./viewer";

const dark = matchMedia("(prefers-color-scheme: dark)");

export interface Page {
  viewer: Viewer;
  measure: Measure;
  playback: Playback;
  click: (x: number, y: number) => void;
}

export function showPage(scene: Scene): Page {
  makePanels();
  makeTabs();
  const canvas = byId<HTMLCanvasElement>("canvas");
  const viewer = new Viewer(canvas, scene, dark.matches ? "dark" : "light");
  const measure = new Measure();
  const overlay = new Overlay(viewer, document.querySelector<SVGSVGElement>("#overlay")!, measure);
  const playback = new Playback(viewer);
  const hover = new Hover(viewer);
  let isMeasuring = false;

  showTitle(scene);
  makeLegend(viewer);
  makeLayers(viewer);
  makeSection(viewer);
  makePlayer(viewer, playback);
  makeFindings(viewer, overlay);
  new ProgramPanel(viewer);

  const fillMeasure = (): void => {
    press(byId("measure"), isMeasuring);
    canvas.classList.toggle("picking", isMeasuring);
    const hints = ["Pick the first point.", "Pick the second point.", "Pick again to begin anew."];
    overlay.hint = isMeasuring && measure.points.length < 2 ? hints[measure.points.length]! : "";
    byId("measure-hint").textContent = isMeasuring ? hints[measure.points.length]! : "Press Measure, then pick two points.";
    byId("measure-values").replaceChildren(...measure.rows.flatMap(([n, v]) => [make("dt", "", n), make("dd", "", v)]));
    byId("measure-clear").hidden = measure.points.length === 0;
    overlay.queue();
  };
  const setMeasuring = (on: boolean): void => {
    isMeasuring = on;
    fillMeasure();
    if (on) byId("measure-hint").scrollIntoView({ block: "nearest" });
  };
  const clearMeasure = (): void => {
    measure.clear();
    fillMeasure();
  };
  byId("measure").addEventListener("click", () => setMeasuring(!isMeasuring));
  byId("measure-clear").addEventListener("click", clearMeasure);

  const click = (x: number, y: number, isTouch = false): void => {
    const picked: Picked | null = viewer.pick(x, y, isTouch ? 14 : 6);
    hover.show(picked, x, y);
    if (picked === null) return;
    if (isMeasuring) {
      // The part is measured rather than the path over it.
      measure.add(picked.kind === "move" && picked.behind !== null ? picked.behind.point : picked.point);
      fillMeasure();
    } else if (picked.kind === "move") {
      playback.stop();
      viewer.setPlace({ move: picked.move, share: picked.share });
    }
  };
  followPointer(viewer, {
    onClick: click,
    onHover: (x, y) => hover.follow(x, y),
    onLeave: () => hover.hide(),
  });

  for (const button of document.querySelectorAll<HTMLButtonElement>("[data-view]")) {
    button.addEventListener("click", () => viewer.look(button.dataset.view as StandardView));
  }
  byId("fit").addEventListener("click", () => viewer.fit());
  const setOrthographic = (on: boolean): void => {
    viewer.setOrthographic(on);
    press(byId("projection"), on);
  };
  byId("projection").addEventListener("click", () => setOrthographic(!viewer.camera.isOrthographic));

  const setTheme = (name: ThemeName): void => {
    document.documentElement.dataset.theme = name;
    byId("theme").textContent = name === "dark" ? "Light" : "Dark";
    viewer.setTheme(name);
  };
  setTheme(viewer.theme);
  dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));
  const otherTheme = (): void => setTheme(viewer.theme === "dark" ? "light" : "dark");
  byId("theme").addEventListener("click", otherTheme);

  const help = byId<HTMLDialogElement>("help");
  byId("help-button").addEventListener("click", () => help.showModal());

  const middle = (): [number, number] => [viewer.camera.width / 2, viewer.camera.heightPx / 2];
  const turn = (event: KeyboardEvent): void => {
    const x = event.key === "ArrowLeft" ? -1 : event.key === "ArrowRight" ? 1 : 0;
    const y = event.key === "ArrowUp" ? -1 : event.key === "ArrowDown" ? 1 : 0;
    if (event.shiftKey) viewer.camera.pan(-x * 30, -y * 30);
    else viewer.camera.orbit(x * 5, -y * 5);
    viewer.viewChanged();
  };
  const zoom = (factor: number): void => {
    viewer.camera.zoom(factor);
    viewer.viewChanged();
  };
  const nextShading = (step: number): void => {
    const { shadings, shading } = viewer;
    if (shading === null) return;
    viewer.setShading(shadings[(shadings.indexOf(shading) + step + shadings.length) % shadings.length]!.id);
  };
  const toggle = (...ids: string[]): void => {
    const known = viewer.layers.filter((l) => ids.includes(l.id));
    const isShown = known.some((l) => l.isShown);
    for (const layer of known) viewer.show(layer.id, !isShown);
  };
  const passLayers = (): string[] => viewer.layers.filter((l) => /^path ([4-9]|\d\d+)$/.test(l.id)).map((l) => l.id);
  const escape = (): void => {
    overlay.focus = null;
    hover.hide();
    measure.clear();
    setMeasuring(false);
  };
  const last = (viewer.timeline?.moves ?? 1) - 1;
  const axis = (name: "x" | "y" | "z") => () => chooseAxis(viewer, viewer.section.axis === name ? null : name);
  const view = (name: StandardView) => () => viewer.look(name);
  const keys: Key[] = [
    { keys: [" "], shown: "Space", help: "run, stop", act: () => playback.toggle() },
    { keys: [",", "<"], shown: ",", help: "one move back (shift: a pass)", act: (e) => (e.shiftKey ? playback.stepPass(-1) : playback.step(-1)) },
    { keys: [".", ">"], shown: ".", help: "one move on (shift: a pass)", act: (e) => (e.shiftKey ? playback.stepPass(1) : playback.step(1)) },
    { keys: ["Home"], shown: "Home", help: "to the start", act: () => viewer.setPlace({ move: 0, share: 1 }) },
    { keys: ["End"], shown: "End", help: "to the end", act: () => viewer.setPlace({ move: last, share: 1 }) },
    { keys: ["["], shown: "[", help: "slower", act: () => changeSpeed(playback, -1) },
    { keys: ["]"], shown: "]", help: "faster", act: () => changeSpeed(playback, 1) },
    { keys: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"], shown: "arrows", help: "turn (shift: shift the picture)", act: turn },
    { keys: ["+", "="], shown: "+", help: "nearer", act: () => zoom(1.2) },
    { keys: ["-"], shown: "\u2212", help: "farther", act: () => zoom(1 / 1.2) },
    { keys: ["1"], shown: "1", help: "view from above", act: view("top") },
    { keys: ["2"], shown: "2", help: "view from the front", act: view("front") },
    { keys: ["3"], shown: "3", help: "view from the right", act: view("right") },
    { keys: ["4"], shown: "4", help: "isometric view", act: view("iso") },
    { keys: ["5"], shown: "5", help: "view from the back", act: view("back") },
    { keys: ["6"], shown: "6", help: "view from the left", act: view("left") },
    { keys: ["f"], shown: "F", help: "fit all into the picture", act: () => viewer.fit() },
    { keys: ["o"], shown: "O", help: "orthographic, perspective", act: () => setOrthographic(!viewer.camera.isOrthographic) },
    { keys: ["s"], shown: "S", help: "next shading (shift: the one before)", act: (e) => nextShading(e.shiftKey ? -1 : 1) },
    { keys: ["a"], shown: "A", help: "passes", act: () => toggle(...passLayers()) },
    { keys: ["r"], shown: "R", help: "rapids", act: () => toggle("path 0") },
    { keys: ["l"], shown: "L", help: "links and leads", act: () => toggle("path 1", "path 2", "path 3") },
    { keys: ["n"], shown: "N", help: "starts and directions", act: () => toggle("arrows") },
    { keys: ["u"], shown: "U", help: "surface", act: () => toggle("surface") },
    { keys: ["t"], shown: "T", help: "tool", act: () => toggle("tool") },
    { keys: ["h"], shown: "H", help: "holder", act: () => toggle("holder") },
    { keys: ["k"], shown: "K", help: "stock", act: () => toggle("stock") },
    { keys: ["c"], shown: "C", help: "clamps", act: () => toggle("clamps") },
    { keys: ["b"], shown: "B", help: "region borders", act: () => toggle("borders") },
    { keys: ["x"], shown: "X", help: "section across X", act: axis("x") },
    { keys: ["y"], shown: "Y", help: "section across Y", act: axis("y") },
    { keys: ["z"], shown: "Z", help: "section across Z", act: axis("z") },
    { keys: ["\\"], shown: "\\", help: "other side of the section", act: () => viewer.setSection({ isFlipped: !viewer.section.isFlipped }) },
    { keys: ["{", "}"], shown: "{ }", help: "shift the section plane", act: (e) => shiftSection(viewer, e.key === "{" ? -1 : 1) },
    { keys: ["m"], shown: "M", help: "measure", act: () => setMeasuring(!isMeasuring) },
    { keys: ["Enter"], shown: "Enter", help: "pick the middle of the picture", act: () => click(...middle()) },
    { keys: ["v"], shown: "V", help: "panel of layers", act: () => togglePanel("left") },
    { keys: ["p"], shown: "P", help: "panel of the program", act: () => togglePanel("right") },
    { keys: ["d"], shown: "D", help: "light, dark", act: otherTheme },
    { keys: ["?"], shown: "?", help: "this help", act: () => help.showModal() },
    { keys: ["Escape"], shown: "Esc", help: "end measuring, clear marks", act: escape },
  ];
  makeHelp(keys);
  followKeys(keys);
  byId("made-by").textContent = scene.header.made_by;
  // The cross marks what Enter picks.
  canvas.addEventListener("focus", () => {
    overlay.isCrossShown = canvas.matches(":focus-visible");
    overlay.queue();
  });
  canvas.addEventListener("blur", () => {
    overlay.isCrossShown = false;
    overlay.queue();
  });

  let isFitted = false;
  const resize = (): void => {
    const stage = byId("stage");
    if (stage.clientWidth === 0 || stage.clientHeight === 0) return;
    viewer.resize(stage.clientWidth, stage.clientHeight, Math.min(devicePixelRatio, 2));
    if (!isFitted) viewer.look("iso");
    isFitted = true;
  };
  new ResizeObserver(resize).observe(byId("stage"));
  resize();
  return { viewer, measure, playback, click };
}

function shiftSection(viewer: Viewer, direction: number): void {
  const { axis, position } = viewer.section;
  if (axis === null) return;
  const [low, high] = viewer.sectionRange(axis);
  viewer.setSection({ position: Math.min(high, Math.max(low, position + (direction * (high - low)) / 50)) });
}

function showTitle(scene: Scene): void {
  const { title, outcome } = scene.header;
  document.title = `${title} \u2013 Patchmill`;
  byId("title").textContent = title;
  byId("title").title = title;
  const badge = byId("outcome");
  badge.hidden = outcome === "";
  badge.textContent = outcome;
  badge.title = outcome;
  badge.dataset.tone = /^COMPLETE$/i.test(outcome) ? "good" : /FAIL|ERROR|REFUS|GOUGE/i.test(outcome) ? "bad" : "warn";
}
