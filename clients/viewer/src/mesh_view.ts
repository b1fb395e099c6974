// Draws the surface: one mesh whose shading can change without new triangles.
import { BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, GLSL3, LinearFilter, Mesh as Mesh3, RawShaderMaterial, RGBAFormat } from "three";
import type { Mesh } from "./scene";
import { colors, type Scale, type Shading } from "./shading";
import { light, plainColor, type SharedUniforms } from "./uniforms";

const vertexShader = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform mat3 normalMatrix;
in vec3 position;
in vec3 normal;
in vec3 tint;
in vec2 value; // and 1 if it is known
out vec3 vTint;
out vec2 vValue;
out float vLight;
#ifdef CUT
uniform vec4 plane;
out float vSide;
#endif
${light}
void main() {
  vec4 v = modelViewMatrix * vec4(position, 1.0);
  vLight = light(normalMatrix * normal, v.xyz);
#ifdef CUT
  vSide = dot(plane.xyz, position) + plane.w;
#endif
  vTint = tint;
  vValue = value;
  gl_Position = projectionMatrix * v;
}`;

const fragmentShader = `
precision highp float;
uniform float isScaled;
uniform vec2 range;
uniform float mark;
uniform sampler2D ramp;
uniform vec3 under;
uniform vec3 over;
uniform vec3 unknown;
in vec3 vTint;
in vec2 vValue;
in float vLight;
#ifdef CUT
in float vSide;
#endif
out vec4 color;
void main() {
#ifdef CUT
  float sideStep = fwidth(vSide);
  float markStep = fwidth(vValue.x);
  if (vSide < 0.0) discard;
#endif
  vec3 base = vTint;
  if (isScaled > 0.5) {
    if (vValue.y < 0.999) base = unknown;
    else if (vValue.x < range.x) base = under;
    else if (vValue.x > range.y) base = over;
    else base = texture(ramp, vec2((vValue.x - range.x) / (range.y - range.x), 0.5)).rgb;
#ifndef CUT
    float markStep = mark > -1e29 ? fwidth(vValue.x) : 0.0;
#endif
    if (mark > -1e29 && abs(vValue.x - mark) < 0.8 * markStep) base = vec3(0.07);
  }
  vec3 lit = base * vLight;
  if (!gl_FrontFacing) lit *= 0.82;
#ifdef CUT
  if (vSide < 1.2 * sideStep) lit *= 0.35; // the edge of the section
#endif
  color = vec4(lit, 1.0);
}`;

// Area-weighted normals of vertices, for a scene that has none.
export function meshNormals(mesh: Mesh): Float32Array {
  const { position: p, index } = mesh;
  const normal = new Float32Array(p.length);
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = [3 * index[t]!, 3 * index[t + 1]!, 3 * index[t + 2]!];
    const u = [p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!] as const;
    const v = [p[c]! - p[a]!, p[c + 1]! - p[a + 1]!, p[c + 2]! - p[a + 2]!] as const;
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as const;
    for (const corner of [a, b, c]) for (let k = 0; k < 3; k++) normal[corner + k]! += n[k]!;
  }
  for (let v = 0; v < normal.length; v += 3) {
    const size = Math.hypot(normal[v]!, normal[v + 1]!, normal[v + 2]!) || 1;
    for (let k = 0; k < 3; k++) normal[v + k]! /= size;
  }
  return normal;
}

export interface SplitVertices {
  index: Uint32Array; // into the split vertices
  source: Uint32Array | null; // the vertex that each one is a copy of; null: none was copied
  region: Int32Array; // of each split vertex
}

// Copies the vertices on region borders, so that each vertex has one region and colours end sharply there.
export function splitByRegion(mesh: Mesh): SplitVertices {
  const vertices = mesh.position.length / 3;
  const none = -2;
  const region = new Int32Array(vertices).fill(none);
  if (mesh.region === null) return { index: mesh.index, source: null, region: region.fill(-1) };
  const index = mesh.index.slice();
  const copies = new Map<string, number>();
  const source: number[] = [];
  const copyRegion: number[] = [];
  for (let i = 0; i < index.length; i++) {
    const v = index[i]!;
    const r = mesh.region[Math.floor(i / 3)]!;
    if (region[v] === none) region[v] = r;
    if (region[v] === r) continue;
    const key = `${v} ${r}`;
    let copy = copies.get(key);
    if (copy === undefined) {
      copy = vertices + source.length;
      copies.set(key, copy);
      source.push(v);
      copyRegion.push(r);
    }
    index[i] = copy;
  }
  for (let v = 0; v < vertices; v++) if (region[v] === none) region[v] = -1;
  if (source.length === 0) return { index, source: null, region };
  const all = new Uint32Array(vertices + source.length);
  for (let v = 0; v < vertices; v++) all[v] = v;
  all.set(source, vertices);
  const regions = new Int32Array(all.length);
  regions.set(region);
  regions.set(copyRegion, vertices);
  return { index, source: all, region: regions };
}

function gather(values: Float32Array, source: Uint32Array | null, width: number): Float32Array {
  if (source === null) return values;
  const out = new Float32Array(source.length * width);
  for (let v = 0; v < source.length; v++) for (let k = 0; k < width; k++) out[width * v + k] = values[width * source[v]! + k]!;
  return out;
}

function rampTexture(scale: Scale): DataTexture {
  const size = 256;
  const data = new Uint8Array(4 * size);
  const stops = scale.stops.map(plainColor);
  const mixed = new Color();
  for (let i = 0; i < size; i++) {
    const at = (i / (size - 1)) * (stops.length - 1);
    const k = Math.min(stops.length - 2, Math.floor(at));
    mixed.lerpColors(stops[k]!, stops[k + 1]!, at - k);
    data.set([mixed.r * 255, mixed.g * 255, mixed.b * 255, 255], 4 * i);
  }
  const texture = new DataTexture(data, size, 1, RGBAFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export class MeshView {
  readonly object: Mesh3;
  readonly #material: RawShaderMaterial;
  readonly #split: SplitVertices;
  readonly #tint: Uint8Array;
  readonly #value: Float32Array;

  constructor(mesh: Mesh, shared: SharedUniforms) {
    this.#split = splitByRegion(mesh);
    const vertices = this.#split.region.length;
    this.#tint = new Uint8Array(3 * vertices);
    this.#value = new Float32Array(2 * vertices);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(gather(mesh.position, this.#split.source, 3), 3));
    geometry.setAttribute("normal", new BufferAttribute(gather(mesh.normal ?? meshNormals(mesh), this.#split.source, 3), 3));
    geometry.setAttribute("tint", new BufferAttribute(this.#tint, 3, true));
    geometry.setAttribute("value", new BufferAttribute(this.#value, 2));
    geometry.setIndex(new BufferAttribute(this.#split.index, 1));
    this.#material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 2,
      uniforms: {
        plane: shared.plane,
        isOrthographic: shared.isOrthographic,
        isScaled: { value: 0 },
        range: { value: [0, 1] },
        mark: { value: -1e30 },
        ramp: { value: null },
        under: { value: new Color() },
        over: { value: new Color() },
        unknown: { value: plainColor(colors.unknownGrey) },
      },
    });
    this.object = new Mesh3(geometry, this.#material);
    this.object.frustumCulled = false;
  }

  // The shader looks for the section plane only if there is one: without it, hidden fragments cost nothing.
  setCut(isCut: boolean): void {
    if ("CUT" in (this.#material.defines ?? {}) === isCut) return;
    this.#material.defines = isCut ? { CUT: "" } : {};
    this.#material.needsUpdate = true;
  }

  shade(shading: Shading): void {
    const { uniforms } = this.#material;
    const { region, source } = this.#split;
    uniforms.isScaled!.value = shading.scale === null ? 0 : 1;
    if (shading.scale !== null && shading.values !== null) {
      for (let v = 0; v < region.length; v++) {
        const value = shading.values[source === null ? v : source[v]!]!;
        const isKnown = !Number.isNaN(value);
        this.#value[2 * v] = isKnown ? value : 0;
        this.#value[2 * v + 1] = isKnown ? 1 : 0;
      }
      uniforms.range!.value = [shading.scale.low, shading.scale.high];
      uniforms.mark!.value = shading.scale.mark ?? -1e30;
      uniforms.under!.value = plainColor(shading.scale.under);
      uniforms.over!.value = plainColor(shading.scale.over);
      (uniforms.ramp!.value as DataTexture | null)?.dispose();
      uniforms.ramp!.value = rampTexture(shading.scale);
      this.object.geometry.getAttribute("value").needsUpdate = true;
    } else {
      const rgb = new Map<number, number[]>();
      for (const [id, css] of shading.regionColors ?? []) rgb.set(id, plainColor(css).toArray().map((c) => Math.round(c * 255)));
      const other = rgb.get(-1) ?? [180, 186, 194];
      for (let v = 0; v < region.length; v++) this.#tint.set(rgb.get(region[v]!) ?? other, 3 * v);
      this.object.geometry.getAttribute("tint").needsUpdate = true;
    }
  }
}
