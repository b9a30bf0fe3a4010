/** The WebAssembly patch decoder: golden patches shared with Python, and every kind of damage. */

import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import { compile } from "../../assembly/build.mjs";
import { octahedralToInt8, PatchDecoder, type PatchStream } from "./patch";

const golden = new URL("../../../spec/golden/", import.meta.url);
const read = (name: string): Uint8Array => new Uint8Array(readFileSync(new URL(name, golden)));
const tables = read("patch_tables.bin");
const names = readdirSync(golden)
  .filter((name) => name.startsWith("patch_") && name.endsWith(".json"))
  .map((name) => name.slice("patch_".length, -".json".length));

interface Expected {
  positions: number[][];
  faces: number[][];
  normals: number[][] | null;
  colours: number[][] | null;
}

function load(name: string): { bytes: Uint8Array; expected: Expected; streams: PatchStream[] } {
  const bytes = read(`patch_${name}.bin`);
  const expected = JSON.parse(readFileSync(new URL(`patch_${name}.json`, golden), "utf8")) as Expected;
  const streams: PatchStream[] = [{ name: "position", type: "grid3" }];
  if (expected.normals) streams.push({ name: "normal", type: "octahedron", bits: 10 });
  if (expected.colours) streams.push({ name: "colour", type: "srgb8" });
  return { bytes, expected, streams };
}

describe("golden patches", () => {
  test.each(names)("%s decodes as in Python", async (name) => {
    const { bytes, expected, streams } = load(name);
    const patch = (await PatchDecoder.create(tables, streams)).decode(bytes);
    expect([...patch.positions]).toEqual(expected.positions.flat());
    expect([...patch.indices]).toEqual(expected.faces.flat());
    expect(patch.normals && [...patch.normals]).toEqual(expected.normals?.flat() ?? null);
    expect(patch.colours && [...patch.colours]).toEqual(expected.colours?.flat() ?? null);
  });

  test("one decoder reads large and small patches in turn, into arrays of exact size", async () => {
    const [large, small] = [load("torus"), load("tetrahedron")];
    const decoder = await PatchDecoder.create(tables, large.streams);
    for (const { bytes, expected } of [small, large, small, large]) {
      const { positions, indices } = decoder.decode(bytes);
      expect([...positions]).toEqual(expected.positions.flat());
      expect(indices.buffer.byteLength).toBe(12 * expected.faces.length);
    }
  });
});

describe("damage", () => {
  const isPatch = (decoder: PatchDecoder, bytes: Uint8Array): boolean => {
    try {
      const { positions, indices } = decoder.decode(bytes);
      for (const index of indices)
        if (index >= positions.length / 3) throw new RangeError("index out of range");
      return true;
    } catch (error) {
      if (!(error instanceof Error) || !/again|larger/.test(error.message)) throw error;
      return false;
    }
  };

  test.each(["all", "non_manifold", "coarse"])("every prefix of %s is refused", async (name) => {
    const { bytes, streams } = load(name);
    const decoder = await PatchDecoder.create(tables, streams);
    for (let end = 0; end < bytes.length; end++) expect(isPatch(decoder, bytes.subarray(0, end))).toBe(false);
  });

  test.each(["holes", "non_manifold", "triangle", "coarse", "normals"])(
    "every flipped bit of %s is refused or gives indices in range",
    async (name) => {
      const { bytes, streams } = load(name);
      const decoder = await PatchDecoder.create(tables, streams, { vertices: 2000, triangles: 2000 });
      let refused = 0;
      for (let bit = 0; bit < 8 * bytes.length; bit++) {
        const broken = bytes.slice();
        broken[bit >> 3] = (broken[bit >> 3] as number) ^ (1 << (bit & 7));
        refused += isPatch(decoder, broken) ? 0 : 1;
      }
      // Some bits are raw ones: they move a vertex and nothing else. The container has checksums for those.
      expect(refused).toBeGreaterThan(0);
    },
    60_000,
  );

  test("noise is refused", async () => {
    const decoder = await PatchDecoder.create(tables, load("all").streams);
    let state = 12345;
    const random = (): number => {
      state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
      return state >>> 24;
    };
    for (let round = 0; round < 2000; round++) {
      const noise = Uint8Array.from({ length: 11 + (round % 64) * 2 }, random);
      noise[0] = random() & 127;
      noise[1] = random() & 127;
      noise[2] = 0;
      expect(isPatch(decoder, noise)).toBe(false);
    }
  });

  test("every flipped bit of the tables is refused or harmless", async () => {
    const { bytes, streams } = load("all");
    for (let bit = 0; bit < 8 * tables.length; bit += 11) {
      const broken = tables.slice();
      broken[bit >> 3] = (broken[bit >> 3] as number) ^ (1 << (bit & 7));
      const decoder = await PatchDecoder.create(broken, streams).catch((error: Error) => {
        expect(error.message).toMatch(/again/);
        return null;
      });
      if (decoder) isPatch(decoder, bytes);
    }
  }, 60_000);

  test("tables that end early are refused", async () => {
    for (const end of [0, 1, 2, 100, 400, tables.length - 1]) {
      await expect(PatchDecoder.create(tables.subarray(0, end), [])).rejects.toThrow("tables are damaged");
    }
  });

  test("a patch larger than allowed is refused before memory is taken", async () => {
    const decoder = await PatchDecoder.create(tables, []);
    const huge = Uint8Array.from([255, 255, 255, 255, 7, 255, 255, 255, 255, 7, ...new Uint8Array(40)]);
    expect(() => decoder.decode(huge)).toThrow("larger than allowed");
  });
});

test("the embedded WebAssembly is the one that assembly/ compiles to", async () => {
  const text = readFileSync(new URL("patch.wasm.ts", import.meta.url), "utf8");
  expect(text, "run `node assembly/build.mjs` in viewer/").toBe(await compile());
}, 60_000);

test("octahedral pairs as signed bytes point the same way", () => {
  const bytes = octahedralToInt8(Int16Array.from([0, 0, 511, 0, 0, -511, 511, 511, -512, -512]), 10);
  expect([...bytes]).toEqual([0, 0, 127, 0, 127, 0, 0, 0, 0, -127, 0, 0, 0, 0, -127, 0, 0, 0, 0, 0]);
});
