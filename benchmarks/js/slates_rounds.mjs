// Times of the page's Catmull-Clark patches: messages of a session, as its worker makes them.
import { PatchSession } from "../../viewer/src/refine/patchSession.ts";
import { placed } from "./slates_placed.mjs";

const IDS = ["starts", "corners", "creaseEdges", "cornerVertices"];
const SHARP = ["creaseSharpness", "cornerSharpness"];

/** Milliseconds of the very first message, of others of fresh sessions, and of one in motion after each camera. */
export function measure({ mesh, requests, placements }, rounds) {
  const typed = { boundary: mesh.boundary, positions: Float64Array.from(mesh.positions) };
  for (const name of IDS) typed[name] = Int32Array.from(mesh[name]);
  for (const name of SHARP) typed[name] = Float32Array.from(mesh[name]);
  if (placements) return placed(typed, requests, placements, rounds);
  const times = { fresh: [], orbit: [], bytes: 0 };
  for (let i = 0; i < rounds; i++) {
    let begin = performance.now();
    const session = new PatchSession(typed, [0, 0, 0], "mesh");
    const message = session.answer({ ...requests[0], seen: 0 });
    const fresh = performance.now() - begin;
    const triangles = new DataView(message).getUint32(24, true);
    if (i === 0) times.first = { fresh, triangles, bytes: message.byteLength };
    else times.fresh.push(fresh);
    for (let step = 1; step < requests.length; step++) {
      begin = performance.now();
      times.bytes = session.answer({ ...requests[step], seen: step }).byteLength;
      if (i > 0) times.orbit.push(performance.now() - begin);
    }
  }
  return times;
}
