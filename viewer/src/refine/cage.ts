/** An opened control mesh: what its file says, and who refines it. */
import { CATMULL_CLARK, type CageInfo, parseCage, type Refinement, refinementOf } from "../format/cage";
import { Problem } from "../format/problem";
import type { OpenFile } from "../stream/file";
import type { RefinementSource } from "../stream/refinement";
import { openRefinement } from "./openRefinement";

export interface Cage {
  readonly file: OpenFile;
  readonly info: CageInfo;
  /** As the scene wants it. */
  readonly refinement: Refinement;
  readonly source: RefinementSource;
}

/**
 * @param live - Address of a server's session, or null for none.
 * @param layer - What scene.json says of the layer; it goes before what the file says.
 * @throws Problem in a sentence about the file or the layer.
 */
export async function openCage(
  file: OpenFile,
  live: string | null,
  layer: Readonly<Record<string, unknown>>,
): Promise<Cage> {
  const info = parseCage(file.container.header, file.source.name);
  const refinement = refinementOf(layer, "scene.json", info.refinement);
  if (info.polygons !== undefined && refinement.scheme !== CATMULL_CLARK) {
    throw new Problem(
      "version",
      `${file.source.name} holds polygons, which ${refinement.scheme} does not know. Build it again by that scheme, or let scene.json say ${CATMULL_CLARK}.`,
    );
  }
  const source = await openRefinement(file, info, refinement.scheme, live);
  return { file, info, refinement, source };
}
