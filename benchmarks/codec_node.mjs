// Node's side of the codec benchmark: decodes a patch with foveal's WebAssembly and a mesh with draco3d, in turn.
//
//   node benchmarks/codec_node.mjs PATCH TABLES [DRACO] [--rounds N]
//
// Prints one line of JSON: vertices, triangles, and the seconds of each round of each decoder.

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const viewer = new URL("../viewer/", import.meta.url);
const require = createRequire(new URL("package.json", viewer));

const WARM_UP = 6;

/** The viewer's own decoder, bundled from its TypeScript. */
async function foveal() {
  const { rolldown } = await import(require.resolve("rolldown"));
  const bundle = await rolldown({ input: fileURLToPath(new URL("src/format/patch.ts", viewer)) });
  const { output } = await bundle.generate({ format: "esm" });
  await bundle.close();
  return import(`data:text/javascript;base64,${Buffer.from(output[0].code).toString("base64")}`);
}

/** Seconds that draco3d takes to decode to indices and float positions. */
function dracoSeconds(draco, bytes) {
  const start = performance.now();
  const decoder = new draco.Decoder();
  const buffer = new draco.DecoderBuffer();
  buffer.Init(bytes, bytes.length);
  const mesh = new draco.Mesh();
  const status = decoder.DecodeBufferToMesh(buffer, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const indices = mesh.num_faces() * 12;
  const indexPlace = draco._malloc(indices);
  decoder.GetTrianglesUInt32Array(mesh, indices, indexPlace);
  new Uint32Array(draco.HEAPF32.buffer, indexPlace, indices / 4).slice();
  draco._free(indexPlace);
  const positions = mesh.num_points() * 12;
  const attribute = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.POSITION));
  const positionPlace = draco._malloc(positions);
  decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, draco.DT_FLOAT32, positions, positionPlace);
  new Float32Array(draco.HEAPF32.buffer, positionPlace, positions / 4).slice();
  draco._free(positionPlace);
  const seconds = (performance.now() - start) / 1000;
  const triangles = mesh.num_faces();
  for (const used of [mesh, buffer, decoder]) draco.destroy(used);
  return { seconds, triangles };
}

async function main(words) {
  const roundsAt = words.indexOf("--rounds");
  const rounds = roundsAt < 0 ? 9 : Number(words.splice(roundsAt, 2)[1]);
  const [patchFile, tablesFile, dracoFile] = words;
  const { PatchDecoder } = await foveal();
  const limits = { vertices: 1 << 24, triangles: 1 << 25 };
  const decoder = await PatchDecoder.create(await readFile(tablesFile), [], limits);
  const patch = await readFile(patchFile);
  const draco = dracoFile && (await require("draco3d").createDecoderModule({}));
  const dracoBytes = dracoFile && (await readFile(dracoFile));
  // V8 compiles WebAssembly well only after some calls; a page decodes hundreds of patches, so both start warm.
  for (let round = 0; round < WARM_UP; round++) {
    decoder.decode(patch);
    if (dracoFile) dracoSeconds(draco, dracoBytes);
  }
  const result = { foveal: [], draco: [] };
  for (let round = 0; round < rounds; round++) {
    const start = performance.now();
    const { positions, indices } = decoder.decode(patch);
    result.foveal.push((performance.now() - start) / 1000);
    result.vertices = positions.length / 3;
    result.triangles = indices.length / 3;
    if (dracoFile) {
      const { seconds, triangles } = dracoSeconds(draco, dracoBytes);
      result.draco.push(seconds);
      result.draco_triangles = triangles;
    }
  }
  console.log(JSON.stringify(result));
}

await main(process.argv.slice(2));
