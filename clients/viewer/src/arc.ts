// Points of arcs. An arc turns about the third axis of its plane, along which it moves in proportion.
import type { Arcs } from "./scene";

// First, second and third axis of G17, G18 and G19, each right-handed.
const planeAxes = [
  [0, 1, 2],
  [0, 1, 2],
  [2, 0, 1],
  [1, 2, 0],
] as const;

type Numbers = ArrayLike<number>;

// Writes into `out` the point at `share` (0 to 1) of the arc `a` from `start` to `end`. Ends whose distances to the centre
// differ by a rounding are joined by a radius that changes in proportion, so that the arc ends in `end`.
export function arcPoint(arcs: Arcs, a: number, start: Numbers, end: Numbers, share: number, out: number[]): void {
  const [first, second, third] = planeAxes[arcs.plane[a]!]!;
  const c1 = arcs.center[3 * a + first]!;
  const c2 = arcs.center[3 * a + second]!;
  const u = start[first]! - c1;
  const v = start[second]! - c2;
  const angle = 2 * Math.PI * arcs.turns[a]! * share;
  const cos = Math.cos(angle);
  const sin = Math.sin(angle);
  const whole = 2 * Math.PI * arcs.turns[a]!;
  // What is missing at the end is spread along the arc.
  const miss1 = end[first]! - (c1 + u * Math.cos(whole) - v * Math.sin(whole));
  const miss2 = end[second]! - (c2 + u * Math.sin(whole) + v * Math.cos(whole));
  out[first] = c1 + u * cos - v * sin + miss1 * share;
  out[second] = c2 + u * sin + v * cos + miss2 * share;
  out[third] = start[third]! + (end[third]! - start[third]!) * share;
}

export function arcRadius(arcs: Arcs, a: number, start: Numbers): number {
  const [first, second] = planeAxes[arcs.plane[a]!]!;
  return Math.hypot(start[first]! - arcs.center[3 * a + first]!, start[second]! - arcs.center[3 * a + second]!);
}

// The number of chords of equal length that stay within `chord` (mm) of an arc.
export function arcChords(radius: number, turns: number, chord: number): number {
  if (!(radius > chord)) return Math.max(1, Math.ceil(Math.abs(turns) * 4));
  const step = 2 * Math.acos(1 - chord / radius);
  return Math.min(720, Math.max(1, Math.ceil((2 * Math.PI * Math.abs(turns)) / step)));
}
