/** What is said below the title: how much there is. */
import { WORDS } from "./words";

interface Counted {
  readonly triangles: number;
  /** Of a control mesh that is refined here. */
  readonly refinement?: unknown;
  readonly polygons?: number | undefined;
}

export function subtitleOf(infos: readonly Counted[]): string {
  const polygons = infos.map((info) => info.polygons ?? 0);
  const arePolygons = polygons.every((faces) => faces > 0);
  const counts = arePolygons ? polygons : infos.map(({ triangles }) => triangles);
  const total = counts.reduce((sum, faces) => sum + faces, 0);
  const count = total ? `${total.toLocaleString("en")} ${arePolygons ? WORDS.faces : WORDS.triangles}` : "";
  return infos.some((info) => "refinement" in info) ? `${count}, ${WORDS.refinedHere}` : count;
}
