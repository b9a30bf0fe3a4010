/** The one place that chooses who refines a control mesh: the server that gave out the scene, or this page. */
import type { CageInfo, Scheme } from "../format/cage";
import { Problem } from "../format/problem";
import type { OpenFile } from "../stream/file";
import { LiveSource } from "../stream/live";
import type { RefinementSource } from "../stream/refinement";
import { readControlMesh } from "./controlMesh";
import { PageSource } from "./pageSource";

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
  if (scheme !== "sqrt3") {
    throw new Problem(
      "version",
      `${name} is refined (${scheme}) by a server, and this page has none. Open it with: foveal view`,
    );
  }
  const mesh = await readControlMesh(file, info);
  return new PageSource({ mesh, origin: info.origin, name }, file.container.size);
}
