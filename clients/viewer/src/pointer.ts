// Mouse, pen and fingers on the canvas: turn, shift, zoom, pick.
import type { Viewer } from "./viewer";

export interface PointerEvents {
  onClick: (x: number, y: number, isTouch: boolean) => void;
  onHover: (x: number, y: number) => void;
  onLeave: () => void; // the pointer left, or it began to drag
}

const clickSlop = 5; // px that a click may move

export function followPointer(viewer: Viewer, events: PointerEvents): void {
  const { canvas, camera } = viewer;
  const held = new Map<number, { x: number; y: number }>();
  let pressed: { x: number; y: number } | null = null; // null: it is a drag
  const placeOf = (event: PointerEvent | WheelEvent): { x: number; y: number } => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, placeOf(event));
    pressed = held.size === 1 ? placeOf(event) : null;
  });

  canvas.addEventListener("pointermove", (event) => {
    const to = placeOf(event);
    const from = held.get(event.pointerId);
    if (from === undefined) {
      if (event.pointerType !== "touch") events.onHover(to.x, to.y);
      return;
    }
    if (pressed !== null && Math.hypot(to.x - pressed.x, to.y - pressed.y) <= clickSlop) return;
    if (pressed !== null) events.onLeave();
    pressed = null;
    canvas.classList.add("turning");
    if (held.size === 1) {
      const shifts = event.pointerType === "mouse" && (event.shiftKey || event.ctrlKey || (event.buttons & 6) !== 0);
      if (shifts) camera.pan(to.x - from.x, to.y - from.y);
      else camera.orbit(-(to.x - from.x) * 0.4, (to.y - from.y) * 0.4);
    } else {
      // Two fingers: their middle shifts the picture, their distance zooms it.
      const other = [...held].find(([id]) => id !== event.pointerId)![1];
      const before = Math.hypot(from.x - other.x, from.y - other.y);
      const after = Math.hypot(to.x - other.x, to.y - other.y);
      camera.pan((to.x - from.x) / 2, (to.y - from.y) / 2);
      if (before > 0 && after > 0) camera.zoom(after / before, (to.x + other.x) / 2, (to.y + other.y) / 2);
    }
    held.set(event.pointerId, to);
    viewer.viewChanged();
  });

  const release = (event: PointerEvent): void => {
    held.delete(event.pointerId);
    if (held.size === 0) canvas.classList.remove("turning");
    if (event.type === "pointerup" && pressed !== null && event.button === 0) {
      events.onClick(pressed.x, pressed.y, event.pointerType === "touch");
    }
    pressed = null;
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", (event) => {
    if (event.pointerType !== "touch") events.onLeave();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const { x, y } = placeOf(event);
      const notches = Math.max(-3, Math.min(3, event.deltaY / (event.deltaMode === 1 ? 3 : 100)));
      camera.zoom(1.18 ** -notches, x, y);
      viewer.viewChanged();
    },
    { passive: false },
  );
}
