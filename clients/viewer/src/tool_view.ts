// Draws the tool: ball and flutes, shank, holder. Its origin is the tip of the ball.
import { BufferAttribute, BufferGeometry, Group, Mesh } from "three";
import type { Tool } from "./scene";
import { solidMaterial } from "./solid";
import type { SharedUniforms } from "./uniforms";

export type Profile = [number, number][]; // height above the tip, radius; from below

// The profiles of the parts of the tool. Without a stated flute length the flutes are as long as the ball is wide, and
// nothing but the colour tells them from the shank.
export function toolProfiles(tool: Tool): { flutes: Profile; shank: Profile; holder: Profile } {
  const radius = tool.ball_diameter / 2;
  const shank = tool.shank_diameter / 2;
  const fluteTop = Math.max(radius, tool.flute_length ?? tool.ball_diameter);
  const steps = 16;
  const flutes: Profile = Array.from({ length: steps + 1 }, (_, i) => {
    const angle = (i / steps) * (Math.PI / 2);
    return [radius * (1 - Math.cos(angle)), radius * Math.sin(angle)];
  });
  if (fluteTop > radius) flutes.push([fluteTop, radius]);
  const top = Math.max(fluteTop, tool.holder === null ? fluteTop + 4 * tool.shank_diameter : tool.holder.stickout);
  const holder: Profile = [];
  if (tool.holder !== null) {
    const [first] = tool.holder.profile;
    const last = tool.holder.profile[tool.holder.profile.length - 1]!;
    holder.push([tool.holder.stickout + first![0], 0]);
    for (const [height, r] of tool.holder.profile) holder.push([tool.holder.stickout + height, r]);
    holder.push([tool.holder.stickout + last[0], 0]);
  }
  return { flutes, shank: [[fluteTop, radius], [fluteTop, shank], [top, shank], [top, 0]], holder };
}

// Turns a profile about Z. Each piece has its own normals, so that steps look sharp; the ball is fine enough without.
function turned(profile: Profile): BufferGeometry {
  const sides = 40;
  const position: number[] = [];
  const normal: number[] = [];
  for (let i = 0; i + 1 < profile.length; i++) {
    const [z0, r0] = profile[i]!;
    const [z1, r1] = profile[i + 1]!;
    const size = Math.hypot(z1 - z0, r1 - r0) || 1;
    const out = (z1 - z0) / size;
    const up = -(r1 - r0) / size;
    const corner = (side: number, z: number, r: number): void => {
      const angle = (2 * Math.PI * side) / sides;
      position.push(r * Math.cos(angle), r * Math.sin(angle), z);
      normal.push(out * Math.cos(angle), out * Math.sin(angle), up);
    };
    for (let s = 0; s < sides; s++) {
      corner(s, z0, r0);
      corner(s + 1, z0, r0);
      corner(s + 1, z1, r1);
      corner(s, z0, r0);
      corner(s + 1, z1, r1);
      corner(s, z1, r1);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(position), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normal), 3));
  return geometry;
}

export class ToolView {
  readonly object = new Group();
  readonly cutter = new Group();
  readonly holder = new Group();

  constructor(tool: Tool, shared: SharedUniforms) {
    const { flutes, shank, holder } = toolProfiles(tool);
    const add = (group: Group, profile: Profile, color: string, opacity: number): void => {
      if (profile.length < 2) return;
      const mesh = new Mesh(turned(profile), solidMaterial(color, opacity, false, shared));
      mesh.frustumCulled = false;
      mesh.renderOrder = opacity < 1 ? 6 : 0;
      group.add(mesh);
    };
    add(this.cutter, flutes, "#d9a441", 1);
    add(this.cutter, shank, "#b9c0c8", 1);
    add(this.holder, holder, "#6f7a87", 0.55);
    this.object.add(this.cutter, this.holder);
  }
}
