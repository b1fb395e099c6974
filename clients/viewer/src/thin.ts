// Thins a polyline for drawing: levels with fewer and fewer of its vertices, each within a stated distance of all of them.

export interface Level {
  tolerance: number; // mm: no vertex is farther from the level than this
  kept: Uint32Array; // rising; the first and the last vertex are always there
}

function distanceToSegment(p: Float32Array, a: number, b: number, c: number): number {
  const ax = p[3 * a]!;
  const ay = p[3 * a + 1]!;
  const az = p[3 * a + 2]!;
  const ux = p[3 * c]! - ax;
  const uy = p[3 * c + 1]! - ay;
  const uz = p[3 * c + 2]! - az;
  const vx = p[3 * b]! - ax;
  const vy = p[3 * b + 1]! - ay;
  const vz = p[3 * b + 2]! - az;
  const uu = ux * ux + uy * uy + uz * uz;
  const t = uu > 0 ? Math.min(1, Math.max(0, (ux * vx + uy * vy + uz * vz) / uu)) : 0;
  const x = vx - t * ux;
  const y = vy - t * uy;
  const z = vz - t * uz;
  return Math.sqrt(x * x + y * y + z * z); // Math.hypot takes ten times as long
}

function squaredLength(p: Float32Array, a: number, b: number): number {
  const x = p[3 * b]! - p[3 * a]!;
  const y = p[3 * b + 1]! - p[3 * a + 1]!;
  const z = p[3 * b + 2]! - p[3 * a + 2]!;
  return x * x + y * y + z * z;
}

// Thins `position` to each of the rising `tolerances` (mm). Vertex b between a and c goes if the segment ac is near enough:
// what ab and bc left out is at most max(error ab, error bc) from them, and they are at most distance(b, ac) from ac.
// So the error of ac is at most the sum of both. The vertices `stays` (not 0) stay, and so do changes of class, unless the pieces on
// both sides are shorter than the tolerance.
export function thin(position: Float32Array, classes: Uint8Array, stays: Uint8Array, tolerances: number[]): Level[] {
  const size = classes.length;
  let kept: Uint32Array | null = null; // null: all
  let error = new Float32Array(size); // of the segment that ends in a kept vertex
  let count = size;
  const levels: Level[] = [];
  for (const tolerance of tolerances) {
    const shortest = tolerance * tolerance;
    for (let sweep = 0; sweep < 24; sweep++) {
      const next: Uint32Array<ArrayBuffer> = new Uint32Array(count);
      const nextError = new Float32Array(count);
      let to = 1;
      let a = 0;
      let i = 1;
      for (; i + 1 < count; i++) {
        const b: number = kept === null ? i : kept[i]!;
        const c: number = kept === null ? i + 1 : kept[i + 1]!;
        let drop = stays[b] === 0;
        if (drop && classes[b] !== classes[c]) {
          drop = squaredLength(position, a, b) <= shortest && squaredLength(position, b, c) <= shortest;
        }
        if (drop) {
          const e = Math.max(error[i]!, error[i + 1]!) + distanceToSegment(position, a, b, c);
          if (e <= tolerance) {
            next[to] = c;
            nextError[to++] = e;
            a = c;
            i++;
            continue;
          }
        }
        next[to] = b;
        nextError[to++] = error[i]!;
        a = b;
      }
      if (i < count) {
        next[to] = kept === null ? i : kept[i]!;
        nextError[to++] = error[i]!;
      }
      if (to > count) to = count;
      const gain = count - to;
      kept = next.subarray(0, to);
      error = nextError;
      count = to;
      if (gain < 0.05 * count) break;
    }
    levels.push({ tolerance, kept: kept!.slice() });
  }
  return levels;
}
