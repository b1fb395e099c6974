// The program in machine time: when each move ends, which move runs at a time, and where the tip is.
import { arcPoint } from "./arc";
import type { Path } from "./scene";

export interface Place {
  move: number;
  share: number; // 0: the move begins, 1: it ends
}

// Sizes of moves in a path without times, so that the slider still runs: lengths at one feed.
function lengthsAsSeconds(tip: Float32Array): Float32Array {
  const seconds = new Float32Array(tip.length / 3);
  for (let m = 1; m < seconds.length; m++) {
    const i = 3 * m;
    seconds[m] = Math.hypot(tip[i]! - tip[i - 3]!, tip[i + 1]! - tip[i - 2]!, tip[i + 2]! - tip[i - 1]!) / 20;
  }
  return seconds;
}

export class Timeline {
  readonly path: Path;
  readonly moves: number;
  readonly end: Float64Array; // of each move, s
  readonly isKnown: boolean; // false: the path has no times, and lengths stand for them
  #start = [0, 0, 0];
  #end = [0, 0, 0];

  constructor(path: Path) {
    this.path = path;
    this.moves = path.kind.length;
    this.isKnown = path.seconds !== null;
    const seconds = path.seconds ?? lengthsAsSeconds(path.tip);
    this.end = new Float64Array(this.moves);
    let sum = 0;
    for (let m = 0; m < this.moves; m++) this.end[m] = sum += seconds[m]!;
  }

  get total(): number {
    return this.end[this.moves - 1]!;
  }

  // The move that runs at `time`: the first one that ends at that time or later.
  placeAt(time: number): Place {
    let low = 0;
    let high = this.moves - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.end[middle]! >= time) high = middle;
      else low = middle + 1;
    }
    const begin = low === 0 ? 0 : this.end[low - 1]!;
    const length = this.end[low]! - begin;
    return { move: low, share: length > 0 ? Math.min(1, Math.max(0, (time - begin) / length)) : 1 };
  }

  timeOf(place: Place): number {
    const begin = place.move === 0 ? 0 : this.end[place.move - 1]!;
    return begin + (this.end[place.move]! - begin) * place.share;
  }

  // The index of a move among the arcs, or -1 if it is straight.
  arcOf(move: number): number {
    const arcs = this.path.arcs;
    if (arcs === null) return -1;
    let low = 0;
    let high = arcs.move.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (arcs.move[middle]! < move) low = middle + 1;
      else high = middle;
    }
    return low < arcs.move.length && arcs.move[low] === move ? low : -1;
  }

  // Writes into `out` where the tip of the ball is.
  tipAt(place: Place, out: number[]): void {
    const { tip, arcs } = this.path;
    const from = 3 * Math.max(0, place.move - 1);
    const to = 3 * place.move;
    for (let k = 0; k < 3; k++) {
      this.#start[k] = tip[from + k]!;
      this.#end[k] = tip[to + k]!;
    }
    const arc = this.arcOf(place.move);
    if (arc >= 0 && arcs !== null) {
      arcPoint(arcs, arc, this.#start, this.#end, place.share, out);
      return;
    }
    for (let k = 0; k < 3; k++) out[k] = this.#start[k]! + (this.#end[k]! - this.#start[k]!) * place.share;
  }
}
