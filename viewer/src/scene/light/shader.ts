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

/** What all materials of a scene share of its light. */
export interface LightShader {
  readonly uniforms: Readonly<Record<string, IUniform>>;
  /** What light.glsl wants to be defined, and IS_LIT where the light shines. */
  readonly defines: Readonly<Record<string, number>>;
}

/** Have the scene's light shine on what these draw, or shine no more. */
export function lightBy({ uniforms, defines }: LightShader, materials: readonly ShaderMaterial[]): void {
  for (const material of materials) {
    Object.assign(material.uniforms, uniforms);
    const own = Object.entries(material.defines ?? {}).filter(([name]) => !/^(IS_LIT|LIGHT_)/.test(name));
    material.defines = { ...Object.fromEntries(own), ...defines };
    material.needsUpdate = true;
  }
}
