// The material of tool, stock and clamps: one colour under the light of the part, and lines for their edges.
import { BufferAttribute, BufferGeometry, Color, DoubleSide, FrontSide, GLSL3, Group, LineSegments, Mesh, RawShaderMaterial, ShapeUtils, Vector2 } from "three";
import { biasedPosition, light, plainColor, type SharedUniforms } from "./uniforms";

const vertexShader = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform mat4 modelMatrix;
uniform mat3 normalMatrix;
in vec3 position;
in vec3 normal;
out float vLight;
out vec3 vPoint;
${light}
void main() {
  vec4 v = modelViewMatrix * vec4(position, 1.0);
  vLight = light(normalMatrix * normal, v.xyz);
  vPoint = (modelMatrix * vec4(position, 1.0)).xyz;
  gl_Position = projectionMatrix * v;
}`;

const fragmentShader = `
precision highp float;
uniform vec4 plane;
uniform float isCut;
uniform vec3 base;
uniform float opacity;
in float vLight;
in vec3 vPoint;
out vec4 color;
void main() {
  if (isCut > 0.5 && dot(plane.xyz, vPoint) + plane.w < 0.0) discard;
  color = vec4(base * vLight, opacity);
}`;

export function solidMaterial(color: string, opacity: number, isCut: boolean, shared: SharedUniforms): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader,
    transparent: opacity < 1,
    depthWrite: opacity >= 1,
    side: opacity < 1 ? FrontSide : DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      plane: shared.plane,
      isOrthographic: shared.isOrthographic,
      isCut: { value: isCut ? 1 : 0 },
      base: { value: plainColor(color) },
      opacity: { value: opacity },
    },
  });
}

const lineVertexShader = `
precision highp float;
${biasedPosition}
in vec3 position;
in vec3 tint;
out vec3 vPoint;
out vec3 vTint;
uniform float bias;
uniform float lift;
void main() {
  vPoint = position;
  vTint = tint;
  gl_Position = biasedPosition(position, bias, lift);
}`;

const lineFragmentShader = `
precision highp float;
uniform vec4 plane;
uniform float isCut;
uniform vec3 base;
uniform float isTinted;
in vec3 vPoint;
in vec3 vTint;
out vec4 color;
void main() {
  if (isCut > 0.5 && dot(plane.xyz, vPoint) + plane.w < 0.0) discard;
  color = vec4(isTinted > 0.5 ? vTint : base, 1.0);
}`;

export interface LineLook {
  color: string | null; // null: the vertices have colours of their own
  bias: number; // px towards the eye
  lift: number; // mm towards the eye
  isCut: boolean;
}

export function lineMaterial(look: LineLook, shared: SharedUniforms): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: lineVertexShader,
    fragmentShader: lineFragmentShader,
    uniforms: {
      plane: shared.plane,
      isOrthographic: shared.isOrthographic,
      pixel: shared.pixel,
      isCut: { value: look.isCut ? 1 : 0 },
      bias: { value: look.bias },
      lift: { value: look.lift },
      base: { value: look.color === null ? new Color() : plainColor(look.color) },
      isTinted: { value: look.color === null ? 1 : 0 },
    },
  });
}

function areaTwice(outline: [number, number][]): number {
  let sum = 0;
  for (let i = 0; i < outline.length; i++) {
    const [ax, ay] = outline[i]!;
    const [bx, by] = outline[(i + 1) % outline.length]!;
    sum += ax * by - ay * bx;
  }
  return sum;
}

// A prism over an outline in XY, from `bottom` to `top`, with its edges.
export function makePrism(
  outline: [number, number][],
  bottom: number,
  top: number,
  color: string,
  opacity: number,
  shared: SharedUniforms,
): Group {
  const ring = areaTwice(outline) < 0 ? [...outline].reverse() : outline;
  const position: number[] = [];
  const normal: number[] = [];
  const edges: number[] = [];
  const push = (x: number, y: number, z: number, n: [number, number, number]): void => {
    position.push(x, y, z);
    normal.push(...n);
  };
  for (let i = 0; i < ring.length; i++) {
    const [ax, ay] = ring[i]!;
    const [bx, by] = ring[(i + 1) % ring.length]!;
    const size = Math.hypot(bx - ax, by - ay) || 1;
    const n: [number, number, number] = [(by - ay) / size, -(bx - ax) / size, 0];
    for (const [x, y, z] of [[ax, ay, bottom], [bx, by, bottom], [bx, by, top], [ax, ay, bottom], [bx, by, top], [ax, ay, top]] as const) {
      push(x, y, z, n);
    }
    edges.push(ax, ay, bottom, bx, by, bottom, ax, ay, top, bx, by, top);
    // Only corners get an upright edge: a round outline has none.
    const [cx, cy] = ring[(i + 2) % ring.length]!;
    const turn = Math.abs(Math.atan2((bx - ax) * (cy - by) - (by - ay) * (cx - bx), (bx - ax) * (cx - bx) + (by - ay) * (cy - by)));
    if (turn > 0.35) edges.push(bx, by, bottom, bx, by, top);
  }
  for (const triangle of ShapeUtils.triangulateShape(ring.map(([x, y]) => new Vector2(x, y)), [])) {
    const [a, b, c] = triangle.map((i) => ring[i]!) as [[number, number], [number, number], [number, number]];
    for (const [x, y] of [a, b, c]) push(x, y, top, [0, 0, 1]);
    for (const [x, y] of [a, c, b]) push(x, y, bottom, [0, 0, -1]);
  }
  const group = new Group();
  const faces = new BufferGeometry();
  faces.setAttribute("position", new BufferAttribute(new Float32Array(position), 3));
  faces.setAttribute("normal", new BufferAttribute(new Float32Array(normal), 3));
  const mesh = new Mesh(faces, solidMaterial(color, opacity, true, shared));
  mesh.renderOrder = opacity < 1 ? 5 : 0;
  const lines = new BufferGeometry();
  lines.setAttribute("position", new BufferAttribute(new Float32Array(edges), 3));
  const edge = new LineSegments(lines, lineMaterial({ color: opacity < 1 ? color : "#3b4149", bias: 1, lift: 0, isCut: true }, shared));
  group.add(mesh, edge);
  for (const o of [mesh, edge]) o.frustumCulled = false;
  return group;
}
