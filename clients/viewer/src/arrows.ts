// Shows where passes start and which way they run, by signs of constant size in the picture.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, GLSL3, Mesh, RawShaderMaterial, Sphere } from "three";
import type { Camera } from "./camera";
import { type PathVertices, segmentLength } from "./path_vertices";
import { Kind, type Path } from "./scene";
import { biasedPosition, plainColor, type SharedUniforms } from "./uniforms";

const most = 700; // signs in a picture
const cell = 34; // px: one sign in each

const vertexShader = `
precision highp float;
${biasedPosition}
in vec3 position;
in vec3 direction;
in vec2 corner; // along and beside the direction, px
uniform vec2 halfSize; // of the picture, px
out vec2 vCorner;
void main() {
  vec4 clip = biasedPosition(position, 5.0, 0.0);
  vec4 ahead = projectionMatrix * (modelViewMatrix * vec4(position + direction * pixel * (isOrthographic > 0.5 ? 1.0 : clip.w), 1.0));
  vec2 way = (ahead.xy / ahead.w - clip.xy / clip.w) * halfSize;
  float size = length(way);
  way = size > 1e-6 ? way / size : vec2(1.0, 0.0);
  vec2 offset = way * corner.x + vec2(-way.y, way.x) * corner.y;
  clip.xy += offset / halfSize * clip.w;
  gl_Position = clip;
}`;

const fragmentShader = `
precision highp float;
uniform vec3 base;
out vec4 color;
void main() { color = vec4(base, 1.0); }`;

interface Sign {
  vertex: number;
  isStart: boolean;
}

// Signs in the order of their rank: coarse ones first, so that zooming in adds signs and takes none away.
export function passSigns(path: Path, vertices: PathVertices, size: number): Sign[] {
  const { position } = vertices;
  const moveOf = (v: number): number => (vertices.move === null ? v : vertices.move[v]!);
  const count = vertices.class.length;
  const runs: [number, number][] = [];
  for (let v = 1; v < count; ) {
    const move = moveOf(v);
    if (path.kind[move] !== Kind.cut) {
      v++;
      continue;
    }
    const pass = path.pass?.[move] ?? 0;
    let end = v + 1;
    while (end < count && path.kind[moveOf(end)] === Kind.cut && (path.pass?.[moveOf(end)] ?? 0) === pass) end++;
    runs.push([v - 1, end - 1]);
    v = end;
  }
  const signs: { sign: Sign; rank: number }[] = [];
  const step = Math.max(1, Math.ceil(runs.length / 8000));
  runs.forEach(([first, last], i) => {
    if (i % step !== 0) return;
    let length = 0;
    const lengthTo = (v: number): number => segmentLength(position, v);
    for (let v = first + 1; v <= last; v++) length += lengthTo(v);
    const arrows = Math.min(40, Math.max(1, Math.round(length / (0.4 * size))));
    // Trailing zeros of the number of the run: every second run is half as important.
    const rank = i === 0 ? 30 : Math.clz32(i & -i) ^ 31;
    signs.push({ sign: { vertex: first, isStart: true }, rank: rank + 0.5 });
    let along = 0;
    let next = 0;
    for (let v = first + 1; v <= last && next < arrows; v++) {
      along += lengthTo(v);
      if (along < ((next + 0.5) / arrows) * length) continue;
      signs.push({ sign: { vertex: v, isStart: false }, rank });
      next++;
    }
  });
  return signs.sort((a, b) => b.rank - a.rank).map((s) => s.sign);
}

export class Arrows {
  readonly object: Mesh<BufferGeometry, RawShaderMaterial>;
  readonly #vertices: PathVertices;
  readonly #signs: Sign[];
  readonly #position = new Float32Array(9 * 2 * most);
  readonly #direction = new Float32Array(9 * 2 * most);
  readonly #corner = new Float32Array(6 * 2 * most);

  constructor(path: Path, vertices: PathVertices, size: number, shared: SharedUniforms) {
    this.#vertices = vertices;
    this.#signs = passSigns(path, vertices, size);
    const geometry = new BufferGeometry();
    geometry.boundingSphere = new Sphere(); // of no use: the signs move
    const attribute = (array: Float32Array, width: number): BufferAttribute => {
      const a = new BufferAttribute(array, width);
      a.setUsage(DynamicDrawUsage);
      return a;
    };
    geometry.setAttribute("position", attribute(this.#position, 3));
    geometry.setAttribute("direction", attribute(this.#direction, 3));
    geometry.setAttribute("corner", attribute(this.#corner, 2));
    this.object = new Mesh(
      geometry,
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader,
        fragmentShader,
        side: 2,
        uniforms: {
          isOrthographic: shared.isOrthographic,
          pixel: shared.pixel,
          halfSize: { value: [1, 1] },
          base: { value: plainColor("#111111") },
        },
      }),
    );
    this.object.frustumCulled = false;
    this.object.renderOrder = 2;
  }

  setColor(color: string): void {
    this.object.material.uniforms.base!.value = plainColor(color);
  }

  // Places the signs that have room in the picture.
  place(camera: Camera, isShown: (vertex: number) => boolean): void {
    const { position } = this.#vertices;
    const taken = new Set<number>();
    let to = 0;
    const push = (v: number, direction: number[], corners: [number, number][]): void => {
      for (const [along, beside] of corners) {
        this.#position.set(position.subarray(3 * v, 3 * v + 3), 3 * to);
        this.#direction.set(direction, 3 * to);
        this.#corner.set([along, beside], 2 * to);
        to++;
      }
    };
    camera.update();
    const columns = Math.ceil(camera.width / cell) + 2;
    for (const { vertex, isStart } of this.#signs) {
      if (taken.size >= most) break;
      const { x, y, depth } = camera.projectNow(position[3 * vertex]!, position[3 * vertex + 1]!, position[3 * vertex + 2]!);
      if (depth <= 0 || x < 0 || y < 0 || x > camera.width || y > camera.heightPx) continue;
      const key = Math.floor(y / cell) * columns + Math.floor(x / cell);
      if (taken.has(key)) continue;
      const end = isStart ? vertex + 1 : vertex;
      if (!isShown(end)) continue;
      taken.add(key);
      const d = [0, 1, 2].map((k) => position[3 * end + k]! - position[3 * end - 3 + k]!);
      const size = Math.hypot(...d) || 1;
      const unit = d.map((v) => v / size);
      if (isStart) push(vertex, unit, [[-3.2, -3.2], [3.2, -3.2], [3.2, 3.2], [-3.2, -3.2], [3.2, 3.2], [-3.2, 3.2]]);
      else push(vertex, unit, [[6, 0], [-5, 4], [-5, -4]]);
    }
    const { geometry } = this.object;
    geometry.setDrawRange(0, to);
    for (const name of ["position", "direction", "corner"]) geometry.getAttribute(name).needsUpdate = true;
    this.object.material.uniforms.halfSize!.value = [camera.width / 2, camera.heightPx / 2];
  }
}
