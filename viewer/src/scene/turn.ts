/** From where a picture from elsewhere is seen. */

/** Degrees: round the up axis from the front to the right, -180 to 180, and above the level. */
export type Turn = readonly [azimuth: number, elevation: number];

/** Straight from above nothing says which way is up in the picture. */
const MAX_ELEVATION = 89;

/** From behind, a little to the side, and above: what the picture itself does not show. */
export const FIRST_TURN: Turn = [150, 35];

/** Turned on by so many degrees. */
export function turned([azimuth, elevation]: Turn, right: number, up: number): Turn {
  const round = (((azimuth + right + 180) % 360) + 360) % 360;
  return [round - 180, Math.max(-MAX_ELEVATION, Math.min(MAX_ELEVATION, elevation + up))];
}
