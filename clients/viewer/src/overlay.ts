// What is drawn over the picture in pixels: scale bar, axes, ends of the program, measured line, place of a finding.
import type { Measure } from "./measure";
import { roundUp } from "./shading";
import type { Viewer } from "./viewer";

const space = "http://www.w3.org/2000/svg";

function shape(tag: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const element = document.createElementNS(space, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  if (text !== "") element.textContent = text;
  return element;
}

const px = (v: number): string => v.toFixed(1);

export class Overlay {
  readonly #viewer: Viewer;
  readonly #svg: SVGSVGElement;
  readonly #measure: Measure;
  focus: { point: number[]; text: string } | null = null; // a place that a finding names
  isCrossShown = false;
  hint = ""; // what to do next
  #isQueued = false;

  constructor(viewer: Viewer, svg: SVGSVGElement, measure: Measure) {
    this.#viewer = viewer;
    this.#svg = svg;
    this.#measure = measure;
    viewer.on("view", () => this.queue());
    viewer.on("theme", () => this.queue());
    viewer.on("layers", () => this.queue());
  }

  queue(): void {
    if (this.#isQueued) return;
    this.#isQueued = true;
    requestAnimationFrame(() => {
      this.#isQueued = false;
      this.draw();
    });
  }

  draw(): void {
    const shapes: SVGElement[] = [...this.#axes(), ...this.#scaleBar(), ...this.#ends(), ...this.#measured()];
    const { camera } = this.#viewer;
    if (this.focus !== null) {
      const { x, y } = camera.project(this.focus.point);
      shapes.push(
        shape("circle", { cx: px(x), cy: px(y), r: 9, class: "mark" }),
        shape("path", { d: `M${px(x - 15)} ${px(y)}h8m14 0h8M${px(x)} ${px(y - 15)}v8m0 14v8`, class: "mark" }),
        this.#label(x, y - 18, this.focus.text),
      );
    }
    if (this.hint !== "") shapes.push(this.#label(camera.width / 2, 24, this.hint));
    if (this.isCrossShown) {
      const [x, y] = [camera.width / 2, camera.heightPx / 2];
      shapes.push(shape("path", { d: `M${px(x - 9)} ${px(y)}h6m6 0h6M${px(x)} ${px(y - 9)}v6m0 6v6`, class: "thin" }));
    }
    this.#svg.replaceChildren(...shapes);
  }

  // A text centred at a pixel, kept inside the picture.
  #label(x: number, y: number, text: string): SVGElement {
    const half = text.length * 3.5 + 6;
    const { width, heightPx } = this.#viewer.camera;
    const inside = (v: number, low: number, high: number): number => Math.max(low, Math.min(Math.max(low, high), v));
    return shape("text", { x: px(inside(x, half, width - half)), y: px(inside(y, 14, heightPx - 6)), "text-anchor": "middle" }, text);
  }

  #axes(): SVGElement[] {
    const { camera } = this.#viewer;
    camera.update();
    const [x, y] = [48, camera.heightPx - 48];
    const axes = ["x", "y", "z"] as const;
    return axes
      .map((axis) => ({ axis, dx: camera.right[axis] * 26, dy: -camera.up[axis] * 26, depth: camera.back[axis] }))
      .sort((a, b) => a.depth - b.depth)
      .flatMap(({ axis, dx, dy }) => {
        const isEdgeOn = Math.hypot(dx, dy) < 3; // it points at the eye
        if (isEdgeOn) return [shape("circle", { cx: x, cy: y, r: 3, class: `axis ${axis}` })];
        const size = Math.hypot(dx, dy);
        return [
          shape("path", { d: `M${x} ${y}l${px(dx)} ${px(dy)}`, class: `axis ${axis}` }),
          shape("text", { x: px(x + dx + (dx / size) * 8), y: px(y + dy + (dy / size) * 8 + 4), "text-anchor": "middle", class: axis }, axis.toUpperCase()),
        ];
      });
  }

  // The longest of 1, 2, 5, 10, ... mm that is at most 130 px long.
  #scaleBar(): SVGElement[] {
    const { camera } = this.#viewer;
    const pixel = camera.height / camera.heightPx;
    let length = roundUp(130 * pixel);
    while (length > 130 * pixel) length = roundUp(length / 2.6);
    const size = length / pixel;
    const [right, y] = [camera.width - 16, camera.heightPx - 20];
    const thinned = this.#viewer.drawnPasses.map(({ name, step }, i) =>
      shape("text", { x: right, y: y - 28 - 16 * i, "text-anchor": "end" }, `drawn: every ${step}${step % 10 === 2 ? "nd" : "th"} ${name}`),
    );
    const note = camera.isOrthographic ? "" : " at the centre";
    return [
      ...thinned,
      shape("path", { d: `M${px(right - size)} ${y - 5}v5h${px(size)}v-5`, class: "thin" }),
      shape("text", { x: right, y: y - 9, "text-anchor": "end" }, `${Number(length.toPrecision(6))} mm${note}`),
    ];
  }

  #ends(): SVGElement[] {
    const { scene, camera } = this.#viewer;
    const tip = scene.path?.tip;
    if (tip === undefined || !this.#viewer.isShown("arrows")) return [];
    const ends = [
      { name: "start", at: 0 },
      { name: "end", at: tip.length - 3 },
    ];
    const places = ends.map(({ name, at }) => ({ name, ...camera.project(tip.subarray(at, at + 3)) })).filter((p) => p.depth > 0);
    const [a, b] = places;
    if (a !== undefined && b !== undefined && Math.hypot(a.x - b.x, a.y - b.y) < 24) {
      places.splice(0, 2, { ...a, name: "start, end" });
    }
    return places.flatMap(({ name, x, y }) => [
      shape("circle", { cx: px(x), cy: px(y), r: 4, class: "markfill" }),
      this.#label(x, y - 9, name),
    ]);
  }

  #measured(): SVGElement[] {
    const { camera } = this.#viewer;
    const points = this.#measure.points.map((p) => camera.project(p));
    const shapes = points.map(({ x, y }) => shape("circle", { cx: px(x), cy: px(y), r: 4, class: "markfill" }));
    const [a, b] = points;
    if (a !== undefined && b !== undefined) {
      shapes.unshift(shape("path", { d: `M${px(a.x)} ${px(a.y)}L${px(b.x)} ${px(b.y)}`, class: "mark" }));
      shapes.push(this.#label((a.x + b.x) / 2, (a.y + b.y) / 2 - 8, this.#measure.label));
    }
    return shapes;
  }
}
