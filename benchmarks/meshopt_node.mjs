// A peer of the codec benchmark: meshoptimizer's codecs with Brotli over them.
//
//   node benchmarks/meshopt_node.mjs POSITIONS INDICES [--rounds N]
//
// POSITIONS has four uint16 a vertex (the last is 0), INDICES three uint32 a triangle. Prints one line of JSON: the
// bytes, and the seconds of each round of decoding, Brotli's included.

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { brotliCompressSync, brotliDecompressSync } from "node:zlib";

const require = createRequire(new URL("../viewer/package.json", import.meta.url));
const { MeshoptEncoder, MeshoptDecoder } = require("meshoptimizer");
await Promise.all([MeshoptEncoder.ready, MeshoptDecoder.ready]);

const words = process.argv.slice(2);
const roundsAt = words.indexOf("--rounds");
const rounds = roundsAt < 0 ? 9 : Number(words.splice(roundsAt, 2)[1]);
const [positions, indexBytes] = await Promise.all(words.map((file) => readFile(file)));
const stride = 8;
const indices = new Uint32Array(indexBytes.buffer.slice(indexBytes.byteOffset, indexBytes.byteOffset + indexBytes.length));

const [remap, vertices] = MeshoptEncoder.reorderMesh(indices, true, false);
const ordered = new Uint8Array(vertices * stride);
remap.forEach((to, from) => {
  if (to !== 0xffffffff) ordered.set(positions.subarray(from * stride, (from + 1) * stride), to * stride);
});
const vertexData = brotliCompressSync(MeshoptEncoder.encodeVertexBuffer(ordered, vertices, stride));
const indexData = brotliCompressSync(
  MeshoptEncoder.encodeIndexBuffer(new Uint8Array(indices.buffer), indices.length, 4),
);

const seconds = [];
for (let round = 0; round < rounds; round++) {
  const start = performance.now();
  MeshoptDecoder.decodeVertexBuffer(new Uint8Array(vertices * stride), vertices, stride, brotliDecompressSync(vertexData));
  MeshoptDecoder.decodeIndexBuffer(new Uint8Array(indices.length * 4), indices.length, 4, brotliDecompressSync(indexData));
  seconds.push((performance.now() - start) / 1000);
}
console.log(JSON.stringify({ bytes: vertexData.length + indexData.length, vertices, seconds }));
