// A tree of boxes over a sequence of items that lie near their neighbours, as moves do. It needs no sorting: a node covers
// a run of items, and its halves are its children.

export interface Boxes {
  // Six numbers of each leaf: the least and the greatest x, y and z.
  readonly values: Float32Array;
  readonly leaves: number;
}

export class BoxTree {
  readonly leaves: number;
  readonly #size: number; // leaves, rounded up to a power of two
  readonly #boxes: Float32Array; // node 1 is the root; the children of n are 2 n and 2 n + 1

  constructor(leaf: Boxes) {
    this.leaves = leaf.leaves;
    let size = 1;
    while (size < leaf.leaves) size *= 2;
    this.#size = size;
    const boxes = new Float32Array(12 * size);
    for (let n = 0; n < 2 * size; n++) {
      boxes.fill(Infinity, 6 * n, 6 * n + 3);
      boxes.fill(-Infinity, 6 * n + 3, 6 * n + 6);
    }
    boxes.set(leaf.values.subarray(0, 6 * leaf.leaves), 6 * size);
    for (let n = size - 1; n >= 1; n--) {
      for (let k = 0; k < 3; k++) {
        boxes[6 * n + k] = Math.min(boxes[12 * n + k]!, boxes[12 * n + 6 + k]!);
        boxes[6 * n + 3 + k] = Math.max(boxes[12 * n + 3 + k]!, boxes[12 * n + 9 + k]!);
      }
    }
    this.#boxes = boxes;
  }

  // Calls `visit` with each leaf whose box, and those of the nodes above it, pass `reach`. The child with the smaller
  // value of `reach` comes first; Infinity leaves the node out.
  walk(reach: (boxes: Float32Array, at: number) => number, visit: (leaf: number) => void): void {
    const stack = [1];
    while (stack.length > 0) {
      const node = stack.pop()!;
      if (reach(this.#boxes, 6 * node) === Infinity) continue;
      if (node >= this.#size) {
        if (node - this.#size < this.leaves) visit(node - this.#size);
        continue;
      }
      const left = reach(this.#boxes, 12 * node);
      const right = reach(this.#boxes, 12 * node + 6);
      if (left <= right) {
        if (right !== Infinity) stack.push(2 * node + 1);
        if (left !== Infinity) stack.push(2 * node);
      } else {
        if (left !== Infinity) stack.push(2 * node);
        stack.push(2 * node + 1);
      }
    }
  }
}

// The box of `count` points from point `first` on, written at `at`; a box of none is empty.
export function boxOfPoints(position: Float32Array, first: number, count: number, out: Float32Array, at: number): void {
  for (let k = 0; k < 3; k++) {
    let low = Infinity;
    let high = -Infinity;
    for (let i = 3 * first + k; i < 3 * (first + count); i += 3) {
      const v = position[i]!;
      if (v < low) low = v;
      if (v > high) high = v;
    }
    out[at + k] = low;
    out[at + 3 + k] = high;
  }
}

export interface Ray {
  origin: number[];
  direction: number[]; // unit
}

// How far along the ray a box, grown by `grow` on all sides, begins; Infinity if the ray misses it.
export function rayBox(ray: Ray, boxes: Float32Array, at: number, grow: number): number {
  let near = -Infinity;
  let far = Infinity;
  for (let k = 0; k < 3; k++) {
    const o = ray.origin[k]!;
    const d = ray.direction[k]!;
    const low = boxes[at + k]! - grow - o;
    const high = boxes[at + 3 + k]! + grow - o;
    if (low > high) return Infinity;
    if (d === 0) {
      if (low > 0 || high < 0) return Infinity;
      continue;
    }
    const a = low / d;
    const b = high / d;
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far ? near : Infinity;
}
