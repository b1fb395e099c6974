// Finds the triangle under a pixel.
import { BoxTree, type Ray, rayBox } from "./box_tree";
import type { Mesh } from "./scene";

export interface MeshHit {
  triangle: number;
  weights: [number, number, number]; // of its corners
  distance: number; // along the ray, mm
  point: [number, number, number];
}

type Corner = [number, number, number];

const leafSize = 8;

// Spreads ten bits: between two of them are two zeros.
function spread(v: number): number {
  v = (v | (v << 16)) & 0x030000ff;
  v = (v | (v << 8)) & 0x0300f00f;
  v = (v | (v << 4)) & 0x030c30c3;
  return (v | (v << 2)) & 0x09249249;
}

// Triangles along a Morton curve, so that neighbours in the order are near each other.
function mortonOrder(mesh: Mesh): Uint32Array {
  const count = mesh.index.length / 3;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < mesh.position.length; i++) {
    low[i % 3] = Math.min(low[i % 3]!, mesh.position[i]!);
    high[i % 3] = Math.max(high[i % 3]!, mesh.position[i]!);
  }
  const size = Math.max(high[0]! - low[0]!, high[1]! - low[1]!, high[2]! - low[2]!, 1e-30);
  const keys = new Float64Array(count); // the code, then the triangle: both fit a double
  for (let t = 0; t < count; t++) {
    let code = 0;
    for (let k = 0; k < 3; k++) {
      const sum =
        mesh.position[3 * mesh.index[3 * t]! + k]! +
        mesh.position[3 * mesh.index[3 * t + 1]! + k]! +
        mesh.position[3 * mesh.index[3 * t + 2]! + k]!;
      code |= spread(Math.min(1023, Math.floor(((sum / 3 - low[k]!) / size) * 1024))) << k;
    }
    keys[t] = code * 2 ** 22 + t;
    if (count > 2 ** 22) keys[t] = code * 2 ** 23 + t;
  }
  keys.sort();
  const base = count > 2 ** 22 ? 2 ** 23 : 2 ** 22;
  return Uint32Array.from(keys, (key) => key % base);
}

export class MeshPicker {
  readonly #mesh: Mesh;
  readonly #order: Uint32Array;
  readonly tree: BoxTree; // its leaves are runs of eight triangles

  constructor(mesh: Mesh) {
    this.#mesh = mesh;
    this.#order = mortonOrder(mesh);
    const leaves = Math.ceil(this.#order.length / leafSize);
    const values = new Float32Array(6 * leaves);
    for (let leaf = 0; leaf < leaves; leaf++) {
      values.fill(Infinity, 6 * leaf, 6 * leaf + 3);
      values.fill(-Infinity, 6 * leaf + 3, 6 * leaf + 6);
      for (let i = leaf * leafSize; i < Math.min(this.#order.length, (leaf + 1) * leafSize); i++) {
        for (let corner = 0; corner < 3; corner++) {
          const v = 3 * mesh.index[3 * this.#order[i]! + corner]!;
          for (let k = 0; k < 3; k++) {
            values[6 * leaf + k] = Math.min(values[6 * leaf + k]!, mesh.position[v + k]!);
            values[6 * leaf + 3 + k] = Math.max(values[6 * leaf + 3 + k]!, mesh.position[v + k]!);
          }
        }
      }
    }
    this.tree = new BoxTree({ values, leaves });
  }

  // The first triangle along the ray whose hit `isShown` accepts (the section plane hides some).
  pick(ray: Ray, isShown: (point: number[]) => boolean): MeshHit | null {
    let best: MeshHit | null = null;
    let nearest = Infinity;
    this.tree.walk(
      (boxes, at) => {
        const near = rayBox(ray, boxes, at, 1e-6);
        return near <= nearest ? near : Infinity;
      },
      (leaf) => {
        const end = Math.min(this.#order.length, (leaf + 1) * leafSize);
        for (let i = leaf * leafSize; i < end; i++) {
          const hit = this.#hit(ray, this.#order[i]!);
          if (hit !== null && hit.distance < nearest && isShown(hit.point)) {
            nearest = hit.distance;
            best = hit;
          }
        }
      },
    );
    return best;
  }

  trianglesOf(leaf: number): Uint32Array {
    return this.#order.subarray(leaf * leafSize, (leaf + 1) * leafSize);
  }

  corners(triangle: number): [Corner, Corner, Corner] {
    const { index, position: p } = this.#mesh;
    return [0, 1, 2].map((k) => {
      const v = 3 * index[3 * triangle + k]!;
      return [p[v]!, p[v + 1]!, p[v + 2]!];
    }) as [Corner, Corner, Corner];
  }

  // Moeller and Trumbore's test of a ray and a triangle, from both sides.
  #hit(ray: Ray, triangle: number): MeshHit | null {
    const { index, position } = this.#mesh;
    const a = 3 * index[3 * triangle]!;
    const b = 3 * index[3 * triangle + 1]!;
    const c = 3 * index[3 * triangle + 2]!;
    const [dx, dy, dz] = ray.direction as [number, number, number];
    const e1x = position[b]! - position[a]!;
    const e1y = position[b + 1]! - position[a + 1]!;
    const e1z = position[b + 2]! - position[a + 2]!;
    const e2x = position[c]! - position[a]!;
    const e2y = position[c + 1]! - position[a + 1]!;
    const e2z = position[c + 2]! - position[a + 2]!;
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const det = e1x * px + e1y * py + e1z * pz;
    if (det === 0) return null;
    const tx = ray.origin[0]! - position[a]!;
    const ty = ray.origin[1]! - position[a + 1]!;
    const tz = ray.origin[2]! - position[a + 2]!;
    const u = (tx * px + ty * py + tz * pz) / det;
    const slack = 1e-9;
    if (u < -slack || u > 1 + slack) return null;
    const qx = ty * e1z - tz * e1y;
    const qy = tz * e1x - tx * e1z;
    const qz = tx * e1y - ty * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < -slack || u + v > 1 + slack) return null;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / det;
    if (distance <= 0) return null;
    return {
      triangle,
      weights: [1 - u - v, u, v],
      distance,
      point: [ray.origin[0]! + dx * distance, ray.origin[1]! + dy * distance, ray.origin[2]! + dz * distance],
    };
  }
}

// The value of a vertex array at a hit; null where it is not known.
export function valueAt(mesh: Mesh, values: Float32Array | null, hit: MeshHit): number | null {
  if (values === null) return null;
  let sum = 0;
  for (let k = 0; k < 3; k++) sum += hit.weights[k]! * values[mesh.index[3 * hit.triangle + k]!]!;
  return Number.isNaN(sum) ? null : sum;
}
