import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { countLit, type Place, valueAt } from "./shadowTree";

const read = (name: string): Buffer => readFileSync(new URL(`../../../spec/golden/${name}`, import.meta.url));

interface Tree {
  readonly name: string;
  readonly levels: number;
  readonly children: number;
  readonly root: number;
  readonly scales: number[];
  readonly word_start: number;
  readonly word_count: number;
  readonly values: { level: number; pixels: Place[]; values: number[] }[];
  readonly lit: { level: number; radius: number; pixels: Place[]; steps: number[]; lit: number[] }[];
}

describe("shadow trees", () => {
  const golden = JSON.parse(read("shadow_lookup.json").toString());
  const bytes = read("shadow_lookup.bin");
  const all = new Uint32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));

  for (const tree of golden.trees as Tree[]) {
    const words = all.subarray(tree.word_start, tree.word_start + tree.word_count);
    const packed = { ...tree, words };

    it(`${tree.name}: every level is a map of values`, () => {
      for (const { level, pixels, values } of tree.values) {
        expect(pixels.map((pixel) => valueAt(packed, pixel, level))).toEqual(values);
      }
    });

    it(`${tree.name}: kernels count what is lit`, () => {
      for (const { level, radius, pixels, steps, lit } of tree.lit) {
        const counts = pixels.map((pixel, i) => countLit(packed, pixel, steps[i]!, radius, level));
        expect(counts).toEqual(lit);
      }
    });
  }
});
