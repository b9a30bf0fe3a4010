/**
 * The page's √3, timed: in turns a refinement from nothing and an update of one that follows the camera.
 *
 * Bundled by `refine_node.mjs`, for Node and for a worker of a browser.
 */
import { Sqrt3 } from "../../viewer/src/refine/sqrt3.ts";

/** Until engines have compiled what is called often. */
const WARM_UP = 8;

/**
 * @param data - `positions`, `faces`, `limits` and `views`, one a degree further than the one before.
 * @returns The triangles of each round; milliseconds of each of: a refinement from nothing (its arrays, and where
 *   vertices are shown, included), an update to the next view. `first` has them before anything was warm.
 */
export function measure(data, rounds) {
  const mesh = { positions: Float64Array.from(data.positions), faces: Int32Array.from(data.faces) };
  const limits = Float64Array.from(data.limits);
  const views = data.views.map((view) => Float64Array.from(view));
  const follower = new Sqrt3(mesh);
  follower.update(views[0], limits);
  const found = { first: null, triangles: [], fresh: [], orbit: [] };
  for (let i = 0; i < WARM_UP + rounds; i++) {
    const view = views[(i + 1) % views.length];
    const start = performance.now();
    const triangles = fresh(mesh, view, limits);
    const made = performance.now();
    follower.update(view, limits);
    const times = { triangles, fresh: made - start, orbit: performance.now() - made };
    found.first ??= times;
    if (i >= WARM_UP) for (const [name, time] of Object.entries(times)) found[name].push(time);
  }
  return found;
}

function fresh(mesh, view, limits) {
  const refined = new Sqrt3(mesh);
  const { faces } = refined.update(view, limits);
  const shown = refined.faces();
  const places = new Float64Array(3 * refined.vertexSlots);
  for (let v = 0; v < refined.vertexSlots; v++) refined.place(v, false, shown, places, 3 * v);
  return faces;
}
