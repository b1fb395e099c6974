// Draws every second, fourth, ... pass where all of them would cover the part.
import { maxClasses, PathClass, type PathVertices, segmentLength } from "./path_vertices";
import { Kind, type Mesh, type Path } from "./scene";

const room = 3; // px between passes
export const always = 255;

// The rank of each vertex: passes with rank k or more are each 2^k-th one. Leads and links have the rank of the pass that
// they lead to, all other moves are always drawn.
export function passRanks(path: Path, vertices: PathVertices): Uint8Array {
  const ranks = new Uint8Array(vertices.class.length).fill(always);
  if (path.pass === null) return ranks;
  const seen = new Uint32Array(maxClasses); // passes of each class
  let rank = always;
  let last = -1;
  const moveOf = (v: number): number => (vertices.move === null ? v : vertices.move[v]!);
  let firstOfRun = 1;
  for (let v = 1; v < ranks.length; v++) {
    const move = moveOf(v);
    const c = vertices.class[v]!;
    if (path.kind[move] === Kind.cut) {
      const pass = path.pass[move]!;
      if (pass !== last) {
        const n = seen[c]!++;
        rank = n === 0 ? always - 1 : Math.clz32(n & -n) ^ 31;
        last = pass;
        for (let w = firstOfRun; w < v; w++) if (isJoint(vertices.class[w]!)) ranks[w] = rank;
      }
      ranks[v] = rank;
      firstOfRun = v + 1;
    }
  }
  return ranks;
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
