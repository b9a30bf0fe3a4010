/** Budgets to start with on this device; all can be changed in the settings. */
export interface Budgets {
  /** Error aimed at, in pixels of the picture. */
  readonly errorPx: number;
  readonly triangles: number;
  /** Of GPU memory for patches. */
  readonly bytes: number;
}

export interface DeviceHints {
  /** The main pointer is a finger. */
  readonly isCoarse: boolean;
  /** `navigator.deviceMemory` in GiB where the browser tells. */
  readonly memoryGiB: number | undefined;
}

const DESKTOP: Budgets = { errorPx: 1, triangles: 4e6, bytes: 512 * 2 ** 20 };

/** Phones and machines with little memory get a quarter: tabs that take more are killed without a word. */
export function defaultBudgets({ isCoarse, memoryGiB }: DeviceHints): Budgets {
  const isSmall = isCoarse || (memoryGiB !== undefined && memoryGiB <= 2);
  if (!isSmall) return DESKTOP;
  return { errorPx: 2, triangles: DESKTOP.triangles / 4, bytes: DESKTOP.bytes / 4 };
}

/** Triangles of a refinement at most, where nobody chose: each update has to come over the wire, too. */
export function refinedTriangles(hints: DeviceHints): number {
  return defaultBudgets(hints).triangles / 8;
}

export function deviceHints(): DeviceHints {
  const { deviceMemory } = navigator as Navigator & { deviceMemory?: number };
  return { isCoarse: matchMedia("(pointer: coarse)").matches, memoryGiB: deviceMemory };
}

/** Beyond two device pixels an CSS pixel nobody sees a difference, and the cost is squared. */
export const MAX_PIXEL_RATIO = 2;
