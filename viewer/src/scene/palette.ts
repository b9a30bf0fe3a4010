/** Colours that tell what a face of a refinement is: how often it was split, or its colour in an RGB triangulation. */
import { encode, type Rgb } from "./shading";

/**
 * sRGB bytes by level: lightness falls evenly (OKLCH, 0.95 to 0.4) while the hue goes from sand over green to
 * violet, so that the order is seen without colours too. Deeper levels all have the last.
 */
export const LEVELS: readonly Rgb[] = makeLevels();

/** Green, red and blue, as light as one another, so that light and shade stay readable. */
export const TRIPLET: readonly Rgb[] = [
  [126, 178, 109],
  [214, 106, 94],
  [98, 142, 205],
];

function makeLevels(): Rgb[] {
  const count = 10;
  return Array.from({ length: count }, (_, i) => {
    const share = i / (count - 1);
    const chroma = 0.045 + 0.075 * Math.sin(Math.PI * (0.15 + 0.75 * share));
    return fromOklch(0.95 - 0.55 * share, chroma, 95 + 195 * share);
  });
}

/** B. Ottosson, A perceptual color space for image processing, 2020. Out of range is cut off. */
function fromOklch(lightness: number, chroma: number, hueDegrees: number): Rgb {
  const hue = (hueDegrees * Math.PI) / 180;
  const a = chroma * Math.cos(hue);
  const b = chroma * Math.sin(hue);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const byte = (linear: number): number => Math.round(255 * encode(Math.min(1, Math.max(0, linear))));
  return [
    byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    byte(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}
