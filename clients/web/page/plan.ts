// Draws an outline over the part as seen from above: points are set, dragged and taken back. What it gives is
// text for a setting, in the coordinates of the program.
import { byId } from "../../viewer/src/page_elements";
import { fixed } from "./text";

export type Point2 = [x: number, y: number];

// The part from above.
export interface PlanPart {
  min: readonly number[]; // of its box, mm, program frame
  max: readonly number[];
  position: Float32Array; // of its triangles; empty until they are known
  index: Uint32Array;
  others: Point2[][]; // outlines that are drawn beside: stock, clamps
}

export interface Drawn {
  points: string; // "X,Y X,Y X,Y"
  top: string; // Z of the highest point of the part
}

export interface RingRequest {
  title: string;
  setting: string;
  ring: Point2[]; // to go on with
}

export type DrawRing = ((request: RingRequest) => Promise<Drawn | null>) & { part: () => PlanPart | null };

const text = (v: number): string => String(Number(fixed(v, 3)));
export const ringText = (ring: readonly Point2[]): string => ring.map(([x, y]) => `${text(x)},${text(y)}`).join(" ");

// A rectangle around the part.
export function around({ min, max }: Pick<PlanPart, "min" | "max">, margin: number): Point2[] {
  const [x0, y0, x1, y1] = [min[0]! - margin, min[1]! - margin, max[0]! + margin, max[1]! + margin];
  return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
}

// Where a new point comes in: into the side that it is nearest to, if that is within `reach`; else at the
// end.
export function placeOfPoint(ring: readonly Point2[], [x, y]: Point2, reach: number): number {
  if (ring.length < 3) return ring.length;
  let [best, at] = [reach, ring.length];
  ring.forEach(([ax, ay], i) => {
    const [bx, by] = ring[(i + 1) % ring.length]!;
    const [ux, uy] = [bx - ax, by - ay];
    const share = Math.min(1, Math.max(0, ((x - ax) * ux + (y - ay) * uy) / (ux * ux + uy * uy || 1)));
    const distance = Math.hypot(x - ax - share * ux, y - ay - share * uy);
    if (distance < best) [best, at] = [distance, i + 1];
  });
  return at;
}

const svgNamespace = "http://www.w3.org/2000/svg";
const steps = [0.1, 1, 5, 10]; // mm

export class PlanEditor {
  readonly #dialog = byId<HTMLDialogElement>("plan");
  readonly #canvas = byId<HTMLCanvasElement>("plan-part");
  readonly #svg = document.querySelector<SVGSVGElement>("#plan-ring")!;
  readonly #step = byId<HTMLSelectElement>("plan-step");
  #part: PlanPart | null = null;
  #ring: Point2[] = [];
  #center: Point2 = [0, 0];
  #scale = 1; // px per mm
  #done: (drawn: Drawn | null) => void = () => {};
  #dragged = -1;

  constructor() {
    byId("plan-use").addEventListener("click", () => this.#end(true));
    byId("plan-cancel").addEventListener("click", () => this.#end(false));
    this.#dialog.addEventListener("cancel", () => this.#end(false));
    byId("plan-back").addEventListener("click", () => this.#change(this.#ring.slice(0, -1)));
    byId("plan-clear").addEventListener("click", () => this.#change([]));
    byId("plan-add").addEventListener("click", () => this.#addInTheMiddle());
    byId("plan-around").addEventListener("click", () => this.#takeBox());
    byId("plan-in").addEventListener("click", () => this.#zoom(1.3));
    byId("plan-out").addEventListener("click", () => this.#zoom(1 / 1.3));
    this.#svg.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    this.#svg.addEventListener("pointerdown", (event) => this.#down(event));
    this.#svg.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel"]) this.#svg.addEventListener(end, () => (this.#dragged = -1));
    new ResizeObserver(() => this.#draw()).observe(this.#canvas.parentElement!);
  }

  get part(): PlanPart | null {
    return this.#part;
  }

  setPart(part: PlanPart | null): void {
    this.#part = part;
    if (this.#dialog.open) this.#draw();
  }

  // Resolves to null if nothing was drawn.
  draw({ title, ring }: RingRequest): Promise<Drawn | null> {
    this.#end(false);
    byId("plan-title").textContent = title;
    const { min, max } = this.#part ?? { min: [0, 0, 0], max: [100, 100, 0] };
    this.#ring = ring.map(([x, y]) => [x, y]);
    this.#center = [(min[0]! + max[0]!) / 2, (min[1]! + max[1]!) / 2];
    const size = Math.max(max[0]! - min[0]!, max[1]! - min[1]!, 1e-3);
    this.#step.value = String(size < 20 ? steps[0] : size < 500 ? steps[1] : steps[2]);
    byId("plan-around").toggleAttribute("disabled", this.#part === null);
    this.#dialog.showModal();
    const { clientWidth: width, clientHeight: height } = this.#canvas.parentElement!;
    const corners = [...this.#ring, [min[0]!, min[1]!], [max[0]!, max[1]!]] as Point2[];
    const halfX = Math.max(...corners.map(([x]) => Math.abs(x - this.#center[0]))) || 1;
    const halfY = Math.max(...corners.map(([, y]) => Math.abs(y - this.#center[1]))) || 1;
    this.#scale = Math.min(width / (2.9 * halfX), height / (2.9 * halfY));
    this.#draw();
    return new Promise((resolve) => (this.#done = resolve));
  }

  #end(isUsed: boolean): void {
    const { points, top } = { points: ringText(this.#ring), top: text(this.#part?.max[2] ?? 0) };
    if (this.#dialog.open) this.#dialog.close();
    const done = this.#done;
    this.#done = () => {};
    done(isUsed && this.#ring.length >= 3 ? { points, top } : null);
  }

  #change(ring: Point2[]): void {
    this.#ring = ring;
    this.#drawRing();
  }

  #snap([x, y]: Point2): Point2 {
    const step = Number(this.#step.value);
    return [Math.round(x / step) * step, Math.round(y / step) * step];
  }

  #takeBox(): void {
    const margin = Number(byId<HTMLInputElement>("plan-margin").value.replace(",", "."));
    if (this.#part === null || !Number.isFinite(margin)) return;
    this.#change(around(this.#part, margin));
  }

  // For the keyboard: a point between the last and the first, or in the middle of the part.
  #addInTheMiddle(): void {
    const [a, b] = [this.#ring.at(-1), this.#ring[0]];
    const point: Point2 = a === undefined || b === undefined ? this.#center : [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    this.#change([...this.#ring, this.#snap(point)]);
    this.#svg.querySelector<SVGElement>("circle:last-of-type")?.focus();
  }

  #zoom(factor: number): void {
    this.#scale *= factor;
    this.#draw();
  }

  #wheel(event: WheelEvent): void {
    event.preventDefault();
    const before = this.#pointOf(event);
    this.#scale *= Math.exp(-event.deltaY / 500);
    const after = this.#pointOf(event);
    this.#center = [this.#center[0] + before[0] - after[0], this.#center[1] + before[1] - after[1]];
    this.#draw();
  }

  #pixel([x, y]: Point2): Point2 {
    const { clientWidth: width, clientHeight: height } = this.#canvas.parentElement!;
    return [width / 2 + (x - this.#center[0]) * this.#scale, height / 2 - (y - this.#center[1]) * this.#scale];
  }

  #pointOf(event: MouseEvent): Point2 {
    const box = this.#svg.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
    return [this.#center[0] + x / this.#scale, this.#center[1] - y / this.#scale];
  }

  #down(event: PointerEvent): void {
    if (event.button !== 0) return;
    event.preventDefault();
    const taken = (event.target as Element).getAttribute("data-point");
    if (taken === null) {
      const point = this.#snap(this.#pointOf(event));
      const place = placeOfPoint(this.#ring, point, 9 / this.#scale);
      this.#change(this.#ring.toSpliced(place, 0, point));
      this.#dragged = place;
    } else this.#dragged = Number(taken);
    this.#svg.setPointerCapture(event.pointerId);
    this.#svg.querySelectorAll<SVGElement>("circle")[this.#dragged]?.focus({ preventScroll: true });
  }

  #move(event: PointerEvent): void {
    const [x, y] = this.#snap(this.#pointOf(event));
    byId("plan-at").textContent = `X ${text(x)}, Y ${text(y)}`;
    if (this.#dragged < 0) return;
    this.#ring[this.#dragged] = [x, y];
    this.#drawRing();
  }

  #key(event: KeyboardEvent, k: number): void {
    const step = Number(this.#step.value) * (event.shiftKey ? 10 : 1);
    const ways: Record<string, Point2> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
    const way = ways[event.key];
    if (way === undefined && event.key !== "Delete" && event.key !== "Backspace") return;
    event.preventDefault();
    if (way === undefined) this.#change(this.#ring.toSpliced(k, 1));
    else {
      const [x, y] = this.#ring[k]!;
      this.#change(this.#ring.with(k, [x + way[0], y + way[1]]));
      byId("plan-at").textContent = `X ${text(x + way[0])}, Y ${text(y + way[1])}`;
    }
    this.#svg.querySelectorAll<SVGElement>("circle")[Math.min(k, this.#ring.length - 1)]?.focus();
  }

  #draw(): void {
    if (!this.#dialog.open) return;
    this.#drawPart();
    this.#drawRing();
  }

  #drawPart(): void {
    const { clientWidth: width, clientHeight: height } = this.#canvas.parentElement!;
    const ratio = Math.min(devicePixelRatio, 2);
    [this.#canvas.width, this.#canvas.height] = [width * ratio, height * ratio];
    const context = this.#canvas.getContext("2d");
    if (context === null || this.#part === null) return;
    context.scale(ratio, ratio);
    const { min, max, position, index, others } = this.#part;
    const style = getComputedStyle(document.documentElement);
    const color = (name: string): string => style.getPropertyValue(name);
    const trace = (ring: readonly Point2[]): void => {
      ring.forEach((p, i) => (i === 0 ? context.moveTo(...this.#pixel(p)) : context.lineTo(...this.#pixel(p))));
      context.closePath();
    };
    context.beginPath();
    const at = (corner: number): Point2 => [position[3 * corner]!, position[3 * corner + 1]!];
    for (let t = 0; t + 2 < index.length; t += 3) {
      const [a, b, c] = [at(index[t]!), at(index[t + 1]!), at(index[t + 2]!)];
      // All run the same way round, so that those above each other do not cancel out.
      const isLeft = (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]);
      trace(isLeft ? [a, b, c] : [a, c, b]);
    }
    context.fillStyle = color("--line");
    context.fill();
    context.strokeStyle = color("--soft");
    context.setLineDash([4, 4]);
    context.beginPath();
    trace(around({ min, max }, 0));
    for (const ring of others) trace(ring);
    context.stroke();
    // The program zero.
    const [x, y] = this.#pixel([0, 0]);
    context.setLineDash([]);
    context.beginPath();
    context.moveTo(x - 8, y);
    context.lineTo(x + 8, y);
    context.moveTo(x, y - 8);
    context.lineTo(x, y + 8);
    context.stroke();
  }

  #drawRing(): void {
    const make = (tag: string, attributes: Record<string, string | number>): SVGElement => {
      const element = document.createElementNS(svgNamespace, tag);
      for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
      return element;
    };
    const pixels = this.#ring.map((p) => this.#pixel(p));
    const outline = make(this.#ring.length < 3 ? "polyline" : "polygon", { points: pixels.map((p) => p.join(",")).join(" ") });
    const points = pixels.map(([x, y], k) => {
      const [px, py] = this.#ring[k]!;
      const label = `point ${k + 1} at ${text(px)}, ${text(py)}`;
      const circle = make("circle", { cx: x, cy: y, tabindex: 0, role: "button", "aria-label": label, "data-point": k });
      circle.addEventListener("keydown", (event) => this.#key(event, k));
      return circle;
    });
    const focused = [...this.#svg.querySelectorAll("circle")].indexOf(document.activeElement as unknown as SVGCircleElement);
    this.#svg.replaceChildren(outline, ...points);
    if (focused >= 0) points[Math.min(focused, points.length - 1)]?.focus({ preventScroll: true });
    const isEnough = this.#ring.length >= 3;
    byId<HTMLButtonElement>("plan-use").disabled = !isEnough;
    byId<HTMLButtonElement>("plan-back").disabled = byId<HTMLButtonElement>("plan-clear").disabled = this.#ring.length === 0;
    const count = `${this.#ring.length} point${this.#ring.length === 1 ? "" : "s"}`;
    byId("plan-hint").textContent = isEnough ? `${count}. Drag points, click a side to add one to it.` : `${count}. Click to add points; an outline has at least 3.`;
  }
}
