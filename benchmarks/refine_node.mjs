// Node's side of the refinement benchmark: the page's √3, bundled from its TypeScript.
//
//   node benchmarks/refine_node.mjs CASE [--rounds N]
//
// CASE is JSON: `positions`, `faces`, `limits` and `views`, one a degree further than the one before. Prints one line
// of JSON: triangles, and milliseconds of each round of: a refinement from nothing (its arrays and the triangles shown
// included), its parts, an update to the next view.

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const viewer = new URL("../viewer/", import.meta.url);
const require = createRequire(new URL("package.json", viewer));

const WARM_UP = 8;

async function scheme() {
  const { rolldown } = await import(require.resolve("rolldown"));
  const bundle = await rolldown({ input: fileURLToPath(new URL("src/refine/sqrt3.ts", viewer)) });
  const { output } = await bundle.generate({ format: "esm" });
  await bundle.close();
  return import(`data:text/javascript;base64,${Buffer.from(output[0].code).toString("base64")}`);
}

/** All that is drawn. */
function show(refined) {
  const shown = refined.faces();
  const places = new Float64Array(3 * refined.vertexSlots);
  for (let v = 0; v < refined.vertexSlots; v++) refined.place(v, false, shown, places, 3 * v);
  return shown;
}

async function main(words) {
  const at = words.indexOf("--rounds");
  const rounds = at < 0 ? 15 : Number(words.splice(at, 2)[1]);
  const { Sqrt3 } = await scheme();
  const data = JSON.parse(await readFile(words[0], "utf8"));
  const mesh = { positions: Float64Array.from(data.positions), faces: Int32Array.from(data.faces) };
  const limits = Float64Array.from(data.limits);
  const views = data.views.map((view) => Float64Array.from(view));
  const times = { fresh: [], made: [], updated: [], shown: [], orbit: [] };
  const follower = new Sqrt3(mesh);
  follower.update(views[0], limits);
  let triangles = 0;
  for (let i = 0; i < WARM_UP + rounds; i++) {
    const view = views[(i + 1) % views.length];
    const start = performance.now();
    const refined = new Sqrt3(mesh);
    const made = performance.now();
    triangles = refined.update(view, limits).faces;
    const updated = performance.now();
    show(refined);
    const shown = performance.now();
    follower.update(view, limits);
    const done = performance.now();
    if (i < WARM_UP && i > 0) continue;
    times.fresh.push(shown - start);
    times.made.push(made - start);
    times.updated.push(updated - made);
    times.shown.push(shown - updated);
    times.orbit.push(done - shown);
  }
  const first = Object.fromEntries(Object.entries(times).map(([name, all]) => [name, all.shift()]));
  console.log(JSON.stringify({ triangles, first, ...times }));
}

await main(process.argv.slice(2));
