/** Decoded patches as the GPU takes them: relative to the patch's own centre, as small as they fit. */
import type { DecodedPatch } from "../format/patch";
import { reorder } from "./reorder";

export interface PackedPatch {
  /** Grid position that the vertices are relative to. */
  readonly centre: readonly [number, number, number];
  /** Greatest distance of a vertex from the centre, in grid steps. */
  readonly radius: number;
  /** Four a vertex (the last is unused, it keeps rows aligned): exact 16-bit steps, or floats if too wide. */
  readonly positions: Int16Array<ArrayBuffer> | Float32Array<ArrayBuffer>;
  /** Octahedral pairs. */
  readonly normals: Int16Array<ArrayBuffer> | null;
  /** sRGB and an unused fourth. */
  readonly colours: Uint8Array<ArrayBuffer> | null;
  readonly indices: Uint16Array<ArrayBuffer> | Uint32Array<ArrayBuffer>;
}

const INT16_REACH = 32767;
const FLOAT32_REACH = 1 << 24;

/**
 * Pack one patch.
 *
 * @throws Error if it is wider than floats hold exactly (2^25 steps).
 */
export function packPatch(patch: DecodedPatch): PackedPatch {
  const { positions, colours } = patch;
  const vertices = positions.length / 3;
  const indices = reorder(patch.indices, vertices);
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    const axis = i % 3;
    const value = positions[i]!;
    if (value < low[axis]!) low[axis] = value;
    if (value > high[axis]!) high[axis] = value;
  }
  const centre = [0, 1, 2].map((a) => (vertices ? Math.floor((low[a]! + high[a]!) / 2) : 0));
  const reach = vertices ? Math.max(...[0, 1, 2].map((a) => high[a]! - centre[a]!)) + 1 : 0;
  if (reach > FLOAT32_REACH) throw new Error("A patch is wider than its grid allows. Build the file again.");
  const packed = reach < INT16_REACH ? new Int16Array(4 * vertices) : new Float32Array(4 * vertices);
  const [cx, cy, cz] = centre as [number, number, number];
  let most = 0;
  for (let v = 0; v < vertices; v++) {
    const x = positions[3 * v]! - cx;
    const y = positions[3 * v + 1]! - cy;
    const z = positions[3 * v + 2]! - cz;
    packed[4 * v] = x;
    packed[4 * v + 1] = y;
    packed[4 * v + 2] = z;
    most = Math.max(most, x * x + y * y + z * z);
  }
  return {
    centre: [cx, cy, cz],
    radius: Math.sqrt(most),
    positions: packed,
    normals: patch.normals,
    colours: colours && fourWide(colours),
    indices: vertices > 65536 ? indices : Uint16Array.from(indices),
  };
}

function fourWide(colours: Uint8Array): Uint8Array<ArrayBuffer> {
  const out = new Uint8Array((colours.length / 3) * 4).fill(255);
  for (let i = 0, o = 0; i < colours.length; i += 3, o += 4) {
    out[o] = colours[i]!;
    out[o + 1] = colours[i + 1]!;
    out[o + 2] = colours[i + 2]!;
  }
  return out;
}

/** GPU bytes of a packed patch. */
export function packedBytes(patch: PackedPatch): number {
  return (
    patch.positions.byteLength +
    patch.indices.byteLength +
    (patch.normals?.byteLength ?? 0) +
    (patch.colours?.byteLength ?? 0)
  );
}

/** The buffers to hand over instead of copying. */
export function buffersOf(patches: readonly PackedPatch[]): ArrayBuffer[] {
  return patches.flatMap((patch) =>
    [patch.positions, patch.normals, patch.colours, patch.indices].flatMap((array) =>
      array ? [array.buffer] : [],
    ),
  );
}
