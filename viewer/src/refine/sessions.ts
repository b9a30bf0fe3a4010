/** Which session refines which control mesh. */
import type { CATMULL_CLARK } from "../format/cage";
import type { Triple } from "../format/graph";
import type { PolygonMesh } from "../format/polygons";
import type { Dialogue } from "./dialogue";
import { PatchSession } from "./patchSession";
import { RefinementSession } from "./session";
import type { ControlMesh } from "./surface";

/** A control mesh with the scheme by which a page refines it. */
export type Cage =
  | { readonly scheme: "sqrt3"; readonly mesh: ControlMesh }
  | { readonly scheme: typeof CATMULL_CLARK; readonly mesh: PolygonMesh };

/**
 * @param origin - What positions are told relative to.
 * @throws Problem if the mesh is no oriented surface.
 */
export function sessionOf(cage: Cage, origin: Triple, name: string): Dialogue {
  return cage.scheme === "sqrt3"
    ? new RefinementSession(cage.mesh, origin, name)
    : new PatchSession(cage.mesh, origin, name);
}
