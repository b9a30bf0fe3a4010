/** spec/shading.md, twice: as a function one can read and test, and as the shader that does it. */
import { LIGHT_GLSL } from "./light/shader";

export type Rgb = readonly [number, number, number];
type Vector = readonly [number, number, number];

/** sRGB bytes of a surface without colours. */
export const PLASTER: Rgb = [214, 208, 198];
const KEY: Vector = [-0.35, 0.45, Math.sqrt(1 - 0.35 ** 2 - 0.45 ** 2)];
const AMBIENT = 0.08;
const FILL = 0.17;
const KEY_STRENGTH = 0.9;

/**
 * The pixel of a point with this sRGB colour and unit normal, in the camera's frame.
 *
 * @param facing - The triangle's own normal, on the side of the eye.
 * @param shadow - How much of the key light arrives.
 * @param toLight - Where it comes from: a scene's own light, or the one that hangs on the camera.
 */
export function shade(colour: Rgb, normal: Vector, facing: Vector, shadow = 1, toLight: Vector = KEY): Rgb {
  const side = dot(normal, facing) < 0 ? -1 : 1;
  const key = shadow * Math.max(0, side * dot(normal, toLight));
  const fill = 0.5 + 0.5 * side * normal[1];
  const light = AMBIENT + FILL * fill + KEY_STRENGTH * key;
  const byte = (c: number): number => Math.round(255 * encode(Math.min(1, decode(c / 255) * light)));
  return [byte(colour[0]), byte(colour[1]), byte(colour[2])];
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function decode(c: number): number {
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
}

export function encode(x: number): number {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

/** light ^ (1 / 2.4) as p0 + p1 light + p2 sqrt(light) + p3 sqrt(sqrt(light)): within 4e-5 from 0.08 to 1.15. */
const POWER = [-0.03992798, -0.02793827, 0.70967028, 0.35821302] as const;
/** decode(c) as t1 c + t2 c^2 + t3 c^3, where a colour is so dark that light may bring it onto the straight part. */
const TOE = [0.07150888, 0.08561957, 1.91839008] as const;

/**
 * What the shader computes for one channel, c and light as spec/shading.md names them: the same within a third
 * of a level, without a power.
 *
 * Off the straight part of the curve encode(decode(c) * light) is (c + 0.055) * light ^ (1 / 2.4) - 0.055: the
 * powers of c cancel out. Seven powers a pixel took a software rasteriser half the time of a pixel.
 */
export function shadeFast(c: number, light: number): number {
  const [p0, p1, p2, p3] = POWER;
  const power = p0 + p1 * light + p2 * Math.sqrt(light) + p3 * Math.sqrt(Math.sqrt(light));
  const straight = 12.92 * light * c * (TOE[0] + c * (TOE[1] + c * TOE[2]));
  return straight < 0.04045 ? straight : Math.min(1, (c + 0.055) * power - 0.055);
}

const number = (x: number): string => x.toFixed(8);

/**
 * GLSL of the same: `vec3 shade(vec3 srgb, vec3 normal, vec3 facing, vec3 place)`, colours from 0 to 1, `place` from
 * the eye. Where IS_LIT is defined the scene may have a light, with its shadows.
 */
export const SHADE_GLSL = /* glsl */ `
${LIGHT_GLSL}
vec3 shade(vec3 srgb, vec3 normal, vec3 facing, vec3 place) {
  vec3 n = dot(normal, facing) < 0.0 ? -normal : normal;
#ifdef IS_LIT
  float key = lightKey(n, facing, place, dFdx(place), dFdy(place));
#else
  float key = max(0.0, dot(n, vec3(${KEY.map(number).join(", ")})));
#endif
  float fill = 0.5 + 0.5 * n.y;
  float light = ${AMBIENT} + ${FILL} * fill + ${KEY_STRENGTH} * key;
  float root = sqrt(light);
  vec4 parts = vec4(1.0, light, root, sqrt(root));
  float power = dot(parts, vec4(${POWER.map(number).join(", ")}));
  vec3 toe = srgb * (${number(TOE[0])} + srgb * (${number(TOE[1])} + srgb * ${number(TOE[2])}));
  vec3 straight = 12.92 * light * toe;
  vec3 curved = min(vec3(1.0), (srgb + 0.055) * power - 0.055);
  return mix(curved, straight, lessThan(straight, vec3(0.04045)));
}
`;
