/**
 * Decoding speed of entropy coders in Node: `node entropy_node.mjs CASES.json` prints JSON.
 *
 * A case is { coder, data, expected (base64), count, tables }; the answer to each is the seconds of every
 * run, with its tables built in each (`whole`) and built once (`shared`). Coders run in turns.
 */
import { readFileSync } from "node:fs";
import { performance } from "node:perf_hooks";
import { buildHuffman, decodeHuffman } from "./js/huffman.mjs";
import { decodeLzma } from "./js/lzma.mjs";
import { buildRans, decodeRans } from "./js/rans.mjs";
import { buildTunstall, decodeTunstall } from "./js/tunstall.mjs";

const words = (bytes) => {
  const out = new Uint16Array((bytes.length >> 1) + 2);
  for (let i = 0; i + 1 < bytes.length; i += 2) out[i >> 1] = bytes[i] | (bytes[i + 1] << 8);
  return out;
};

const CODERS = {
  tunstall: { build: (t) => buildTunstall(t.frequencies, t.bits), decode: decodeTunstall },
  huffman: { build: (t) => buildHuffman(t.lengths, t.bits), decode: decodeHuffman },
  rans: { build: (t) => buildRans(t.frequencies, t.bits), decode: decodeRans, input: words },
  lzma: { build: () => null, decode: (_, bytes, out) => decodeLzma(bytes, out) },
};

function prepare({ coder, data, expected, count, tables }) {
  const { build, decode, input = (bytes) => bytes } = CODERS[coder];
  const bytes = new Uint8Array(Buffer.from(data, "base64"));
  const out = new Uint8Array(count);
  const source = input(bytes);
  const code = build(tables);
  decode(code, source, out);
  if (Buffer.compare(Buffer.from(out), Buffer.from(expected, "base64")) !== 0) {
    throw new Error(`${coder}: the symbols that come out are not those that went in`);
  }
  return {
    whole: () => decode(build(tables), source, out),
    shared: () => decode(code, source, out),
  };
}

function seconds(work, repeats) {
  const begin = performance.now();
  for (let i = 0; i < repeats; i++) work();
  return (performance.now() - begin) / 1000 / repeats;
}

const { cases, runs } = JSON.parse(readFileSync(process.argv[2], "utf8"));
const works = cases.map(prepare);
for (const work of works) {
  for (const kind of ["whole", "shared"]) seconds(work[kind], 20); // let the compiler see it
}
const times = works.map(() => ({ whole: [], shared: [] }));
for (let run = 0; run < runs; run++) {
  works.forEach((work, i) => {
    for (const kind of ["whole", "shared"]) {
      const repeats = Math.max(1, Math.min(200, Math.floor(0.02 / seconds(work[kind], 1))));
      times[i][kind].push(seconds(work[kind], repeats));
    }
  });
}
console.log(JSON.stringify({ node: process.version, times }));
