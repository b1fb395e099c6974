// Where one looks from: a target, two angles and the height that the picture shows, in perspective or orthographic.
import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import type { Ray } from "./box_tree";

const fieldOfView = 30; // degrees, from the lower to the upper edge

export const standardViews = {
  top: [-90, 90],
  front: [-90, 0],
  right: [0, 0],
  left: [180, 0],
  back: [90, 0],
  iso: [-60, 35.264],
} as const;
export type StandardView = keyof typeof standardViews;

export class Camera {
  readonly target = new Vector3();
  yaw = -60; // degrees, of the direction from the target to the eye, about Z from +X
  pitch = 35.264; // degrees above the XY plane, [-90, 90]
  height = 100; // mm that the picture shows at the target, from the lower to the upper edge
  isOrthographic = false;
  width = 1; // of the picture, px
  heightPx = 1;

  readonly #perspective = new PerspectiveCamera(fieldOfView);
  readonly #orthographic = new OrthographicCamera();
  #center = new Vector3(); // of the sphere around all that is drawn
  #radius = 1;
  readonly right = new Vector3();
  readonly up = new Vector3();
  readonly back = new Vector3(); // from the target to the eye
  readonly eye = new Vector3();

  constructor() {
    this.#perspective.matrixAutoUpdate = false;
    this.#orthographic.matrixAutoUpdate = false;
  }

  setScene(center: Vector3, radius: number): void {
    this.#center = center.clone();
    this.#radius = Math.max(radius, 1e-3);
  }

  get distance(): number {
    return this.height / 2 / Math.tan(((fieldOfView / 2) * Math.PI) / 180);
  }

  // Updates and returns the camera of three.js.
  update(): PerspectiveCamera | OrthographicCamera {
    const yaw = (this.yaw * Math.PI) / 180;
    const pitch = (this.pitch * Math.PI) / 180;
    this.back.set(Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch));
    this.right.set(-Math.sin(yaw), Math.cos(yaw), 0);
    this.up.crossVectors(this.back, this.right);
    this.eye.copy(this.target).addScaledVector(this.back, this.distance);
    // Depths that hold all that is drawn, so that the depth buffer is used well.
    const depth = this.eye.clone().sub(this.#center).dot(this.back);
    const far = Math.max(depth + this.#radius, this.distance * 0.01);
    const near = depth - this.#radius;
    const aspect = this.width / this.heightPx;
    const camera = this.isOrthographic ? this.#orthographic : this.#perspective;
    if (camera instanceof PerspectiveCamera) {
      camera.near = Math.max(near, far * 1e-3, this.distance * 1e-3);
      camera.far = far;
      camera.aspect = aspect;
    } else {
      camera.near = near;
      camera.far = far;
      camera.top = this.height / 2;
      camera.bottom = -this.height / 2;
      camera.right = (this.height / 2) * aspect;
      camera.left = -camera.right;
    }
    camera.matrix.copy(new Matrix4().makeBasis(this.right, this.up, this.back)).setPosition(this.eye);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
    return camera;
  }

  // The size of a pixel (mm) at a distance from the eye along the view.
  pixelAtDepth(depth: number): number {
    return (this.height / this.heightPx) * (this.isOrthographic ? 1 : depth / this.distance);
  }

  // The ray through a pixel; its origin is the eye, or a point of the eye's plane in front of all that is drawn.
  rayAt(x: number, y: number): Ray {
    this.update();
    const pixel = this.height / this.heightPx;
    const across = (x - this.width / 2) * pixel;
    const upward = (this.heightPx / 2 - y) * pixel;
    const at = this.target.clone().addScaledVector(this.right, across).addScaledVector(this.up, upward);
    if (this.isOrthographic) {
      const origin = at.addScaledVector(this.back, this.distance + 2 * this.#radius);
      return { origin: origin.toArray(), direction: this.back.clone().negate().toArray() };
    }
    return { origin: this.eye.toArray(), direction: at.sub(this.eye).normalize().toArray() };
  }

  // The pixel of a point, and its depth in front of the eye (mm).
  project(point: ArrayLike<number>): { x: number; y: number; depth: number } {
    this.update();
    return this.projectNow(point[0]!, point[1]!, point[2]!);
  }

  // The same for many points: update() has to come first.
  projectNow(x: number, y: number, z: number): { x: number; y: number; depth: number } {
    const { eye, back, right, up } = this;
    const [vx, vy, vz] = [x - eye.x, y - eye.y, z - eye.z];
    const depth = -(vx * back.x + vy * back.y + vz * back.z);
    const pixel = this.pixelAtDepth(Math.max(depth, 1e-9));
    return {
      x: this.width / 2 + (vx * right.x + vy * right.y + vz * right.z) / pixel,
      y: this.heightPx / 2 - (vx * up.x + vy * up.y + vz * up.z) / pixel,
      depth,
    };
  }

  orbit(yaw: number, pitch: number): void {
    this.yaw = (((this.yaw + yaw + 180) % 360) + 360) % 360 - 180;
    this.pitch = Math.min(90, Math.max(-90, this.pitch + pitch));
  }

  // Moves the picture by pixels.
  pan(x: number, y: number): void {
    this.update();
    const pixel = this.height / this.heightPx;
    this.target.addScaledVector(this.right, -x * pixel).addScaledVector(this.up, y * pixel);
  }

  // Zooms by `factor` (above 1: nearer); what is under the pixel stays there.
  zoom(factor: number, x = this.width / 2, y = this.heightPx / 2): void {
    const height = Math.min(this.#radius * 40, Math.max(this.#radius * 1e-4, this.height / factor));
    const moved = (1 - height / this.height) * (this.height / this.heightPx);
    this.update();
    this.target
      .addScaledVector(this.right, (x - this.width / 2) * moved)
      .addScaledVector(this.up, (this.heightPx / 2 - y) * moved);
    this.height = height;
  }

  look(view: StandardView): void {
    [this.yaw, this.pitch] = standardViews[view];
  }

  // Shows a box as large as it fits.
  fit(min: ArrayLike<number>, max: ArrayLike<number>): void {
    this.target.set((min[0]! + max[0]!) / 2, (min[1]! + max[1]!) / 2, (min[2]! + max[2]!) / 2);
    this.update();
    // A corner that is d nearer than the target is seen as if it were d tan(half the angle) farther from the middle.
    const slant = this.isOrthographic ? 0 : Math.tan(((fieldOfView / 2) * Math.PI) / 180);
    let half = 1e-3;
    for (let corner = 0; corner < 8; corner++) {
      const v = new Vector3(
        (corner & 1 ? max : min)[0],
        (corner & 2 ? max : min)[1],
        (corner & 4 ? max : min)[2],
      ).sub(this.target);
      const across = (Math.abs(v.dot(this.right)) * this.heightPx) / this.width;
      half = Math.max(half, Math.max(across, Math.abs(v.dot(this.up))) + slant * v.dot(this.back));
    }
    this.height = 2 * 1.08 * half;
  }
}
