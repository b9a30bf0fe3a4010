/** How the light of a scene is looked at. */
import type { LightInfo } from "../../format/light";

/**
 * How shadows are looked up: one pixel of the map, the pixels around it, as many as a pixel of the picture covers, or
 * in all images of an area light.
 */
export const SHADOW_FILTERS = ["hard", "3x3", "5x5", "smooth", "soft"] as const;
export type ShadowFilter = (typeof SHADOW_FILTERS)[number];

/** Those that a light has: only an area is soft, and coarser levels of a stack mix its images. */
export function filtersOf({ kind, images }: Pick<LightInfo, "kind" | "images">): ShadowFilter[] {
  return SHADOW_FILTERS.filter((filter) =>
    filter === "soft" ? kind === "area" : filter !== "smooth" || images === 1,
  );
}

export interface LightLook {
  /** Else the light hangs on the camera, as in a scene without one. */
  readonly isOn: boolean;
  readonly filter: ShadowFilter;
  /** Image of a sun's path, from 0; between two of them both shine. */
  readonly time: number;
}
