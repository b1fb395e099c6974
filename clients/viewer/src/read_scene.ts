// Reads a scene: views of the binary block, checked so that nothing behind them has to check again.
import { ProgramText } from "./program_text";
import { readHeader } from "./read_header";
import { type Arcs, betweenPasses, type Header, type Mesh, type Path, type Scene, SceneError } from "./scene";

type Array1 = Float32Array | Uint32Array | Int32Array | Uint8Array;

const types = { f32: Float32Array, u32: Uint32Array, i32: Int32Array, u8: Uint8Array } as const;

interface Spec {
  type: keyof typeof types;
  width: number; // values of one item
}
const specs = {
  "mesh.position": { type: "f32", width: 3 },
  "mesh.normal": { type: "f32", width: 3 },
  "mesh.slope": { type: "f32", width: 1 },
  "mesh.curvature": { type: "f32", width: 1 },
  "mesh.leftover": { type: "f32", width: 1 },
  "mesh.gouge": { type: "f32", width: 1 },
  "mesh.index": { type: "u32", width: 3 },
  "mesh.region": { type: "i32", width: 1 },
  "mesh.surface": { type: "u32", width: 1 },
  "border.position": { type: "f32", width: 3 },
  "path.tip": { type: "f32", width: 3 },
  "path.kind": { type: "u8", width: 1 },
  "path.pass_kind": { type: "u8", width: 1 },
  "path.region": { type: "i32", width: 1 },
  "path.pass": { type: "i32", width: 1 },
  "path.feed": { type: "f32", width: 1 },
  "path.seconds": { type: "f32", width: 1 },
  "path.line": { type: "u32", width: 1 },
  "arc.move": { type: "u32", width: 1 },
  "arc.plane": { type: "u8", width: 1 },
  "arc.center": { type: "f32", width: 3 },
  "arc.turns": { type: "f32", width: 1 },
  "program.text": { type: "u8", width: 1 },
} as const satisfies Record<string, Spec>;
type BufferName = keyof typeof specs;
type ArrayOf<N extends BufferName> = InstanceType<(typeof types)[(typeof specs)[N]["type"]]>;

const need = (holds: boolean, message: string): void => {
  if (!holds) throw new SceneError(message);
};

// The buffers of a block. The count of a buffer is the number of its values, three of them for each point.
class Buffers {
  readonly #entries: Record<string, unknown>;
  readonly #block: ArrayBuffer;

  constructor(json: unknown, block: ArrayBuffer) {
    need(typeof json === "object" && json !== null && !Array.isArray(json), 'The field "buffers" of the header must be an object.');
    this.#entries = json as Record<string, unknown>;
    this.#block = block;
  }

  // The view of a buffer, or null if the scene does not have it. `items` is the wanted number of items, if it is known.
  get<N extends BufferName>(name: N, items?: number): ArrayOf<N> | null {
    const entry = Object.hasOwn(this.#entries, name) ? this.#entries[name] : undefined;
    if (entry === undefined || entry === null) return null;
    const { type, offset, count } = entry as { type?: unknown; offset?: unknown; count?: unknown };
    const spec: Spec = specs[name];
    need(type === spec.type, `The buffer ${name} must hold ${spec.type}, and the header says ${JSON.stringify(type)}.`);
    need(Number.isInteger(offset) && (offset as number) >= 0, `The offset of the buffer ${name} is no whole number.`);
    need((offset as number) % 4 === 0, `The buffer ${name} must begin at a multiple of 4 bytes.`);
    need(Number.isInteger(count) && (count as number) >= 0, `The count of the buffer ${name} is no whole number.`);
    const Type = types[spec.type];
    const end = (offset as number) + (count as number) * Type.BYTES_PER_ELEMENT;
    need(
      end <= this.#block.byteLength,
      `The data end early: the buffer ${name} ends at byte ${end}, and there are ${this.#block.byteLength} bytes.`,
    );
    need((count as number) % spec.width === 0, `The buffer ${name} must hold a multiple of ${spec.width} values, not ${count}.`);
    if (items !== undefined) {
      need(
        count === items * spec.width,
        `The buffer ${name} must hold ${items * spec.width} values, and it holds ${count}.`,
      );
    }
    return new Type(this.#block, offset as number, count as number) as ArrayOf<N>;
  }

  must<N extends BufferName>(name: N, why: BufferName, items?: number): ArrayOf<N> {
    const array = this.get(name, items);
    if (array === null) throw new SceneError(`The buffer ${name} is missing, although there is ${why}.`);
    return array;
  }
}

// A sum of zeros is 0; one value that is not finite makes it NaN.
function needFinite(array: Float32Array | null, name: string): void {
  if (array === null) return;
  let zero = 0;
  for (let i = 0; i < array.length; i++) zero += array[i]! * 0;
  if (zero === 0) return;
  const at = array.findIndex((v) => !Number.isFinite(v));
  throw new SceneError(`The buffer ${name} holds a value that is not finite, at ${at}.`);
}

// Contour curvature may be NaN, where the surface is level; an infinite value has no colour.
function needNoInfinity(array: Float32Array | null, name: string): void {
  if (array === null) return;
  for (let i = 0; i < array.length; i++) {
    if (array[i] === Infinity || array[i] === -Infinity) throw new SceneError(`The buffer ${name} holds an infinite value, at ${i}.`);
  }
}

function needBetween(array: Array1 | null, name: string, least: number, most: number): void {
  if (array === null) return;
  for (let i = 0; i < array.length; i++) {
    const v = array[i]!;
    if (!(v >= least && v <= most)) {
      throw new SceneError(`The buffer ${name} holds ${v} at ${i}; it must lie between ${least} and ${most}.`);
    }
  }
}

function needKnown(array: Int32Array | null, name: string, ids: Set<number>): void {
  if (array === null) return;
  let last = -1; // most neighbours have the same region
  for (let i = 0; i < array.length; i++) {
    const v = array[i]!;
    if (v === last || v === -1) continue;
    if (!ids.has(v)) throw new SceneError(`The buffer ${name} holds the region ${v} at ${i}, which is not in the list of regions.`);
    last = v;
  }
}

function readMesh(buffers: Buffers, header: Header, ids: Set<number>): Mesh | null {
  const position = buffers.get("mesh.position");
  const index = buffers.get("mesh.index");
  if (position === null && index === null) return null;
  if (position === null) throw new SceneError("The buffer mesh.position is missing, although there is mesh.index.");
  if (index === null) throw new SceneError("The buffer mesh.index is missing, although there is mesh.position.");
  const vertices = position.length / 3;
  const triangles = index.length / 3;
  const mesh: Mesh = {
    position,
    index,
    normal: buffers.get("mesh.normal", vertices),
    slope: buffers.get("mesh.slope", vertices),
    curvature: buffers.get("mesh.curvature", vertices),
    leftover: buffers.get("mesh.leftover", vertices),
    gouge: buffers.get("mesh.gouge", vertices),
    region: buffers.get("mesh.region", triangles),
    surface: buffers.get("mesh.surface", triangles),
  };
  needBetween(index, "mesh.index", 0, vertices - 1);
  needFinite(position, "mesh.position");
  needFinite(mesh.normal, "mesh.normal");
  needFinite(mesh.slope, "mesh.slope");
  needNoInfinity(mesh.curvature, "mesh.curvature");
  needFinite(mesh.leftover, "mesh.leftover");
  needFinite(mesh.gouge, "mesh.gouge");
  needKnown(mesh.region, "mesh.region", ids);
  needBetween(mesh.surface, "mesh.surface", 0, header.surfaces.length - 1);
  return triangles === 0 ? null : mesh;
}

function readArcs(buffers: Buffers, moves: number): Arcs | null {
  const move = buffers.get("arc.move");
  if (move === null || move.length === 0) return null;
  const arcs: Arcs = {
    move,
    plane: buffers.must("arc.plane", "arc.move", move.length),
    center: buffers.must("arc.center", "arc.move", move.length),
    turns: buffers.must("arc.turns", "arc.move", move.length),
  };
  needBetween(move, "arc.move", 1, moves - 1);
  for (let i = 1; i < move.length; i++) need(move[i]! > move[i - 1]!, `The buffer arc.move must rise, and it does not at ${i}.`);
  needBetween(arcs.plane, "arc.plane", 1, 3);
  needFinite(arcs.center, "arc.center");
  // One turn written as a rounded number may be a little more than 1.
  needBetween(arcs.turns, "arc.turns", -1.0001, 1.0001);
  return arcs;
}

function readPath(buffers: Buffers, header: Header, ids: Set<number>, lines: number | null): Path | null {
  const tip = buffers.get("path.tip");
  if (tip === null) {
    need(buffers.get("path.kind") === null, "The buffer path.tip is missing, although there is path.kind.");
    return null;
  }
  const moves = tip.length / 3;
  if (moves === 0) return null;
  const path: Path = {
    tip,
    kind: buffers.must("path.kind", "path.tip", moves),
    passKind: buffers.get("path.pass_kind", moves),
    region: buffers.get("path.region", moves),
    pass: buffers.get("path.pass", moves),
    feed: buffers.get("path.feed", moves),
    seconds: buffers.get("path.seconds", moves),
    line: buffers.get("path.line", moves),
    arcs: readArcs(buffers, moves),
  };
  needFinite(tip, "path.tip");
  needBetween(path.kind, "path.kind", 1, 7);
  if (path.passKind !== null) {
    const kinds = header.passes.length;
    for (let i = 0; i < moves; i++) {
      const k = path.passKind[i]!;
      need(k === betweenPasses || k < kinds, `The buffer path.pass_kind holds ${k} at ${i}, and there are ${kinds} kinds of passes.`);
    }
  }
  needKnown(path.region, "path.region", ids);
  needBetween(path.pass, "path.pass", -1, 0x7fffffff);
  needFinite(path.feed, "path.feed");
  needFinite(path.seconds, "path.seconds");
  needBetween(path.seconds, "path.seconds", 0, Number.MAX_VALUE);
  if (lines !== null) needBetween(path.line, "path.line", 0, lines);
  for (const section of header.sections) {
    need(section.first_move < moves, `The section "${section.name}" begins at move ${section.first_move}, and there are ${moves} moves.`);
  }
  return path;
}

// Reads a scene from its parsed JSON header and its binary block. It throws a SceneError if the scene is damaged.
export function readScene(json: unknown, block: ArrayBuffer): Scene {
  need(new Uint8Array(new Uint32Array([1]).buffer)[0] === 1, "This computer stores numbers in an order that the page cannot read.");
  const header = readHeader(json);
  const buffers = new Buffers((json as { buffers?: unknown }).buffers, block);
  const ids = new Set(header.regions.map((r) => r.id));
  need(ids.size === header.regions.length, "Two regions have the same id.");
  const text = buffers.get("program.text");
  const program = text === null ? null : new ProgramText(text);
  const mesh = readMesh(buffers, header, ids);
  const path = readPath(buffers, header, ids, program === null ? null : program.lines);
  const borderPosition = buffers.get("border.position");
  needFinite(borderPosition, "border.position");
  const points = borderPosition === null ? 0 : borderPosition.length / 3;
  for (const b of header.borders) {
    need(b.first + b.count <= points, `The border "${b.name}" needs ${b.first + b.count} points, and there are ${points}.`);
  }
  need(mesh !== null || path !== null, "The scene has neither a surface nor a path to draw.");
  return { header, mesh, borderPosition, path, program };
}
