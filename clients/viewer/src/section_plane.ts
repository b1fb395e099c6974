// The section plane: it hides what lies on one side of it.
import { BufferAttribute, BufferGeometry, LineLoop, type Vector4 } from "three";
import type { Point3 } from "./scene";
import { lineMaterial } from "./solid";
import { plainColor, type SharedUniforms } from "./uniforms";

export type Axis = "x" | "y" | "z";

export interface SectionPlane {
  axis: Axis | null;
  position: number; // mm
  isFlipped: boolean; // false: what lies above the position is hidden
  cutsPath: boolean;
}

const axes: Axis[] = ["x", "y", "z"];

export function setPlane(section: SectionPlane, out: Vector4): void {
  if (section.axis === null) {
    out.set(0, 0, 0, 1);
    return;
  }
  const sign = section.isFlipped ? 1 : -1;
  out.set(0, 0, 0, -sign * section.position);
  out.setComponent(axes.indexOf(section.axis), sign);
}

export function isKept(plane: Vector4, point: ArrayLike<number>): boolean {
  return plane.x * point[0]! + plane.y * point[1]! + plane.z * point[2]! + plane.w >= 0;
}

// The frame in which the plane cuts the box of the scene.
export class SectionFrame {
  readonly object: LineLoop;
  readonly #corner = new Float32Array(12);

  constructor(color: string, shared: SharedUniforms) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.#corner, 3));
    this.object = new LineLoop(geometry, lineMaterial({ color, bias: 0, lift: 0, isCut: false }, shared));
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  place(section: SectionPlane, min: Point3, max: Point3): void {
    this.object.visible = section.axis !== null;
    if (section.axis === null) return;
    const k = axes.indexOf(section.axis);
    const [u, v] = [(k + 1) % 3, (k + 2) % 3];
    [[0, 0], [1, 0], [1, 1], [0, 1]].forEach(([a, b], i) => {
      this.#corner[3 * i + k] = section.position;
      this.#corner[3 * i + u] = (a ? max : min)[u]!;
      this.#corner[3 * i + v] = (b ? max : min)[v]!;
    });
    this.object.geometry.getAttribute("position").needsUpdate = true;
  }

  setColor(color: string): void {
    (this.object.material as ReturnType<typeof lineMaterial>).uniforms.base!.value = plainColor(color);
  }
}
