/** How points and meshes are coloured: one light at the eye, own colours, a plain one, or the error map. */

import { Color, DoubleSide, NormalBlending, ShaderMaterial, type IUniform } from "three";
import { ERROR_ANCHORS } from "../../model/errorColor";

/** Shared by every material of a stage: changing one value changes the whole picture. */
export interface Uniforms extends Record<string, IUniform> {
  hasErrors: IUniform<number>;
  fullMm: IUniform<number>;
  /** Pixels that one metre covers one metre from the eye. */
  pixelsPerMetre: IUniform<number>;
  hasOwnColors: IUniform<number>;
  /** Points alone close their surface; over a mesh they let it show. */
  grow: IUniform<number>;
}

export const createUniforms = (fullMm: number): Uniforms => ({
  hasErrors: { value: 0 },
  fullMm: { value: fullMm },
  pixelsPerMetre: { value: 1 },
  hasOwnColors: { value: 1 },
  grow: { value: 1 },
});

const anchors = ERROR_ANCHORS.map((color) => `vec3(${color.map((value) => (value / 255).toFixed(4)).join(", ")})`);

const VERTEX = `
attribute float errorMm;
attribute float taken;
attribute vec3 tint;
uniform float pixelsPerMetre, radius, fullMm, hasErrors, hasOwnColors, hasTint, grow;
uniform vec3 plain;
varying vec3 vColor;
varying vec3 vNormal;
varying float vTaken;
vec3 errorColor(float value) {
  float at = clamp(value, 0.0, 1.0) * ${(anchors.length - 1).toFixed(1)};
  vec3 color = ${anchors[0]};
${anchors
  .slice(1)
  .map((anchor, below) => `  color = mix(color, ${anchor}, clamp(at - ${below.toFixed(1)}, 0.0, 1.0));`)
  .join("\n")}
  return color;
}
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  gl_PointSize = clamp(2.0 * grow * radius * pixelsPerMetre / -seen.z, 1.5, 48.0);
  vNormal = normalMatrix * normal;
  vTaken = taken;
  // -1 stands for a point that nothing was compared with.
  vec3 own = mix(plain, tint, hasTint * hasOwnColors);
  vColor = hasErrors > 0.5 ? (errorMm < 0.0 ? vec3(0.55) : errorColor(errorMm / fullMm)) : own;
}`;

const FRAGMENT = `
uniform float opacity, isPoint;
varying vec3 vColor;
varying vec3 vNormal;
varying float vTaken;
void main() {
  if (isPoint > 0.5) {
    vec2 off = 2.0 * gl_PointCoord - 1.0;
    if (dot(off, off) > 1.0) discard;
  }
  vec3 normal = length(vNormal) > 0.1 ? normalize(vNormal) : vec3(0.0, 0.0, 1.0);
  // The light is at the eye, a little above; what is seen from inside is dark.
  float facing = dot(normal, normalize(vec3(0.15, 0.35, 1.0)));
  float light = facing > 0.0 ? 0.22 + 0.78 * pow(facing, 1.5) : 0.2;
  vec3 color = vColor * light;
  if (vTaken > 0.5) {
    float grain = mod(floor(gl_FragCoord.x) + floor(gl_FragCoord.y), 2.0);
    if (grain > 0.5) discard;
    color = mix(color, vec3(0.62, 0.24, 0.22), 0.65) * 0.6;
  }
  gl_FragColor = vec4(color, opacity);
}`;

interface Paint {
  plain: string;
  isPoint: boolean;
  hasTint: boolean;
  /** m */
  radius: number;
  opacity?: number;
}

export function createMaterial(uniforms: Uniforms, { plain, isPoint, hasTint, radius, opacity = 1 }: Paint): ShaderMaterial {
  // As numbers between 0 and 1 without a change of colour space: what is written is what is shown.
  const color = new Color().setStyle(plain, "");
  return new ShaderMaterial({
    uniforms: {
      ...uniforms,
      plain: { value: color },
      radius: { value: radius },
      isPoint: { value: isPoint ? 1 : 0 },
      hasTint: { value: hasTint ? 1 : 0 },
      opacity: { value: opacity },
    },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    transparent: opacity < 1,
    blending: NormalBlending,
    polygonOffset: !isPoint,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}
