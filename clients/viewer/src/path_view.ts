// Draws the path: chunks of one polyline, each thinned to what can be seen.
import { BufferAttribute, BufferGeometry, DataTexture, GLSL3, Group, Line, NearestFilter, RawShaderMaterial, RGBAFormat, Sphere } from "three";
import { boxOfPoints } from "./box_tree";
import type { Camera } from "./camera";
import { maxClasses, type PathVertices } from "./path_vertices";
import { type Level, thin } from "./thin";
import { biasedPosition, plainColor, type SharedUniforms } from "./uniforms";

const chunkSize = 4096; // vertices at most
const shortChunk = 128; // a chunk with more vertices ends where a pass ends
const levelCount = 9;

// The class of a segment is that of its end: the last vertex gives the flat value.
const vertexShader = `
precision highp float;
precision highp int;
${biasedPosition}
in vec3 position;
in vec2 look; // class and rank
in float time;
out vec3 vPoint;
out float vTime;
flat out ivec2 vLook;
uniform float lift;
void main() {
  vPoint = position;
  vTime = time;
  vLook = ivec2(look + 0.5);
  gl_Position = biasedPosition(position, 3.0, lift);
}`;

const fragmentShader = `
precision highp float;
precision highp int;
uniform vec4 plane;
uniform float isCut; // 1: the section plane cuts the path too
uniform float now;
uniform vec2 shown; // of the path before and after now
uniform vec2 pass; // times between which the pass runs that is cut now
uniform vec3 background;
uniform sampler2D palette;
in vec3 vPoint;
in float vTime;
flat in ivec2 vLook;
out vec4 color;
void main() {
  if (isCut > 0.5 && dot(plane.xyz, vPoint) + plane.w < 0.0) discard;
  vec4 c = texelFetch(palette, ivec2(vLook.x, 0), 0);
  bool isDone = vTime <= now;
  int least = int(c.a * 255.0 + 0.5) - 1; // of the ranks that are drawn; -1: none
  if (least < 0 || (isDone ? shown.x : shown.y) < 0.5) discard;
  if (vLook.y < least && (vTime < pass.x || vTime > pass.y)) discard;
  color = vec4(isDone ? c.rgb : mix(c.rgb, background, 0.62), 1.0);
}`;

// The first vertices of chunks, and the last vertex of the path. The last vertex of a chunk is the first one of the next.
export function chunkStarts(ranks: Uint8Array): Uint32Array {
  const starts = [0];
  let first = 0;
  for (let v = 1; v + 1 < ranks.length; v++) {
    if (v - first < chunkSize && (v - first < shortChunk || ranks[v + 1] === ranks[v])) continue;
    starts.push(v);
    first = v;
  }
  return Uint32Array.from([...starts, Math.max(0, ranks.length - 1)]);
}

interface DrawnLevel {
  tolerance: number;
  line: Line<BufferGeometry, RawShaderMaterial[]>;
  start: Uint32Array; // of each chunk, in the kept vertices; one more at the end
}

export class PathView {
  readonly object = new Group();
  readonly material: RawShaderMaterial;
  readonly #levels: DrawnLevel[] = [];
  readonly #boxes: Float32Array; // of each chunk
  readonly #chunks: number;
  readonly #starts: Uint32Array; // of chunks, in the vertices; one more at the end
  readonly #rank: Uint8Array; // the greatest one of each chunk
  readonly #classes: number[][] = []; // of each chunk
  readonly #time: Float32Array;
  readonly #palette = new Uint8Array(4 * maxClasses);
  readonly #paletteTexture: DataTexture;
  drawnSegments = 0;

  // `size` (mm) is that of the scene, `lift` (mm) how far the triangles of the surface may lie above it.
  constructor(vertices: PathVertices, ranks: Uint8Array, size: number, lift: number, shared: SharedUniforms) {
    const count = vertices.class.length;
    this.#starts = chunkStarts(ranks);
    this.#chunks = this.#starts.length - 1;
    this.#boxes = new Float32Array(6 * this.#chunks);
    this.#time = vertices.time;
    this.#rank = new Uint8Array(this.#chunks);
    const stays = new Uint8Array(count);
    for (let c = 0; c < this.#chunks; c++) {
      const first = this.#starts[c]!;
      const last = this.#starts[c + 1]!;
      stays[first] = 1;
      boxOfPoints(vertices.position, first, last - first + 1, this.#boxes, 6 * c);
      const classes = new Set<number>();
      for (let v = first + 1; v <= last; v++) {
        this.#rank[c] = Math.max(this.#rank[c]!, ranks[v]!);
        if (vertices.class[v] !== vertices.class[v - 1] || v === first + 1) classes.add(vertices.class[v]!);
      }
      this.#classes.push([...classes]);
    }
    this.#paletteTexture = new DataTexture(this.#palette, maxClasses, 1, RGBAFormat);
    this.#paletteTexture.minFilter = this.#paletteTexture.magFilter = NearestFilter;
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      uniforms: {
        plane: shared.plane,
        background: shared.background,
        isOrthographic: shared.isOrthographic,
        pixel: shared.pixel,
        isCut: { value: 0 },
        now: { value: 0 },
        shown: { value: [1, 1] },
        pass: { value: [1, 0] },
        lift: { value: lift },
        palette: { value: this.#paletteTexture },
      },
    });
    const look = new Uint8Array(2 * count);
    for (let v = 0; v < count; v++) {
      look[2 * v] = vertices.class[v]!;
      look[2 * v + 1] = ranks[v]!;
    }
    const attributes = {
      position: new BufferAttribute(vertices.position, 3),
      look: new BufferAttribute(look, 2),
      time: new BufferAttribute(vertices.time, 1),
    };
    const tolerances = Array.from({ length: levelCount }, (_, k) => (size / 16384) * 2 ** k);
    const levels: Level[] = [];
    // The levels hold few vertices of a small path, so it is drawn as it is.
    if (count > 20000) levels.push(...thin(vertices.position, vertices.class, stays, tolerances));
    this.#add(attributes, null, 0, count);
    for (const level of levels) this.#add(attributes, level.kept, level.tolerance, level.kept.length);
  }

  #add(attributes: Record<string, BufferAttribute>, kept: Uint32Array | null, tolerance: number, count: number): void {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(attributes)) geometry.setAttribute(name, attribute);
    // Nothing uses the sphere, and three.js would go through all vertices for each level.
    geometry.boundingSphere = new Sphere();
    if (kept !== null) geometry.setIndex(new BufferAttribute(kept, 1));
    const start = new Uint32Array(this.#chunks + 1);
    for (let c = 1, i = 0; c < this.#chunks; c++) {
      // Chunks begin at kept vertices.
      while (kept !== null && kept[i]! < this.#starts[c]!) i++;
      start[c] = kept === null ? this.#starts[c]! : i;
    }
    start[this.#chunks] = count - 1;
    const line = new Line(geometry, [this.material]);
    line.frustumCulled = false;
    line.renderOrder = 1;
    this.object.add(line);
    this.#levels.push({ tolerance, line, start });
  }

  // The segments of each level, from all of them on.
  get levelSizes(): number[] {
    return this.#levels.map((level) => level.start[this.#chunks]!);
  }

  // A class is drawn from its least rank on, or not at all.
  setColors(colors: { color: string; isShown: boolean }[], least: Uint8Array): void {
    colors.forEach(({ color, isShown }, i) => {
      const rgb = plainColor(color);
      this.#palette.set([rgb.r * 255, rgb.g * 255, rgb.b * 255, isShown ? least[i]! + 1 : 0], 4 * i);
    });
    this.#paletteTexture.needsUpdate = true;
  }

  // Chooses for each chunk the level that is within `pixels` of the path in the picture. Chunks whose passes are all below
  // the `least` ranks are left out, but for that of the pass that runs in the times `pass`.
  choose(camera: Camera, pixels: number, least: Uint8Array, pass: [number, number]): void {
    for (const level of this.#levels) level.line.geometry.clearGroups();
    this.drawnSegments = 0;
    let run = -1; // level of the last chunk, -1 if it was not drawn
    let from = 0;
    const close = (level: number, chunk: number): void => {
      if (level < 0) return;
      const { line, start } = this.#levels[level]!;
      const size = start[chunk]! - start[from]!;
      line.geometry.addGroup(start[from]!, size + 1, 0);
      this.drawnSegments += size;
    };
    for (let c = 0; c <= this.#chunks; c++) {
      const level = c < this.#chunks && this.#isDrawn(c, least, pass) ? this.#levelOf(c, camera, pixels) : -1;
      if (level === run && c < this.#chunks) continue;
      close(run, c);
      run = level;
      from = c;
    }
    for (const level of this.#levels) level.line.visible = level.line.geometry.groups.length > 0;
  }

  #isDrawn(chunk: number, least: Uint8Array, pass: [number, number]): boolean {
    if (this.#classes[chunk]!.some((c) => this.#rank[chunk]! >= least[c]!)) return true;
    return this.#time[this.#starts[chunk + 1]!]! >= pass[0] && this.#time[this.#starts[chunk]!]! <= pass[1];
  }

  #levelOf(chunk: number, camera: Camera, pixels: number): number {
    const b = 6 * chunk;
    let x = -camera.target.x;
    let y = -camera.target.y;
    let z = -camera.target.z;
    x += (this.#boxes[b]! + this.#boxes[b + 3]!) / 2;
    y += (this.#boxes[b + 1]! + this.#boxes[b + 4]!) / 2;
    z += (this.#boxes[b + 2]! + this.#boxes[b + 5]!) / 2;
    const halfX = (this.#boxes[b + 3]! - this.#boxes[b]!) / 2;
    const halfY = (this.#boxes[b + 4]! - this.#boxes[b + 1]!) / 2;
    const halfZ = (this.#boxes[b + 5]! - this.#boxes[b + 2]!) / 2;
    const along = (v: { x: number; y: number; z: number }): number => x * v.x + y * v.y + z * v.z;
    const half = (v: { x: number; y: number; z: number }): number =>
      halfX * Math.abs(v.x) + halfY * Math.abs(v.y) + halfZ * Math.abs(v.z);
    const depth = camera.distance - along(camera.back);
    const halfDepth = half(camera.back);
    if (!camera.isOrthographic && depth + halfDepth <= 0) return -1;
    // A box beside the picture at its farthest depth is beside it everywhere.
    const reach = (camera.pixelAtDepth(Math.max(depth + halfDepth, 1e-6)) * camera.heightPx) / 2;
    if (Math.abs(along(camera.up)) - half(camera.up) > reach) return -1;
    if (Math.abs(along(camera.right)) - half(camera.right) > (reach * camera.width) / camera.heightPx) return -1;
    const allowed = pixels * camera.pixelAtDepth(Math.max(depth - halfDepth, 0));
    let level = 0;
    while (level + 1 < this.#levels.length && this.#levels[level + 1]!.tolerance <= allowed) level++;
    return level;
  }
}
