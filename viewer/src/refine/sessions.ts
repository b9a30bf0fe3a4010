/** Which session refines which control mesh. */
import type { CATMULL_CLARK } from "../format/cage";
import type { Triple } from "../format/graph";
import type { PolygonMesh } from "../format/polygons";
import { Problem } from "../format/problem";
import type { Dialogue } from "./dialogue";
import { PatchSession } from "./patchSession";
import { RefinementSession } from "./session";
import { placed } from "./slates/placed";
import type { ControlMesh } from "./surface";

/** A control mesh with the scheme by which a page refines it. */
export type Cage =
  | { readonly scheme: "sqrt3"; readonly mesh: ControlMesh }
  | {
      readonly scheme: typeof CATMULL_CLARK;
      readonly mesh: PolygonMesh;
      /** Where it stands, by 16 numbers each, if not once and where it is. */
      readonly placements?: Float64Array | undefined;
    };

/** Of two triangles each, at least: what a message holds at most (format/wire.ts). */
const MOST_PATCHES = 2 ** 22;

/**
 * @param origin - What positions are told relative to.
 * @throws Problem if the mesh is no oriented surface, or has more patches than a page shows.
 */
export function sessionOf(cage: Cage, origin: Triple, name: string): Dialogue {
  if (cage.scheme === "sqrt3") return new RefinementSession(cage.mesh, origin, name);
  const { mesh, placements } = cage;
  refuseMany(mesh, placements ? placements.length / 16 : 1, name);
  return new PatchSession(placements ? placed(mesh, placements) : mesh, origin, name);
}

function refuseMany({ starts, corners }: PolygonMesh, times: number, name: string): void {
  const areQuads = starts.every((start, f) => start === 4 * f);
  const patches = times * (areQuads ? corners.length / 4 : corners.length);
  if (patches <= MOST_PATCHES) return;
  throw new Problem(
    "damaged",
    `${name} has ${patches.toLocaleString("en")} patches in all its places, more than a page shows. Build it with fewer placements or faces.`,
  );
}
