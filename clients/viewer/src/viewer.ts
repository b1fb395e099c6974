// The viewer: draws a scene on a canvas, runs the tool along it and tells what lies under a pixel. It knows no page.
import { BufferAttribute, BufferGeometry, Group, LineSegments, Scene as Scene3, Vector3, WebGLRenderer } from "three";
import { Camera, type StandardView } from "./camera";
import { contactVertices } from "./contact";
import { MeshPicker } from "./mesh_pick";
import { MeshView } from "./mesh_view";
import { PathDrawing } from "./path_drawing";
import { currentSpan, leastRanks, passSpacing } from "./density";
import { makePathVertices, maxClasses, PathClass } from "./path_vertices";
import { passName, type Picked, pickedMove, pickedSurface } from "./picked";
import type { ProgramText } from "./program_text";
import type { Point3, Scene } from "./scene";
import { type Axis, isKept, SectionFrame, type SectionPlane, setPlane } from "./section_plane";
import { type Shading, type ShadingId, shadingsOf } from "./shading";
import { lineMaterial, makePrism } from "./solid";
import { classColor, pathClassNames, themes, type ThemeName } from "./themes";
import { type Place, Timeline } from "./timeline";
import { ToolView } from "./tool_view";
import { makeUniforms, plainColor } from "./uniforms";

export type PathPart = "whole" | "done" | "coming";

export interface Layer {
  id: string;
  name: string;
  color: string | null;
  isShown: boolean;
}

export type ViewerEvent = "time" | "view" | "shading" | "layers" | "section" | "theme";

export class Viewer {
  readonly scene: Scene;
  readonly canvas: HTMLCanvasElement;
  readonly camera = new Camera();
  readonly timeline: Timeline | null;
  readonly program: ProgramText | null;
  readonly shadings: Shading[];
  readonly section: SectionPlane = { axis: null, position: 0, isFlipped: false, cutsPath: true };
  readonly min: Point3;
  readonly max: Point3;
  shading: Shading | null = null;
  place: Place = { move: 0, share: 1 };
  theme: ThemeName = "light";
  pathPart: PathPart = "whole";

  readonly #renderer: WebGLRenderer;
  readonly #three = new Scene3();
  readonly #shared = makeUniforms();
  readonly #meshView: MeshView | null = null;
  readonly #atTip: PathDrawing | null = null;
  #atContact: PathDrawing | null = null; // made when it is wanted first
  #drawing: PathDrawing | null = null; // the one that is shown
  readonly #tool: ToolView | null = null;
  readonly #stock: Group | null = null;
  readonly #clamps = new Group();
  readonly #borders: LineSegments | null = null;
  readonly #frame: SectionFrame;
  readonly #layers: Layer[] = [];
  readonly #listeners = new Map<ViewerEvent, (() => void)[]>();
  #meshPicker: MeshPicker | null = null;
  #isQueued = false;
  #lastMove = -1e9; // when the camera moved last, ms
  #lastFrame = -1e9;
  #coarse = 1.5; // px: how far thinned paths may be off while the camera moves
  #restTimer = 0;
  #tip = [0, 0, 0];
  #colors: { color: string; isShown: boolean }[] = [];
  #drawnLeast = ""; // the ranks that the colours of the path were last set for
  #spacing: Float64Array = new Float64Array(maxClasses).fill(Infinity);
  isEveryPassDrawn = false;
  frames = 0;

  constructor(canvas: HTMLCanvasElement, scene: Scene, theme: ThemeName) {
    this.scene = scene;
    this.canvas = canvas;
    const { header, mesh, path } = scene;
    this.#renderer = makeRenderer(canvas);
    this.shadings = shadingsOf(scene);
    this.program = scene.program;
    this.timeline = path === null ? null : new Timeline(path);
    [this.min, this.max] = boundsOf(scene);
    const size = new Vector3(...this.max).distanceTo(new Vector3(...this.min));

    if (mesh !== null) {
      this.#meshView = new MeshView(mesh, this.#shared);
      this.#three.add(this.#meshView.object);
      this.#layers.push({ id: "surface", name: "Surface", color: null, isShown: true });
    }
    if (path !== null) {
      const boxSize = this.#partSize;
      const vertices = makePathVertices(this.timeline!, Math.max(header.tolerance / 2, boxSize / 20000));
      this.#atTip = new PathDrawing(path, vertices, boxSize, 2 * header.tolerance, this.#shared);
      this.#drawing = this.#atTip;
      this.#spacing = passSpacing(vertices, mesh);
      this.#tool = new ToolView(header.tool, this.#shared);
      this.#three.add(this.#atTip.object, this.#tool.object);
      const used = new Uint8Array(maxClasses);
      for (let v = 1; v < vertices.class.length; v++) used[vertices.class[v]!] = 1;
      for (let c = maxClasses - 1; c >= 0; c--) {
        if (used[c] === 0) continue;
        const pass = header.passes[c - PathClass.firstPass];
        const name = c < PathClass.firstPass ? pathClassNames[c]! : `${passName(pass ?? "other").replace(/^./, (s) => s.toUpperCase())} passes`;
        this.#layers.push({ id: `path ${c}`, name, color: "", isShown: true });
      }
      this.#layers.push({ id: "arrows", name: "Starts and directions", color: null, isShown: true });
      this.#layers.push({ id: "tool", name: "Tool", color: null, isShown: true });
      if (header.tool.holder !== null) this.#layers.push({ id: "holder", name: "Holder", color: null, isShown: true });
    }
    if (header.stock !== null) {
      const { outline, bottom, top } = header.stock;
      this.#stock = makePrism(outline, bottom, top, themes[theme].stock, 0.13, this.#shared);
      this.#three.add(this.#stock);
      this.#layers.push({ id: "stock", name: "Stock", color: null, isShown: true });
    }
    if (header.clamps.length > 0) {
      const bottom = Math.min(header.stock?.bottom ?? Infinity, header.box.min[2]);
      for (const clamp of header.clamps) {
        this.#clamps.add(makePrism(clamp.outline, Math.min(bottom, clamp.top), clamp.top, "#8d97a5", 1, this.#shared));
      }
      this.#three.add(this.#clamps);
      this.#layers.push({ id: "clamps", name: "Clamps", color: null, isShown: true });
    }
    if (scene.borderPosition !== null && header.borders.length > 0) {
      this.#borders = this.#makeBorders(scene.borderPosition, 2 * header.tolerance);
      this.#three.add(this.#borders);
      this.#layers.push({ id: "borders", name: "Region borders", color: null, isShown: true });
    }
    this.#frame = new SectionFrame(themes[theme].section, this.#shared);
    this.#three.add(this.#frame.object);
    this.camera.setScene(
      new Vector3(...this.min).add(new Vector3(...this.max)).multiplyScalar(0.5),
      size / 2 + this.#toolHeight(),
    );
    this.section.position = (header.box.min[0] + header.box.max[0]) / 2;
    if (this.shadings.length > 0) this.setShading(this.shadings[0]!.id);
    this.setTheme(theme);
    this.#placeTool();
  }

  #toolHeight(): number {
    const { tool } = this.scene.header;
    const profile = tool.holder?.profile ?? [];
    const radius = profile.reduce((a, [, r]) => Math.max(a, r), tool.shank_diameter);
    const top = tool.holder === null ? 5 * tool.shank_diameter + (tool.flute_length ?? 0) : tool.holder.stickout + profile[profile.length - 1]![0];
    return top + radius + tool.ball_diameter;
  }

  #makeBorders(points: Float32Array, lift: number): LineSegments {
    const position: number[] = [];
    const tint: number[] = [];
    for (const { color, first, count } of this.scene.header.borders) {
      const rgb = plainColor(color).multiplyScalar(0.8).toArray();
      for (let i = first; i + 1 < first + count; i++) {
        for (let k = 0; k < 6; k++) position.push(points[3 * i + k]!);
        tint.push(...rgb, ...rgb);
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(position), 3));
    geometry.setAttribute("tint", new BufferAttribute(new Float32Array(tint), 3));
    const lines = new LineSegments(geometry, lineMaterial({ color: null, bias: 2, lift, isCut: true }, this.#shared));
    lines.frustumCulled = false;
    lines.renderOrder = 1;
    return lines;
  }

  on(event: ViewerEvent, listener: () => void): void {
    this.#listeners.set(event, [...(this.#listeners.get(event) ?? []), listener]);
  }

  #tell(event: ViewerEvent): void {
    for (const listener of this.#listeners.get(event) ?? []) listener();
  }

  // Shading, layers, theme

  setShading(id: ShadingId): void {
    const shading = this.shadings.find((s) => s.id === id);
    if (shading === undefined) return;
    this.shading = shading;
    this.#meshView?.shade(shading);
    this.#tell("shading");
    this.invalidate();
  }

  get layers(): readonly Layer[] {
    return this.#layers;
  }

  isShown(id: string): boolean {
    return this.#layers.find((l) => l.id === id)?.isShown ?? false;
  }

  show(id: string, isShown: boolean): void {
    const layer = this.#layers.find((l) => l.id === id);
    if (layer === undefined) return;
    layer.isShown = isShown;
    this.#applyLayers();
  }

  setPathPart(part: PathPart): void {
    this.pathPart = part;
    this.#applyLayers();
  }

  get pathPoint(): "tip" | "contact" {
    return this.#drawing === this.#atTip ? "tip" : "contact";
  }

  // Draws the path at the tip of the ball or, where it cuts, at the points of contact. These are found when they are wanted
  // first; `onProgress` gets the share that is done.
  async setPathPoint(point: "tip" | "contact", onProgress: (share: number) => void = () => {}): Promise<void> {
    const { mesh, path, header } = this.scene;
    if (this.#atTip === null || path === null) return;
    if (point === "contact" && this.#atContact === null) {
      if (mesh === null) return;
      this.#meshPicker ??= new MeshPicker(mesh);
      const vertices = await contactVertices(this.#atTip.vertices, this.#meshPicker, header.tool.ball_diameter / 2, onProgress);
      this.#atContact = new PathDrawing(path, vertices, this.#partSize, 2 * header.tolerance, this.#shared);
    }
    if (this.#drawing !== null) this.#three.remove(this.#drawing.object);
    this.#drawing = point === "tip" ? this.#atTip : this.#atContact;
    if (this.#drawing !== null) this.#three.add(this.#drawing.object);
    this.#applyLayers();
  }

  get #partSize(): number {
    const { min, max } = this.scene.header.box;
    return new Vector3(...max).distanceTo(new Vector3(...min)) || 1;
  }

  // The pass that is cut now is always drawn.
  #currentPass(): [number, number] {
    return this.#drawing === null ? [1, 0] : currentSpan(this.#drawing.vertices, this.#drawing.ranks.ranks, Math.fround(this.time));
  }

  // How dense passes are drawn: the least rank of each class.
  get #leastRanks(): Uint8Array {
    if (this.isEveryPassDrawn) return new Uint8Array(maxClasses);
    return leastRanks(this.#spacing, this.camera.height / this.camera.heightPx);
  }

  setEveryPass(isDrawn: boolean): void {
    this.isEveryPassDrawn = isDrawn;
    this.#applyLayers();
  }

  // Each how many passes (or turns) of a class are drawn, for those that are shown and thinned.
  get drawnPasses(): { name: string; step: number }[] {
    const least = this.#leastRanks;
    const { counts, hasTurns } = this.#drawing?.ranks ?? { counts: new Uint32Array(maxClasses), hasTurns: false };
    return this.#layers
      .filter((l) => l.isShown && l.id.startsWith("path "))
      .map((l) => ({ layer: l, index: Number(l.id.slice(5)) }))
      .filter(({ index }) => index >= PathClass.cut && counts[index]! > 1 && least[index]! > 0)
      .map(({ layer, index }) => ({
        name: layer.name.toLowerCase().replace(/passes$/, hasTurns ? "turn" : "pass"),
        step: 2 ** least[index]!,
      }));
  }

  #isVertexShown(shown: Uint8Array, least: Uint8Array, pass: [number, number], v: number): boolean {
    const { vertices, ranks } = this.#drawing!;
    const c = vertices.class[v]!;
    const time = vertices.time[v]!;
    if (shown[c] === 0 || (ranks.ranks[v]! < least[c]! && (time < pass[0] || time > pass[1]))) return false;
    return this.pathPart === "whole" || time <= this.time === (this.pathPart === "done");
  }

  get #shownClasses(): Uint8Array {
    const shown = new Uint8Array(maxClasses);
    for (const l of this.#layers) if (l.id.startsWith("path ") && l.isShown) shown[Number(l.id.slice(5))] = 1;
    return shown;
  }

  #applyLayers(): void {
    this.#colors = Array.from({ length: maxClasses }, () => ({ color: "#000000", isShown: false }));
    for (const layer of this.#layers) {
      if (!layer.id.startsWith("path ")) continue;
      const index = Number(layer.id.slice(5));
      layer.color = classColor(index, this.scene.header.passes, this.theme);
      this.#colors[index] = { color: layer.color, isShown: layer.isShown };
    }
    if (this.#drawing !== null) {
      const { view, arrows } = this.#drawing;
      this.#drawnLeast = "";
      view.material.uniforms.shown!.value = [this.pathPart === "coming" ? 0 : 1, this.pathPart === "done" ? 0 : 1];
      view.material.uniforms.isCut!.value = this.section.cutsPath ? 1 : 0;
      view.material.uniforms.now!.value = this.time;
      arrows.object.visible = this.isShown("arrows");
      arrows.setColor(themes[this.theme].ink);
    }
    if (this.#meshView !== null) this.#meshView.object.visible = this.isShown("surface");
    if (this.#tool !== null) {
      this.#tool.cutter.visible = this.isShown("tool");
      this.#tool.holder.visible = this.isShown("holder");
    }
    if (this.#stock !== null) this.#stock.visible = this.isShown("stock");
    this.#clamps.visible = this.isShown("clamps");
    if (this.#borders !== null) this.#borders.visible = this.isShown("borders");
    this.#tell("layers");
    this.invalidate();
  }

  setTheme(name: ThemeName): void {
    this.theme = name;
    const theme = themes[name];
    this.#shared.background.value = plainColor(theme.background);
    // The renderer converts the colour to that of the screen; all others are written as they are.
    this.#renderer.setClearColor(plainColor(theme.background).convertSRGBToLinear());
    this.#frame.setColor(theme.section);
    this.#applyLayers();
    this.#tell("theme");
  }

  // Time

  setPlace(place: Place): void {
    if (this.timeline === null) return;
    this.place = place;
    this.#placeTool();
    this.#tell("time");
    this.invalidate();
  }

  setTime(time: number): void {
    if (this.timeline === null) return;
    this.setPlace(this.timeline.placeAt(Math.min(this.timeline.total, Math.max(0, time))));
  }

  get time(): number {
    return this.timeline === null ? 0 : this.timeline.timeOf(this.place);
  }

  get tip(): number[] {
    return [...this.#tip];
  }

  #placeTool(): void {
    if (this.timeline === null) return;
    this.timeline.tipAt(this.place, this.#tip);
    this.#tool?.object.position.set(this.#tip[0]!, this.#tip[1]!, this.#tip[2]!);
    if (this.#drawing !== null) this.#drawing.view.material.uniforms.now!.value = this.time;
  }

  // View

  look(view: StandardView): void {
    this.camera.look(view);
    this.fit();
  }

  fit(): void {
    this.camera.fit(this.min, this.max);
    this.viewChanged();
  }

  viewChanged(): void {
    this.#lastMove = performance.now();
    this.#tell("view");
    this.invalidate();
  }

  setOrthographic(isOrthographic: boolean): void {
    this.camera.isOrthographic = isOrthographic;
    this.viewChanged();
  }

  setSection(change: Partial<SectionPlane>): void {
    Object.assign(this.section, change);
    setPlane(this.section, this.#shared.plane.value);
    this.#frame.place(this.section, this.min, this.max);
    this.#meshView?.setCut(this.section.axis !== null);
    if (this.#drawing !== null) this.#drawing.view.material.uniforms.isCut!.value = this.section.cutsPath ? 1 : 0;
    this.#tell("section");
    this.invalidate();
  }

  sectionRange(axis: Axis): [number, number] {
    const k = axis === "x" ? 0 : axis === "y" ? 1 : 2;
    const { min, max } = this.scene.header.box;
    const margin = Math.max((max[k]! - min[k]!) * 0.02, 1e-3);
    return [min[k]! - margin, max[k]! + margin];
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.camera.width = Math.max(1, width);
    this.camera.heightPx = Math.max(1, height);
    this.#renderer.setPixelRatio(pixelRatio);
    this.#renderer.setSize(this.camera.width, this.camera.heightPx, false);
    this.viewChanged();
  }

  // Picking

  pick(x: number, y: number, pixels = 6): Picked | null {
    const ray = this.camera.rayAt(x, y);
    const plane = this.#shared.plane.value;
    const { mesh, path } = this.scene;
    let surface = null;
    if (mesh !== null && this.isShown("surface")) {
      this.#meshPicker ??= new MeshPicker(mesh);
      surface = this.#meshPicker.pick(ray, (point) => isKept(plane, point));
    }
    if (path !== null && this.#drawing !== null) {
      const shown = this.#shownClasses;
      const least = this.#leastRanks;
      const pass = this.#currentPass();
      // Along a ray of the perspective view the depth is less than the distance.
      const cos = this.camera.isOrthographic ? 1 : -this.camera.back.dot(new Vector3(...(ray.direction as Point3)));
      const pixelAt = (distance: number): number => this.camera.pixelAtDepth(distance * cos);
      const limit = surface === null ? Infinity : surface.distance + 3 * this.scene.header.tolerance + 4 * pixelAt(surface.distance);
      const hit = this.#drawing.picker.pick(
        ray,
        pixels,
        pixelAt,
        (vertex, point) =>
          this.#isVertexShown(shown, least, pass, vertex) &&
          (!this.section.cutsPath || isKept(plane, point)),
        limit,
      );
      if (hit !== null) {
        return { ...pickedMove(this.scene, hit, this.program), behind: surface === null ? null : pickedSurface(this.scene, surface) };
      }
    }
    return surface === null ? null : pickedSurface(this.scene, surface);
  }

  // Drawing

  // Draws once in the next frame.
  invalidate(): void {
    if (this.#isQueued) return;
    this.#isQueued = true;
    requestAnimationFrame((now) => {
      this.#isQueued = false;
      this.#adapt(now);
      this.render();
    });
  }

  // Keeps the picture fluent while the camera moves: slow frames make the paths coarser.
  #adapt(now: number): void {
    const elapsed = now - this.#lastFrame;
    this.#lastFrame = now;
    if (!this.isMoving || elapsed > 1000) return;
    if (elapsed > 140) this.#coarse = Math.min(6, this.#coarse * 1.3);
    else if (elapsed < 50) this.#coarse = Math.max(0.7, this.#coarse / 1.1);
  }

  get isMoving(): boolean {
    return performance.now() - this.#lastMove < 180;
  }

  render(): void {
    const { camera } = this;
    const eye = camera.update();
    this.#shared.isOrthographic.value = camera.isOrthographic ? 1 : 0;
    this.#shared.pixel.value = camera.isOrthographic ? camera.height / camera.heightPx : camera.height / camera.heightPx / camera.distance;
    const isMoving = this.isMoving;
    const least = this.#leastRanks;
    const pass = this.#currentPass();
    if (this.#drawing !== null) {
      const { view } = this.#drawing;
      if (least.join() !== this.#drawnLeast) view.setColors(this.#colors, least);
      this.#drawnLeast = least.join();
      view.material.uniforms.pass!.value = pass;
      view.choose(camera, isMoving ? this.#coarse : 0.6, least, pass);
    }
    if (this.#drawing !== null && this.isShown("arrows")) {
      const { position } = this.#drawing.vertices;
      const shown = this.#shownClasses;
      this.#drawing.arrows.place(
        camera,
        (v) =>
          this.#isVertexShown(shown, least, pass, v) &&
          isKept(this.#shared.plane.value, position.subarray(3 * v, 3 * v + 3)),
      );
    }
    this.#renderer.render(this.#three, eye);
    this.frames++;
    // The picture at rest is finer.
    if (isMoving) {
      clearTimeout(this.#restTimer);
      this.#restTimer = window.setTimeout(() => this.invalidate(), 220);
    }
  }

  get drawnSegments(): number {
    return this.#drawing?.view.drawnSegments ?? 0;
  }

  get levelSizes(): number[] {
    return this.#drawing?.view.levelSizes ?? [];
  }

  // Draws, and gives a pixel of the picture.
  readPixel(x: number, y: number): number[] {
    this.render();
    return this.waitForPixel(x, y);
  }

  // Waits until the picture of this frame is drawn, and gives a pixel of it.
  waitForPixel(x: number, y: number): number[] {
    const gl = this.#renderer.getContext();
    const out = new Uint8Array(4);
    const ratio = this.#renderer.getPixelRatio();
    gl.readPixels(Math.floor(x * ratio), Math.floor((this.camera.heightPx - 1 - y) * ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return [...out];
  }
}

// The box of all that is drawn but tool and holder.
function boundsOf(scene: Scene): [Point3, Point3] {
  const { box, stock, clamps } = scene.header;
  const min: Point3 = [...box.min];
  const max: Point3 = [...box.max];
  const grow = (x: number, y: number, z: number): void => {
    [x, y, z].forEach((v, k) => {
      if (v < min[k]!) min[k] = v;
      if (v > max[k]!) max[k] = v;
    });
  };
  for (const [x, y] of stock?.outline ?? []) for (const z of [stock!.bottom, stock!.top]) grow(x, y, z);
  for (const clamp of clamps) for (const [x, y] of clamp.outline) grow(x, y, clamp.top);
  const tip = scene.path?.tip ?? new Float32Array(0);
  for (let i = 0; i < tip.length; i += 3) {
    for (let k = 0; k < 3; k++) {
      const v = tip[i + k]!;
      if (v < min[k]!) min[k] = v;
      if (v > max[k]!) max[k] = v;
    }
  }
  return [min, max];
}

// Software renderers get no multisampling: it costs them most of their speed.
function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (probe === null) throw new Error("This browser has no WebGL 2, which the page needs to draw.");
  const info = probe.getExtension("WEBGL_debug_renderer_info");
  const name = String(info === null ? "" : probe.getParameter(info.UNMASKED_RENDERER_WEBGL));
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  const isSoftware = /swiftshader|llvmpipe|software|basic render/i.test(name);
  return new WebGLRenderer({ canvas, antialias: !isSoftware, preserveDrawingBuffer: false, powerPreference: "high-performance" });
}
