// The paper's scene: one control mesh in many places, its triangles for a camera that turns.
import { Placements } from "../../viewer/src/refine/slates/placements.ts";
import { Slates } from "../../viewer/src/refine/slates/slates.ts";

export function placed(mesh, requests, matrices, rounds) {
  const times = { fresh: [], orbit: [], bytes: 0 };
  for (let i = 0; i < rounds; i++) {
    const surface = new Slates(mesh, { isSingle: true, placements: new Placements(matrices) });
    requests.forEach(({ camera, depths, budget }, step) => {
      const pixels = camera.height / (2 * Math.tan(camera.fov / 2));
      const begin = performance.now();
      surface.update({ eye: camera.position, pixels }, depths, budget);
      const took = performance.now() - begin;
      if (i === 0 && step === 0) times.first = { fresh: took, triangles: surface.shown.triangles };
      else if (i > 0) (step ? times.orbit : times.fresh).push(took);
    });
  }
  return times;
}
