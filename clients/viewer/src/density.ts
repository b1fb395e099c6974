// Draws every second, fourth, ... pass where all of them would cover the part.
import { maxClasses, PathClass, type PathVertices, segmentLength } from "./path_vertices";
import { Kind, type Mesh, type Path } from "./scene";

const room = 3; // px between passes
export const always = 255;

export interface Ranks {
  ranks: Uint8Array; // of each vertex
  counts: Uint32Array; // passes, or turns of passes, of each class
  hasTurns: boolean; // long passes are counted by their turns
}

const longPass = 20000; // vertices: passes that are longer on the average are spirals

// The rank of each vertex: passes with rank k or more are each 2^k-th one. Leads and links have the rank of the pass that
// they lead to, all other moves are always drawn. A spiral is a single pass, so each full turn of it counts as one.
export function passRanks(path: Path, vertices: PathVertices): Ranks {
  const { position } = vertices;
  const count = vertices.class.length;
  const ranks = new Uint8Array(count).fill(always);
  const counts = new Uint32Array(maxClasses);
  if (path.pass === null) return { ranks, counts, hasTurns: false };
  const moveOf = (v: number): number => (vertices.move === null ? v : vertices.move[v]!);
  let passes = 0;
  for (let m = 1; m < path.pass.length; m++) if (path.pass[m]! >= 0 && path.pass[m] !== path.pass[m - 1]) passes++;
  const hasTurns = passes * longPass < count;
  let rank = always;
  let last = -1;
  let firstOfRun = 1;
  let turned = 0; // since the pass or its last turn began
  let headingX = 0;
  let headingY = 0;
  for (let v = 1; v < count; v++) {
    const move = moveOf(v);
    if (path.kind[move] !== Kind.cut) continue;
    const c = vertices.class[v]!;
    const pass = path.pass[move]!;
    if (hasTurns) {
      const x = position[3 * v]! - position[3 * v - 3]!;
      const y = position[3 * v + 1]! - position[3 * v - 2]!;
      if (x !== 0 || y !== 0) {
        turned += Math.atan2(headingX * y - headingY * x, headingX * x + headingY * y);
        headingX = x;
        headingY = y;
      }
    }
    if (pass !== last || Math.abs(turned) >= 2 * Math.PI) {
      const n = counts[c]!++;
      rank = n === 0 ? always - 1 : Math.clz32(n & -n) ^ 31;
      last = pass;
      turned = 0;
      for (let w = firstOfRun; w < v; w++) if (isJoint(vertices.class[w]!)) ranks[w] = rank;
    }
    ranks[v] = rank;
    firstOfRun = v + 1;
  }
  return { ranks, counts, hasTurns };
}

const isJoint = (c: number): boolean => c === PathClass.lead || c === PathClass.link;

function meshArea(mesh: Mesh): number {
  const { index, position: p } = mesh;
  let sum = 0;
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = [3 * index[t]!, 3 * index[t + 1]!, 3 * index[t + 2]!];
    const [ux, uy, uz] = [p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!];
    const [vx, vy, vz] = [p[c]! - p[a]!, p[c + 1]! - p[a + 1]!, p[c + 2]! - p[a + 2]!];
    sum += Math.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2) / 2;
  }
  return sum;
}

// The distance (mm) between neighbouring passes of each class: area over length. It is too large where the passes cover a
// part of the area alone, so that more of them are drawn; Infinity where there are none.
export function passSpacing(vertices: PathVertices, mesh: Mesh | null): Float64Array {
  const length = new Float64Array(maxClasses);
  for (let v = 1; v < vertices.class.length; v++) length[vertices.class[v]!]! += segmentLength(vertices.position, v);
  const area = mesh === null ? Infinity : meshArea(mesh);
  return length.map((l, c) => (c >= PathClass.cut && l > 0 ? area / l : Infinity));
}

// The times between which the pass (or the turn of it) runs that is cut at `now`; an empty span if none is.
export function currentSpan(vertices: PathVertices, ranks: Uint8Array, now: number): [number, number] {
  const { time } = vertices;
  let low = 0;
  let high = time.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle]! >= now) high = middle;
    else low = middle + 1;
  }
  const rank = ranks[low]!;
  if (low === 0 || rank === always) return [1, 0];
  let first = low;
  let last = low;
  while (first > 1 && ranks[first - 1] === rank) first--;
  while (last + 1 < time.length && ranks[last + 1] === rank) last++;
  return [time[first - 1]!, time[last]!];
}

// The least rank that is drawn of each class, for pixels of a size (mm).
export function leastRanks(spacing: Float64Array, pixel: number): Uint8Array {
  const ranks = new Uint8Array(maxClasses);
  let most = 0;
  for (let c = PathClass.cut; c < maxClasses; c++) {
    const px = spacing[c]! / pixel;
    if (px < room) ranks[c] = Math.min(30, Math.ceil(Math.log2(room / px)));
    most = Math.max(most, ranks[c]!);
  }
  ranks[PathClass.lead] = ranks[PathClass.link] = most;
  return ranks;
}
