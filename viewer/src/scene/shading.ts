/** spec/shading.md, twice: as a function one can read and test, and as the shader that does it. */

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
 */
export function shade(colour: Rgb, normal: Vector, facing: Vector, shadow = 1): Rgb {
  const side = dot(normal, facing) < 0 ? -1 : 1;
  const key = Math.max(0, side * dot(normal, KEY));
  const fill = 0.5 + 0.5 * side * normal[1];
  const light = AMBIENT + FILL * fill + KEY_STRENGTH * shadow * key;
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

/** GLSL of the same: `vec3 shade(vec3 srgb, vec3 normal, vec3 facing)`, colours from 0 to 1. */
export const SHADE_GLSL = /* glsl */ `
vec3 decodeSrgb(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}
vec3 encodeSrgb(vec3 x) {
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));
}
vec3 shade(vec3 srgb, vec3 normal, vec3 facing) {
  vec3 n = dot(normal, facing) < 0.0 ? -normal : normal;
  float key = max(0.0, dot(n, vec3(${KEY.map((x) => x.toFixed(8)).join(", ")})));
  float fill = 0.5 + 0.5 * n.y;
  float light = ${AMBIENT} + ${FILL} * fill + ${KEY_STRENGTH} * key;
  return encodeSrgb(min(vec3(1.0), decodeSrgb(srgb) * light));
}
`;
