// What all materials share: the section plane and the colours of the theme.
import { Color, Vector4 } from "three";

export interface SharedUniforms {
  // Points with dot(plane.xyz, point) + plane.w < 0 are cut away; (0, 0, 0, 1) cuts nothing.
  plane: { value: Vector4 };
  background: { value: Color };
  isOrthographic: { value: number };
  pixel: { value: number }; // mm of a pixel: at a depth of 1 mm in perspective, everywhere in orthographic
}

export function makeUniforms(): SharedUniforms {
  return {
    plane: { value: new Vector4(0, 0, 0, 1) },
    background: { value: new Color(1, 1, 1) },
    isOrthographic: { value: 0 },
    pixel: { value: 1 },
  };
}

// Moves a point of a line towards the eye by `bias` pixels (and `lift` mm) in depth alone, so that lines on the surface are
// not lost in it.
export const biasedPosition = `
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float isOrthographic;
uniform float pixel;
vec4 biasedPosition(vec3 p, float bias, float lift) {
  vec4 v = modelViewMatrix * vec4(p, 1.0);
  vec4 clip = projectionMatrix * v;
  float size = isOrthographic > 0.5 ? pixel : pixel * max(-v.z, 0.0);
  float step = min(bias * size + lift, isOrthographic > 0.5 ? 1e30 : 0.5 * max(-v.z, 0.0));
  vec4 nearer = projectionMatrix * vec4(v.xy, v.z + step, 1.0);
  clip.z = nearer.z / nearer.w * clip.w;
  return clip;
}
`;

// How bright a surface is: a lamp at the eye, and one behind the left shoulder. Both sides of the surface are lit alike.
export const light = `
uniform float isOrthographic;
float light(vec3 normal, vec3 view) {
  vec3 n = normalize(normal);
  vec3 toEye = isOrthographic > 0.5 ? vec3(0.0, 0.0, 1.0) : normalize(-view);
  if (dot(n, toEye) < 0.0) n = -n;
  return 0.46 + 0.36 * dot(n, toEye) + 0.24 * max(0.0, dot(n, normalize(vec3(-0.45, 0.75, 0.5))));
}
`;

// Colours as three.js would not change them: the shaders write what the style sheet means.
export function plainColor(css: string): Color {
  const v = parseInt(css.slice(1), 16);
  return new Color().setRGB((v >> 16) / 255, ((v >> 8) & 255) / 255, (v & 255) / 255, "srgb-linear");
}
