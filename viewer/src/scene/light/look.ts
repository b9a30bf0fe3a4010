/** How the light of a scene is looked at. */

/**
 * How shadows are looked up: one pixel of the map, the pixels around it, as many as a pixel of the picture covers, or
 * in all images of an area light.
 */
export const SHADOW_FILTERS = ["hard", "3x3", "5x5", "smooth", "soft"] as const;
export type ShadowFilter = (typeof SHADOW_FILTERS)[number];

export interface LightLook {
  /** Else the light hangs on the camera, as in a scene without one. */
  readonly isOn: boolean;
  readonly filter: ShadowFilter;
  /** Image of a sun's path, from 0; between two of them both shine. */
  readonly time: number;
}
