/** The shaders of patches: one for all, with parts switched by defines so that the usual case stays cheap. */
import { DoubleSide, GLSL3, Matrix4, NoBlending, ShaderMaterial, Vector2, Vector3 } from "three";
import { CAST_FRAGMENT } from "./light/shader";
import { PLASTER, SHADE_GLSL } from "./shading";

const VERTEX = /* glsl */ `
in vec2 octahedral;
in vec3 srgb;
uniform float normalSteps;
uniform bool isFlat;
uniform ivec3 offset;
uniform mat4 toEye;
invariant gl_Position; // patches that fade and patches that do not are two programs, and may be neighbours
out vec3 vNormal;
out vec3 vPosition;
out vec3 vSrgb;

vec3 unfold(vec2 q) {
  vec2 e = q / normalSteps;
  if (min(e.x, e.y) < -1.0) return vec3(0.0);
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}

void main() {
  // whole numbers are added as such: what follows knows the grid point, not the patch (gridPlace.ts)
  vec4 seen = toEye * vec4(vec3(ivec3(position) + offset), 1.0);
  vPosition = seen.xyz;
  vNormal = isFlat ? vec3(0.0) : mat3(viewMatrix) * unfold(octahedral); // the grid is moved and scaled, not turned
  vSrgb = srgb;
  gl_Position = projectionMatrix * seen;
}
`;

/**
 * Cross-fade: of two surfaces in one place each pixel shows exactly one, chosen by a hash of the pixel, so
 * depth stays right and no hole opens: a patch shows where the hash is in [low, high) of its band.
 */
const FADE_GLSL = /* glsl */ `
uniform vec2 band;
void fade() {
  // interleaved gradient noise (Jimenez 2014): even over every small neighbourhood
  float hash = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
  if (hash < band.x || hash >= band.y) discard;
}
`;

const FRAGMENT = /* glsl */ `
in vec3 vNormal;
in vec3 vPosition;
in vec3 vSrgb;
uniform vec3 tint;
uniform vec3 plaster;
uniform bool hasColours;
uniform bool hasTint;
out vec4 pixel;
${SHADE_GLSL}
#ifdef IS_FADING
${FADE_GLSL}
#endif

void main() {
#ifdef IS_FADING
  fade();
#endif
  vec3 facing = normalize(cross(dFdx(vPosition), dFdy(vPosition))); // always on the side of the eye
  vec3 normal = length(vNormal) < 1e-3 ? facing : normalize(vNormal);
  vec3 srgb = hasTint ? tint : hasColours ? vSrgb : plaster;
  pixel = vec4(shade(srgb, normal, facing, vPosition), 1.0);
}
`;

const WIRE_FRAGMENT = /* glsl */ `
in vec3 vNormal;
in vec3 vPosition;
in vec3 vSrgb;
uniform vec4 ink;
out vec4 pixel;
${FADE_GLSL}
void main() {
  fade();
  pixel = ink;
}
`;

/** Depth along the view axis over `far`, in four bytes: of any surface that tells `vPosition`. */
export const DEPTH_FRAGMENT = /* glsl */ `
in vec3 vPosition;
uniform float far;
out vec4 pixel;
void main() {
  vec4 parts = fract(clamp(-vPosition.z / far, 0.0, 0.9999999) * vec4(1.0, 255.0, 65025.0, 16581375.0));
  pixel = parts - vec4(parts.yzw / 255.0, 0.0);
}
`;

/** What all patch shaders share. \`offset\`, \`band\` and \`tint\` are set patch by patch just before it is drawn. */
export function makeUniforms() {
  return {
    offset: { value: new Int32Array(3) },
    toEye: { value: new Matrix4() },
    normalSteps: { value: 511 },
    isFlat: { value: false },
    hasColours: { value: true },
    hasTint: { value: false },
    tint: { value: new Vector3(1, 1, 1) },
    plaster: { value: new Vector3(...PLASTER.map((c) => c / 255)) },
    band: { value: new Vector2(0, 1) },
    ink: { value: [0, 0, 0, 0.25] },
    far: { value: 1 },
  };
}

export type PatchUniforms = ReturnType<typeof makeUniforms>;

export interface PatchMaterials {
  readonly solid: ShaderMaterial;
  readonly fading: ShaderMaterial;
  readonly wire: ShaderMaterial;
  readonly depth: ShaderMaterial;
  /** For the ordinary shadow map. */
  readonly cast: ShaderMaterial;
  readonly uniforms: PatchUniforms;
}

export function makeMaterials(): PatchMaterials {
  const uniforms = makeUniforms();
  const base = { glslVersion: GLSL3, uniforms, vertexShader: VERTEX, side: DoubleSide };
  // With lines over them surfaces step back a little. Not else: on steep faces the step is large, and at a
  // silhouette the far side would show through as dots.
  const surface = { ...base, fragmentShader: FRAGMENT, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
  return {
    solid: new ShaderMaterial(surface),
    fading: new ShaderMaterial({ ...surface, defines: { IS_FADING: 1 } }),
    wire: new ShaderMaterial({
      ...base,
      fragmentShader: WIRE_FRAGMENT,
      wireframe: true,
      transparent: true,
      depthWrite: false,
    }),
    depth: new ShaderMaterial({ ...base, fragmentShader: DEPTH_FRAGMENT }),
    cast: new ShaderMaterial({ ...base, fragmentShader: CAST_FRAGMENT, blending: NoBlending }),
    uniforms,
  };
}
