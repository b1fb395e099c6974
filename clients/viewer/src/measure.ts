// Measures between two picked points.
import { mm } from "./picked";
import type { Point3 } from "./scene";

export interface Distance {
  length: number; // mm
  delta: Point3;
}

export function distanceOf(a: Point3, b: Point3): Distance {
  const delta: Point3 = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  return { length: Math.hypot(...delta), delta };
}

export class Measure {
  points: Point3[] = [];

  // A third point begins anew.
  add(point: Point3): void {
    this.points = this.points.length >= 2 ? [point] : [...this.points, point];
  }

  clear(): void {
    this.points = [];
  }

  get distance(): Distance | null {
    const [a, b] = this.points;
    return a === undefined || b === undefined ? null : distanceOf(a, b);
  }

  get label(): string {
    return this.distance === null ? "" : `${mm(this.distance.length)} mm`;
  }

  get rows(): [string, string][] {
    const rows = this.points.map((p, i) => [`Point ${i + 1}`, p.map((v) => mm(v)).join("  ")] as [string, string]);
    const { distance } = this;
    if (distance === null) return rows;
    const [dx, dy, dz] = distance.delta;
    return [...rows, ["Distance", this.label], ["dX", `${mm(dx)} mm`], ["dY", `${mm(dy)} mm`], ["dZ", `${mm(dz)} mm`]];
  }
}
