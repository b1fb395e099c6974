// The controls of the run: slider, buttons, speed, clock, and what the tool does now.
import { byId, make, option } from "./page_elements";
import { mm, pickedMove } from "./picked";
import { type Playback, speeds } from "./playback";
import type { Point3 } from "./scene";
import type { Viewer } from "./viewer";

// Seconds as h:mm:ss, or m:ss.s in short programs.
export function clockText(seconds: number, total: number): string {
  if (total < 600) {
    const tenths = Math.round(seconds * 10);
    return `${Math.floor(tenths / 600)}:${((tenths % 600) / 10).toFixed(1).padStart(4, "0")}`;
  }
  const whole = Math.round(seconds);
  const two = (v: number): string => String(v).padStart(2, "0");
  const minutes = Math.floor(whole / 60);
  return total < 3600 ? `${minutes}:${two(whole % 60)}` : `${Math.floor(minutes / 60)}:${two(minutes % 60)}:${two(whole % 60)}`;
}

export function changeSpeed(playback: Playback, steps: number): void {
  const at = speeds.indexOf(playback.speed) + steps;
  playback.speed = speeds[Math.min(speeds.length - 1, Math.max(0, at))]!;
  playback.onChange();
}

export function makePlayer(viewer: Viewer, playback: Playback): void {
  const { timeline } = viewer;
  const player = byId("player");
  if (timeline === null) {
    player.hidden = true;
    return;
  }
  const slider = byId<HTMLInputElement>("time");
  const play = byId("play");
  const speed = byId<HTMLSelectElement>("speed");
  const clock = byId("clock");
  const readout = byId("readout");
  slider.max = String(timeline.total);
  for (const s of speeds) speed.append(option(String(s), `\u00d7${s}`));
  clock.title = timeline.isKnown ? viewer.scene.header.time_basis : "The scene has no times: lengths stand for them.";
  slider.title = `Machine time, ${clock.title}`;
  slider.addEventListener("input", () => viewer.setTime(Number(slider.value)));
  play.addEventListener("click", () => playback.toggle());
  byId("to-start").addEventListener("click", () => viewer.setPlace({ move: 0, share: 1 }));
  byId("to-end").addEventListener("click", () => viewer.setPlace({ move: timeline.moves - 1, share: 1 }));
  byId("step-back").addEventListener("click", () => playback.step(-1));
  byId("step-forward").addEventListener("click", () => playback.step(1));
  speed.addEventListener("change", () => {
    playback.speed = Number(speed.value);
  });
  playback.onChange = () => {
    speed.value = String(playback.speed);
    play.setAttribute("aria-label", playback.isRunning ? "Stop" : "Run");
    byId("play-shape").setAttribute("d", playback.isRunning ? "M4 3h2.5v10H4zM9.5 3H12v10H9.5z" : "M4 2.5 13 8l-9 5.5z");
  };
  const item = (name: string, value: string): HTMLElement => {
    const span = make("span", "", `${name} `);
    span.append(make("b", "", value));
    return span;
  };
  let isQueued = false;
  const fill = (): void => {
    isQueued = false;
    const { time, tip, place, scene } = viewer;
    slider.value = String(time);
    const text = clockText(time, timeline.total);
    slider.setAttribute("aria-valuetext", `${text} of ${clockText(timeline.total, timeline.total)}`);
    clock.textContent = `${text} / ${clockText(timeline.total, timeline.total)}`;
    const now = pickedMove(scene, { ...place, point: tip as Point3 }, viewer.program);
    const items = [item("X", mm(tip[0]!)), item("Y", mm(tip[1]!)), item("Z", mm(tip[2]!))];
    items.push(item("Move", now.pass === null ? now.moveKind : `${now.moveKind}, ${now.pass}`));
    if (now.feed !== null && now.feed > 0) items.push(item("Feed", `${Math.round(now.feed)} mm/min`));
    if (now.line > 0) items.push(item("Line", String(now.line)));
    if (now.text !== "") items.push(item("Block", now.text));
    readout.replaceChildren(...items);
  };
  viewer.on("time", () => {
    if (isQueued) return;
    isQueued = true;
    requestAnimationFrame(fill);
  });
  playback.onChange();
  fill();
}
