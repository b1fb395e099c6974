// The path as one polyline: the ends of moves, and points on the arcs between them.
import { arcChords, arcPoint, arcRadius } from "./arc";
import { betweenPasses, Kind, type Path } from "./scene";
import type { Timeline } from "./timeline";

// How a move is drawn and switched: all rapids are one class, and the cuts of each kind of pass.
export const PathClass = { rapid: 0, approach: 1, lead: 2, link: 3, cut: 4, firstPass: 5 } as const;
export const maxClasses = 256;

export interface PathVertices {
  position: Float32Array;
  move: Uint32Array | null; // of the segment that ends in the vertex; null: it is the vertex itself
  share: Float32Array | null; // of that move, at the vertex; null: 1
  class: Uint8Array; // of the segment that ends in the vertex
  time: Float32Array; // s, at the vertex
}

export function segmentLength(position: Float32Array, end: number): number {
  const i = 3 * end;
  const x = position[i]! - position[i - 3]!;
  const y = position[i + 1]! - position[i - 2]!;
  const z = position[i + 2]! - position[i - 1]!;
  return Math.sqrt(x * x + y * y + z * z);
}

export function classOf(path: Path, move: number): number {
  switch (path.kind[move]) {
    case Kind.rapid:
      return PathClass.rapid;
    case Kind.lead:
      return PathClass.lead;
    case Kind.link:
      return PathClass.link;
    case Kind.cut: {
      const pass = path.passKind === null ? betweenPasses : path.passKind[move]!;
      return pass === betweenPasses ? PathClass.cut : Math.min(PathClass.firstPass + pass, maxClasses - 1);
    }
    default:
      return PathClass.approach;
  }
}

// `chord` (mm): how far the polyline may be from an arc.
export function makePathVertices(timeline: Timeline, chord: number): PathVertices {
  const { path, moves } = timeline;
  const { arcs, tip } = path;
  const classes = new Uint8Array(moves);
  for (let m = 0; m < moves; m++) classes[m] = classOf(path, m);
  if (arcs === null) {
    return { position: tip, move: null, share: null, class: classes, time: Float32Array.from(timeline.end) };
  }
  const chords = new Uint16Array(arcs.move.length);
  let size = moves;
  for (let a = 0; a < arcs.move.length; a++) {
    const start = tip.subarray(3 * (arcs.move[a]! - 1), 3 * arcs.move[a]!);
    chords[a] = arcChords(arcRadius(arcs, a, start), arcs.turns[a]!, chord);
    size += chords[a]! - 1;
  }
  const all: PathVertices = {
    position: new Float32Array(3 * size),
    move: new Uint32Array(size),
    share: new Float32Array(size),
    class: new Uint8Array(size),
    time: new Float32Array(size),
  };
  const point = [0, 0, 0];
  let to = 0;
  let from = 0; // first move that is not yet written
  const copyUntil = (move: number): void => {
    all.position.set(tip.subarray(3 * from, 3 * move), 3 * to);
    all.class.set(classes.subarray(from, move), to);
    for (; from < move; from++, to++) {
      all.move![to] = from;
      all.share![to] = 1;
      all.time[to] = timeline.end[from]!;
    }
  };
  for (let a = 0; a < arcs.move.length; a++) {
    const move = arcs.move[a]!;
    copyUntil(move);
    const start = tip.subarray(3 * (move - 1), 3 * move);
    const end = tip.subarray(3 * move, 3 * move + 3);
    for (let k = 1; k < chords[a]!; k++, to++) {
      const share = k / chords[a]!;
      arcPoint(arcs, a, start, end, share, point);
      all.position.set(point, 3 * to);
      all.move![to] = move;
      all.share![to] = share;
      all.class[to] = classes[move]!;
      all.time[to] = timeline.timeOf({ move, share });
    }
  }
  copyUntil(moves);
  return all;
}
