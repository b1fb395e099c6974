// Finds the move under a pixel.
import { BoxTree, boxOfPoints, type Ray, rayBox } from "./box_tree";
import type { PathVertices } from "./path_vertices";
import type { Place } from "./timeline";

export interface PathHit extends Place {
  distance: number; // along the ray, mm
  offset: number; // from the ray to the path, in pixels
  point: [number, number, number];
}

const leafSize = 16; // segments

export class PathPicker {
  readonly #vertices: PathVertices;
  readonly #tree: BoxTree;

  constructor(vertices: PathVertices) {
    this.#vertices = vertices;
    const segments = vertices.class.length - 1;
    const leaves = Math.max(1, Math.ceil(segments / leafSize));
    const values = new Float32Array(6 * leaves);
    for (let leaf = 0; leaf < leaves; leaf++) {
      const first = leaf * leafSize;
      boxOfPoints(vertices.position, first, Math.min(leafSize, segments - first) + 1, values, 6 * leaf);
    }
    this.#tree = new BoxTree({ values, leaves });
  }

  // The segment that is nearest to the ray, within `pixels`. `pixelAt` is the size of a pixel (mm) at a distance along the
  // ray, `isShown` tells whether the segment that ends in a vertex can be seen at a point. Segments beyond `limit` (mm
  // along the ray) are hidden. Among segments within two pixels of each other the one in front is taken.
  pick(
    ray: Ray,
    pixels: number,
    pixelAt: (distance: number) => number,
    isShown: (vertex: number, point: number[]) => boolean,
    limit: number,
  ): PathHit | null {
    const { position } = this.#vertices;
    const segments = this.#vertices.class.length - 1;
    let best: PathHit | null = null;
    let score = Infinity;
    this.#tree.walk(
      (boxes, at) => {
        // The farthest corner of the box has the largest pixels.
        let far = 0;
        for (let k = 0; k < 3; k++) {
          const d = ray.direction[k]!;
          far += d * ((d > 0 ? boxes[at + 3 + k]! : boxes[at + k]!) - ray.origin[k]!);
        }
        if (!(far > 0)) return Infinity;
        const near = rayBox(ray, boxes, at, pixels * pixelAt(far));
        return near <= limit ? near : Infinity;
      },
      (leaf) => {
        const end = Math.min(segments, (leaf + 1) * leafSize);
        for (let s = leaf * leafSize; s < end; s++) {
          const near = nearestOnSegment(ray, position, s);
          if (near.distance <= 0 || near.distance > limit) continue;
          const offset = near.gap / pixelAt(near.distance);
          if (offset > pixels || !isShown(s + 1, near.point)) continue;
          const value = Math.round(offset / 2) * 1e6 + near.distance;
          if (value >= score) continue;
          score = value;
          best = { ...this.#placeOf(s, near.share), distance: near.distance, offset, point: near.point };
        }
      },
    );
    return best;
  }

  #placeOf(segment: number, along: number): Place {
    const { move, share } = this.#vertices;
    if (move === null || share === null) return { move: segment + 1, share: along };
    const end = share[segment + 1]!;
    const begin = move[segment] === move[segment + 1] ? share[segment]! : 0;
    return { move: move[segment + 1]!, share: begin + (end - begin) * along };
  }
}

interface Near {
  share: number;
  distance: number;
  gap: number; // mm
  point: [number, number, number];
}

// The point of segment s (from vertex s to s + 1) nearest to the line of the ray.
function nearestOnSegment(ray: Ray, p: Float32Array, s: number): Near {
  const [dx, dy, dz] = ray.direction as [number, number, number];
  const i = 3 * s;
  const ux = p[i + 3]! - p[i]!;
  const uy = p[i + 4]! - p[i + 1]!;
  const uz = p[i + 5]! - p[i + 2]!;
  const wx = p[i]! - ray.origin[0]!;
  const wy = p[i + 1]! - ray.origin[1]!;
  const wz = p[i + 2]! - ray.origin[2]!;
  // Both without their part along the ray: the nearest point of the projected segment to the origin.
  const ud = ux * dx + uy * dy + uz * dz;
  const wd = wx * dx + wy * dy + wz * dz;
  const ax = ux - ud * dx;
  const ay = uy - ud * dy;
  const az = uz - ud * dz;
  const bx = wx - wd * dx;
  const by = wy - wd * dy;
  const bz = wz - wd * dz;
  const aa = ax * ax + ay * ay + az * az;
  const share = aa > 0 ? Math.min(1, Math.max(0, -(ax * bx + ay * by + az * bz) / aa)) : 0;
  return {
    share,
    distance: wd + share * ud,
    gap: Math.sqrt((bx + share * ax) ** 2 + (by + share * ay) ** 2 + (bz + share * az) ** 2),
    point: [p[i]! + share * ux, p[i + 1]! + share * uy, p[i + 2]! + share * uz],
  };
}
