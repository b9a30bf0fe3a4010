/** The one place that chooses who refines a control mesh: the server that gave out the scene, or this page. */
import type { Scheme } from "../format/cage";
import { Problem } from "../format/problem";
import type { OpenFile } from "./file";
import { LiveSource } from "./live";
import type { RefinementSource } from "./refinement";

/**
 * @param live - Address of the server's session, or null where there is no such server.
 * @throws Problem if nobody can.
 */
export async function openRefinement(
  file: OpenFile,
  scheme: Scheme,
  live: string | null,
): Promise<RefinementSource> {
  if (live !== null) return new LiveSource(live);
  throw new Problem(
    "version",
    `${file.source.name} is refined (${scheme}) by a server, and this page has none. Open it with: foveal view`,
  );
}
