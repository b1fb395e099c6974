// Contact points of the ball: where the surface is nearest to its centre.
import { BoxTree } from "./box_tree";
import { MeshPicker } from "./mesh_pick";
import { PathClass, type PathVertices } from "./path_vertices";

type Point = [number, number, number];

// The point of a triangle nearest to p, after Ericson, Real-Time Collision Detection, 5.1.5.
export function nearestOnTriangle(p: Point, a: Point, b: Point, c: Point): Point {
  const sub = (u: Point, v: Point): Point => [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
  const dot = (u: Point, v: Point): number => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const along = (u: Point, d: Point, t: number): Point => [u[0] + t * d[0], u[1] + t * d[1], u[2] + t * d[2]];
  const ab = sub(b, a);
  const ac = sub(c, a);
  const ap = sub(p, a);
  const d1 = dot(ab, ap);
  const d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = sub(p, b);
  const d3 = dot(ab, bp);
  const d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return along(a, ab, d1 - d3 > 0 ? d1 / (d1 - d3) : 0);
  const cp = sub(p, c);
  const d5 = dot(ab, cp);
  const d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return along(a, ac, d2 - d6 > 0 ? d2 / (d2 - d6) : 0);
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const sum = d4 - d3 + (d5 - d6);
    return along(b, sub(c, b), sum > 0 ? (d4 - d3) / sum : 0);
  }
  const sum = va + vb + vc;
  return sum > 0 ? along(along(a, ab, vb / sum), ac, vc / sum) : a;
}

// Finds the nearest point of the surface to one point after another; neighbours in the order are fast.
export class NearestPoint {
  readonly #picker: MeshPicker;
  readonly #tree: BoxTree;
  #last = 0; // triangle

  constructor(picker: MeshPicker) {
    this.#picker = picker;
    this.#tree = picker.tree;
  }

  // Writes the nearest point within `limit` (mm) into `out` and returns whether there is one.
  find(p: Point, limit: number, out: number[]): boolean {
    let best = limit * limit;
    let isFound = false;
    const test = (triangle: number): void => {
      const [a, b, c] = this.#picker.corners(triangle);
      const q = nearestOnTriangle(p, a, b, c);
      const d = (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2 + (q[2] - p[2]) ** 2;
      if (d > best || (isFound && d === best)) return;
      best = d;
      isFound = true;
      this.#last = triangle;
      out[0] = q[0];
      out[1] = q[1];
      out[2] = q[2];
    };
    test(this.#last);
    this.#tree.walk(
      (boxes, at) => {
        let d = 0;
        for (let k = 0; k < 3; k++) {
          const v = p[k]!;
          const off = Math.max(boxes[at + k]! - v, 0, v - boxes[at + 3 + k]!);
          d += off * off;
        }
        return d < best ? d : Infinity;
      },
      (leaf) => this.#picker.trianglesOf(leaf).forEach(test),
    );
    return isFound;
  }
}

// The path with its cuts at their contact points. A cut whose ball is far from the surface stays at its tip. The work is
// done in slices, so that the page stays alive; `onProgress` gets the share that is done.
export async function contactVertices(
  vertices: PathVertices,
  picker: MeshPicker,
  radius: number,
  onProgress: (share: number) => void,
): Promise<PathVertices> {
  const position = vertices.position.slice();
  const nearest = new NearestPoint(picker);
  const found = [0, 0, 0];
  let slice = performance.now();
  for (let v = 0; v < vertices.class.length; v++) {
    if (vertices.class[v]! >= PathClass.cut) {
      const center: Point = [position[3 * v]!, position[3 * v + 1]!, position[3 * v + 2]! + radius];
      if (nearest.find(center, 1.5 * radius, found)) position.set(found, 3 * v);
    }
    if (v % 256 === 0 && performance.now() - slice > 24) {
      onProgress(v / vertices.class.length);
      await new Promise((resolve) => setTimeout(resolve));
      slice = performance.now();
    }
  }
  return { ...vertices, position };
}
