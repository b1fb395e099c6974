// Runs the program: machine time goes on by the speed times the time of the clock.
import type { Viewer } from "./viewer";

export const speeds = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

// The speed at which a program takes about a minute.
export function usualSpeed(total: number): number {
  return speeds.find((s) => total / s <= 60) ?? speeds[speeds.length - 1]!;
}

export class Playback {
  speed: number;
  isRunning = false;
  onChange = (): void => {};
  readonly #viewer: Viewer;
  #last = 0;

  constructor(viewer: Viewer) {
    this.#viewer = viewer;
    this.speed = usualSpeed(viewer.timeline?.total ?? 0);
  }

  toggle(): void {
    if (this.isRunning) this.stop();
    else this.run();
  }

  run(): void {
    const { timeline } = this.#viewer;
    if (timeline === null || this.isRunning) return;
    if (this.#viewer.time >= timeline.total) this.#viewer.setPlace({ move: 0, share: 1 });
    this.isRunning = true;
    this.#last = performance.now();
    const step = (now: number): void => {
      if (!this.isRunning) return;
      const time = this.#viewer.time + (Math.max(0, now - this.#last) / 1000) * this.speed;
      this.#last = now;
      this.#viewer.setTime(time);
      if (time >= timeline.total) this.stop();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
    this.onChange();
  }

  stop(): void {
    this.isRunning = false;
    this.onChange();
  }

  // Goes to the end of the move `count` moves from here.
  step(count: number): void {
    const { timeline, place } = this.#viewer;
    if (timeline === null) return;
    this.stop();
    // Back from within a move is its beginning.
    const here = count < 0 && place.share < 1 ? place.move : place.move + count;
    const move = count < 0 && place.share < 1 ? here + count : here;
    this.#viewer.setPlace({ move: Math.min(timeline.moves - 1, Math.max(0, move)), share: 1 });
  }

  // Goes to the start of the next pass (1) or of the one before (-1).
  stepPass(direction: 1 | -1): void {
    const { timeline, place, scene } = this.#viewer;
    const pass = scene.path?.pass;
    if (timeline === null || !pass) return;
    this.stop();
    // A pass starts at the end of the last move before it.
    const starts = (m: number): boolean => m + 1 < pass.length && pass[m + 1]! >= 0 && pass[m + 1] !== pass[m];
    for (let m = place.move + (direction > 0 || place.share === 1 ? direction : 0); m >= 0 && m < pass.length; m += direction) {
      if (!starts(m)) continue;
      this.#viewer.setPlace({ move: m, share: 1 });
      return;
    }
    this.#viewer.setPlace({ move: direction > 0 ? timeline.moves - 1 : 0, share: 1 });
  }
}
