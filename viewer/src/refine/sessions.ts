/** Which session refines which control mesh. */
import type { CATMULL_CLARK } from "../format/cage";
import type { Triple } from "../format/graph";
import type { PolygonMesh } from "../format/polygons";
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

/**
 * @param origin - What positions are told relative to.
 * @throws Problem if the mesh is no oriented surface.
 */
export function sessionOf(cage: Cage, origin: Triple, name: string): Dialogue {
  if (cage.scheme === "sqrt3") return new RefinementSession(cage.mesh, origin, name);
  const { mesh, placements } = cage;
  return new PatchSession(placements ? placed(mesh, placements) : mesh, origin, name);
}
