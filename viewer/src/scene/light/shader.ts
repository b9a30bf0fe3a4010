/** GLSL of a scene's light, and what a material needs to be lit by it. */
import type { IUniform, ShaderMaterial } from "three";
import CAST from "./cast.glsl?raw";
import LIGHT from "./light.glsl?raw";
import LOOKUP from "./lookup.glsl?raw";

/** `float lightKey(...)`, the key light of spec/shading.md with its shadow. Only where IS_LIT is defined. */
export const LIGHT_GLSL = `
#ifdef IS_LIT
${LOOKUP}
${LIGHT}
#endif
`;

/** Fragment shader of what moves, for the ordinary shadow map: of any surface that tells \`vPosition\`. */
export const CAST_FRAGMENT = `
${LOOKUP}
${LIGHT}
${CAST}
`;

/** By name; all materials of a scene share them. */
export type LightUniforms = Readonly<Record<string, IUniform>>;

/** Have the scene's light shine on what these draw. */
export function lightBy(uniforms: LightUniforms, materials: readonly ShaderMaterial[]): void {
  for (const material of materials) {
    Object.assign(material.uniforms, uniforms);
    material.defines = { ...material.defines, IS_LIT: 1 };
    material.needsUpdate = true;
  }
}
