/** The one place that chooses who refines a control mesh: the server that gave out the scene, or this page. */
import { CATMULL_CLARK, type CageInfo, type Scheme } from "../format/cage";
import { Problem } from "../format/problem";
import type { OpenFile } from "../stream/file";
import { LiveSource } from "../stream/live";
import type { RefinementSource } from "../stream/refinement";
import { readControlMesh, readPlacements, readPolygons } from "./controlMesh";
import { PageSource } from "./pageSource";
import type { Cage } from "./sessions";

/**
 * @param live - Address of the server's session, or null where there is no such server.
 * @throws Problem if nobody can, or the page would have to and the control mesh cannot be read.
 */
export async function openRefinement(
  file: OpenFile,
  info: CageInfo,
  scheme: Scheme,
  live: string | null,
): Promise<RefinementSource> {
  if (live !== null) return new LiveSource(live);
  const { name } = file.source;
  const start = { cage: await readCage(file, info, scheme), origin: info.origin, name };
  return new PageSource(start, file.container.size);
}

async function readCage(file: OpenFile, info: CageInfo, scheme: Scheme): Promise<Cage> {
  if (scheme === "sqrt3") return { scheme, mesh: await readControlMesh(file, info) };
  if (scheme === CATMULL_CLARK && info.sharpEdges.length > 0) {
    throw new Problem(
      "version",
      `${file.source.name} has sharp edges, which ${scheme} does not know. Choose sqrt3, or build it again with creases.`,
    );
  }
  if (scheme === CATMULL_CLARK) {
    const mesh = await readPolygons(file, info);
    return { scheme, mesh, placements: await readPlacements(file, info) };
  }
  throw new Problem(
    "version",
    `${file.source.name} is refined (${scheme}) by a server, and this page has none. Open it with: foveal view`,
  );
}
