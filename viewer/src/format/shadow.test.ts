/** Shadow files: the golden ones level by level, and no byte that can do harm. */
import { readFileSync } from "node:fs";
import { describe, expect, it, test } from "vitest";
import { headLength, parseContainer } from "./container";
import { Problem } from "./problem";
import { parseShadow, ShadowReader } from "./shadow";
import { pack } from "./shadowPack";

const GOLDEN = new URL("../../../spec/golden/", import.meta.url);
const CASES = ["map", "six", "stack", "any", "one_value"];
/** Of the small file every byte and prefix is tried, of the others some. */
const STRIDE: Readonly<Record<string, number>> = { any: 1, stack: 13, map: 29 };
const HEADER = {
  kind: "shadow",
  version: 1,
  light: { kind: "directional" },
  projections: [
    [
      [1, 0, 0, 0],
      [0, 1, 0, 0],
      [0, 0, 1, 0],
      [0, 0, 0, 1],
    ],
  ],
  levels: 3,
  children: 4,
  parts: [1, 3],
};

function open(name: string) {
  const file = new Uint8Array(readFileSync(new URL(`shadow_tree_${name}.fov`, GOLDEN)));
  const { header, starts, lengths } = parseContainer(
    file.subarray(0, headLength(file, name)),
    name,
    file.length,
  );
  const chunks = Array.from(lengths, (length, i) => file.subarray(starts[i]!, starts[i]! + length));
  return { info: parseShadow(header, name), chunks };
}

describe.each(CASES)("the golden file %s", (name) => {
  const expected = JSON.parse(readFileSync(new URL(`shadow_tree_${name}.json`, GOLDEN), "utf8"));
  const { info, chunks } = open(name);

  it("has the header that was written", () => {
    expect(info.light).toEqual(expected.light);
    expect(info.projections.map((m) => [...m])).toEqual(
      expected.projections.map((m: number[][]) => m.flat()),
    );
    expect(info).toMatchObject({ levels: expected.levels, children: expected.children });
    expect(info.images).toBe(info.children === 8 ? expected.projections.length : 1);
  });

  it("is a finer map with each part, and the same words", () => {
    const reader = new ShadowReader(info, chunks[0]!, name);
    expect(reader.chunks).toBe(chunks.length);
    expect(reader.levels).toBe(-1);
    const found = [];
    for (const chunk of chunks.slice(1)) {
      if (!reader.push(chunk)) continue;
      const trees = reader.trees().map((tree) => {
        expect(tree).toMatchObject({ levels: reader.levels, children: info.children });
        const packed = pack(tree, name);
        return {
          root: tree.root,
          spread: info.children === 8 ? info.spread - (info.levels - tree.levels) : 0,
          masks: [...tree.masks],
          mask_starts: tree.maskStarts,
          values: [...tree.values],
          value_starts: tree.valueStarts,
          words: [...packed.words],
          scales: packed.scales,
        };
      });
      found.push({ levels: reader.levels, trees });
    }
    expect(found).toEqual(expected.parts);
    expect(() => reader.push(chunks[1]!)).toThrow(Problem);
  });
});

/** Levels that come from damaged chunks: what is read is a tree whose words can be made. */
function readAll(name: string, chunks: readonly Uint8Array[]): number {
  const { info } = open(name);
  const reader = new ShadowReader(info, chunks[0]!, name);
  for (const chunk of chunks.slice(1)) reader.push(chunk);
  for (const tree of reader.trees()) pack(tree, name);
  return reader.levels;
}

function isRefused(name: string, chunks: readonly Uint8Array[]): boolean {
  try {
    readAll(name, chunks);
    return false;
  } catch (error) {
    expect(error).toBeInstanceOf(Problem);
    return true;
  }
}

test.each(["any", "stack"])("prefixes of every chunk of %s are refused", (name) => {
  const { chunks } = open(name);
  for (const [number, chunk] of chunks.entries()) {
    for (let end = 0; end < chunk.length; end += STRIDE[name]!) {
      expect(isRefused(name, chunks.with(number, chunk.subarray(0, end)))).toBe(true);
    }
  }
});

test.each(["any", "stack", "map"])("bytes of %s may be others", (name) => {
  const { chunks } = open(name);
  let refused = 0;
  let flips = 0;
  for (const [number, chunk] of chunks.entries()) {
    for (let at = 0; at < chunk.length; at += STRIDE[name]!) {
      const flipped = chunk.slice();
      flipped[at]! ^= 1 << (at % 8);
      flips++;
      if (isRefused(name, chunks.with(number, flipped))) refused++;
    }
  }
  expect(refused).toBeGreaterThan(0.6 * flips);
});

test("counts ask for no more memory than bytes can fill", () => {
  const info = parseShadow({ ...HEADER, levels: 20, parts: [20] }, "a");
  const masks = Array.from({ length: 20 }, (_, level) => Math.min(4 ** level, 2 ** 31));
  const words = Uint32Array.from([3, ...masks, 1, ...masks]);
  const reader = new ShadowReader(info, new Uint8Array(words.buffer), "a");
  expect(() => reader.push(new Uint8Array(1000))).toThrow(Problem);
});

test("a header that makes no sense is refused in a sentence", () => {
  expect(parseShadow(HEADER, "a")).toMatchObject({ levels: 3, children: 4, images: 1, trees: 1 });
  const wrong: object[] = [
    { version: 2 },
    { light: undefined },
    { light: [] },
    { levels: 25 },
    { levels: 2.5 },
    { levels: 4 },
    { children: 5 },
    { projections: [] },
    { projections: [[1, 2]] },
    { projections: [HEADER.projections[0]!.flat()] },
    { projections: [[[], ...HEADER.projections[0]!.slice(1)]] },
    { parts: [] },
    { parts: [2, 2, 3] },
    { parts: [-1, 3] },
    { parts: ["1", 3] },
    { parts: null },
  ];
  for (const change of wrong) expect(() => parseShadow({ ...HEADER, ...change }, "a")).toThrow(Problem);
  expect(() => parseShadow({ ...HEADER, version: 2 }, "a.fov")).toThrow(/a\.fov has version 2/);
});

test("a stack has one tree, a point light six", () => {
  const many = { ...HEADER, projections: new Array(6).fill(HEADER.projections[0]) };
  expect(parseShadow(many, "a")).toMatchObject({ images: 1, trees: 6 });
  expect(parseShadow({ ...many, children: 8 }, "a")).toMatchObject({ images: 6, trees: 1, spread: 0 });
  for (const spread of [1, -1, 0.5, "1"]) {
    expect(() => parseShadow({ ...many, children: 8, spread }, "a")).toThrow(Problem);
  }
});
