// Shows what lies under the pointer.
import { byId, make } from "./page_elements";
import { type Picked, rowsOf } from "./picked";
import type { Viewer } from "./viewer";

export class Hover {
  readonly #viewer: Viewer;
  readonly #box = byId("hover");
  #next: { x: number; y: number } | null = null;

  constructor(viewer: Viewer) {
    this.#viewer = viewer;
  }

  // At most one search for each frame.
  follow(x: number, y: number): void {
    const isQueued = this.#next !== null;
    this.#next = { x, y };
    if (isQueued) return;
    requestAnimationFrame(() => {
      const at = this.#next;
      this.#next = null;
      if (at !== null) this.show(this.#viewer.pick(at.x, at.y), at.x, at.y);
    });
  }

  show(picked: Picked | null, x: number, y: number): void {
    this.#box.hidden = picked === null;
    if (picked === null) return;
    this.#box.replaceChildren(...rowsOf(picked).flatMap(([name, value]) => [make("b", "", name), make("span", "", value)]));
    const { width, heightPx } = this.#viewer.camera;
    const { offsetWidth, offsetHeight } = this.#box;
    const left = x + 16 + offsetWidth > width ? x - 16 - offsetWidth : x + 16;
    const top = y + 16 + offsetHeight > heightPx ? y - 16 - offsetHeight : y + 16;
    this.#box.style.left = `${Math.max(4, Math.min(width - offsetWidth - 4, left))}px`;
    this.#box.style.top = `${Math.max(4, Math.min(heightPx - offsetHeight - 4, top))}px`;
  }

  hide(): void {
    this.#next = null;
    this.#box.hidden = true;
  }
}
