/** The shaders of a refinement: shaded as patches are (spec/shading.md), with vertices on their way. */
import { DoubleSide, GLSL3, Matrix4, NoBlending, ShaderMaterial, Vector3 } from "three";
import { COLOUR_SHIFT, LEVEL_MASK } from "../format/wire";
import { CAST_FRAGMENT } from "./light/shader";
import { DEPTH_FRAGMENT } from "./material";
import { LEVELS, TRIPLET } from "./palette";
import { PLASTER, SHADE_GLSL } from "./shading";
import { BLEND_SECONDS } from "./slotBlend";

const VERTEX = /* glsl */ `
in vec3 from;
in vec3 fromNormal;
in float since;
in vec4 srgb;
uniform vec3 reference;
uniform mat4 toEye;
uniform float now;
uniform bool isStill;
invariant gl_Position; // surface and wires are two programs
out vec3 vNormal;
out vec3 vPosition;
out vec3 vSrgb;

void main() {
  float share = isStill ? 1.0 : clamp((now - since) / ${BLEND_SECONDS}, 0.0, 1.0);
  // close to the eye this difference is exact, so nothing jitters
  vec4 seen = toEye * vec4(mix(from, position, share) - reference, 1.0);
  vPosition = seen.xyz;
  vNormal = mat3(viewMatrix) * mix(fromNormal, normal, share); // the asset is moved and scaled, not turned
  vSrgb = srgb.rgb;
  gl_Position = projectionMatrix * seen;
}
`;

const FRAGMENT = /* glsl */ `
in vec3 vNormal;
in vec3 vPosition;
in vec3 vSrgb;
uniform vec3 plaster;
uniform bool hasColours;
out vec4 pixel;
${SHADE_GLSL}
void main() {
  vec3 facing = normalize(cross(dFdx(vPosition), dFdy(vPosition))); // always on the side of the eye
  vec3 normal = length(vNormal) < 1e-3 ? facing : normalize(vNormal);
  pixel = vec4(shade(hasColours ? vSrgb : plaster, normal, facing, vPosition), 1.0);
}
`;

/** Three corners a face, its number within the face in the vertex's own. */
const TAGGED_VERTEX = /* glsl */ `
in float tag;
uniform vec3 reference;
uniform mat4 toEye;
out vec3 vPosition;
out vec3 vCorner;
flat out int vTag;

void main() {
  vec4 seen = toEye * vec4(position - reference, 1.0);
  vPosition = seen.xyz;
  int corner = gl_VertexID % 3;
  vCorner = vec3(equal(ivec3(corner), ivec3(0, 1, 2)));
  vTag = int(tag);
  gl_Position = projectionMatrix * seen;
}
`;

/** Flat, as the triangles are; edges as lines that thin out where triangles are about as small as pixels. */
const TAGGED_FRAGMENT = /* glsl */ `
in vec3 vPosition;
in vec3 vCorner;
flat in int vTag;
uniform vec3 palette[${LEVELS.length}];
uniform vec3 triplet[3];
uniform bool areLevels;
uniform float line;
out vec4 pixel;
${SHADE_GLSL}
void main() {
  vec3 facing = normalize(cross(dFdx(vPosition), dFdy(vPosition)));
  vec3 srgb = areLevels ? palette[min(vTag & ${LEVEL_MASK}, ${LEVELS.length - 1})] : triplet[min(vTag >> ${COLOUR_SHIFT}, 2)];
  vec3 width = fwidth(vCorner);
  vec3 near = 1.0 - smoothstep(0.3 * width, 1.2 * width, vCorner);
  // one over the triangle's height in pixels: lines as strong on small triangles as on large ones would hide the colours
  float small = max(width.x, max(width.y, width.z));
  float strength = (1.0 - smoothstep(0.25, 0.7, small)) / (1.0 + 12.0 * small);
  float ink = line * strength * max(near.x, max(near.y, near.z));
  pixel = vec4(mix(shade(srgb, facing, facing, vPosition), vec3(0.0), ink), 1.0);
}
`;

const WIRE_FRAGMENT = /* glsl */ `
uniform vec4 ink;
out vec4 pixel;
void main() {
  pixel = ink;
}
`;

/** Of one layer. */
export function makeRefinedUniforms() {
  const srgb = (colour: readonly [number, number, number]): Vector3 =>
    new Vector3(...colour).divideScalar(255);
  return {
    reference: { value: new Vector3() },
    toEye: { value: new Matrix4() },
    now: { value: 0 },
    isStill: { value: false },
    plaster: { value: srgb(PLASTER) },
    hasColours: { value: false },
    palette: { value: LEVELS.map(srgb) },
    triplet: { value: TRIPLET.map(srgb) },
    areLevels: { value: true },
    /** Strength of the edges on tagged faces, 0 for none. */
    line: { value: 0 },
    ink: { value: [0, 0, 0, 0.25] },
    far: { value: 1 },
  };
}

export interface RefinedMaterials {
  readonly surface: ShaderMaterial;
  readonly wire: ShaderMaterial;
  readonly depth: ShaderMaterial;
  /** For the ordinary shadow map. */
  readonly cast: ShaderMaterial;
  readonly tagged: ShaderMaterial;
  readonly uniforms: ReturnType<typeof makeRefinedUniforms>;
}

export function makeRefinedMaterials(): RefinedMaterials {
  const uniforms = makeRefinedUniforms();
  const base = { glslVersion: GLSL3, uniforms, side: DoubleSide };
  const blended = { ...base, vertexShader: VERTEX };
  return {
    uniforms,
    // with lines over it the surface steps back a little, as patches do
    surface: new ShaderMaterial({
      ...blended,
      fragmentShader: FRAGMENT,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    }),
    wire: new ShaderMaterial({
      ...blended,
      fragmentShader: WIRE_FRAGMENT,
      transparent: true,
      depthWrite: false,
    }),
    depth: new ShaderMaterial({ ...blended, fragmentShader: DEPTH_FRAGMENT }),
    cast: new ShaderMaterial({ ...blended, fragmentShader: CAST_FRAGMENT, blending: NoBlending }),
    tagged: new ShaderMaterial({
      ...base,
      vertexShader: TAGGED_VERTEX,
      fragmentShader: TAGGED_FRAGMENT,
    }),
  };
}
