import { describe, expect, it } from "vitest";
import { headLength, parseContainer } from "./container";
import { crc32 } from "./crc32";
import { parentsOf, parseGraph, parseInfo } from "./graph";
import { Problem } from "./problem";
import { fovFile, graphChunk, HEADER, PATCHES } from "./small.fixture";

const file = fovFile();
const name = "small.fov";

function openGraph(bytes: Uint8Array) {
  const container = parseContainer(bytes, name, bytes.length);
  const chunk = bytes.subarray(container.starts[0], container.starts[0]! + container.lengths[0]!);
  return { container, ...parseGraph(chunk, container, name) };
}

describe("crc32", () => {
  it("gives zlib's values", () => {
    expect(crc32(new TextEncoder().encode("123456789"))).toBe(0xcbf43926);
    expect(crc32(new Uint8Array(0))).toBe(0);
  });

  it("goes on from what came before, at every cut", () => {
    const bytes = Uint8Array.from({ length: 37 }, (_, i) => (i * 73 + 11) & 255);
    for (let cut = 0; cut <= bytes.length; cut++) {
      expect(crc32(bytes.subarray(cut), crc32(bytes.subarray(0, cut)))).toBe(crc32(bytes));
    }
  });
});

describe("container", () => {
  it("knows where chunks are", () => {
    const { container, graph, tables } = openGraph(file);
    expect(container.size).toBe(file.length);
    PATCHES.forEach((patch, i) => {
      const start = container.starts[i + 1]!;
      expect(file.subarray(start, start + container.lengths[i + 1]!)).toEqual(patch);
    });
    expect([...graph.finer]).toEqual([1, -1]);
    expect(graph.errors[0]).toBe(Number.POSITIVE_INFINITY);
    expect([...tables]).toEqual([10, 20]);
    expect(parentsOf(graph)).toEqual({ first: new Uint32Array([0, 0, 1]), parents: new Uint32Array([0]) });
  });

  it("refuses every prefix", () => {
    for (let length = 0; length < file.length; length++) {
      expect(() => parseContainer(file.subarray(0, length), name, length)).toThrow(Problem);
    }
  });

  it("refuses a file that is longer than its index says", () => {
    expect(() => parseContainer(file, name, file.length + 4)).toThrow(/not copied whole/);
  });

  it("refuses every flipped bit of what the checksum covers, and of the prefix", () => {
    const covered = headLength(file, name);
    for (let bit = 0; bit < covered * 8; bit++) {
      if (bit >> 3 === 6 || bit >> 3 === 7) continue; // reserved
      const damagedFile = file.slice();
      damagedFile[bit >> 3]! ^= 1 << (bit & 7);
      expect(() => parseContainer(damagedFile, name, file.length), `bit ${bit}`).toThrow(Problem);
    }
  });

  it("survives every flipped bit of the graph, with a sentence or a graph that holds its laws", () => {
    const { container } = openGraph(file);
    const chunk = graphChunk();
    for (let bit = 0; bit < chunk.length * 8; bit++) {
      const flipped = chunk.slice();
      flipped[bit >> 3]! ^= 1 << (bit & 7);
      try {
        const { graph } = parseGraph(flipped, container, name);
        expect(graph.firstPatch[graph.nodes]).toBe(graph.patches);
        graph.finer.forEach((node) => {
          expect(node).toBeLessThan(graph.nodes);
        });
      } catch (error) {
        expect(error).toBeInstanceOf(Problem);
      }
    }
  });

  it("says which version it does not know", () => {
    const newer = file.slice();
    newer[4] = 9;
    expect(() => headLength(newer, name)).toThrow(/container version 9/);
    const info = (header: object) => parseInfo({ ...HEADER, ...header }, name);
    expect(() => info({ kind: "shadows" })).toThrow(/kind "shadows"/);
    expect(() => info({ version: 2 })).toThrow(/version 2/);
    expect(() => info({ step: 0 })).toThrow(Problem);
    expect(() => info({ origin: [0, 0, "x"] })).toThrow(Problem);
    expect(() => info({ box: [[0, 0, 0]] })).toThrow(Problem);
    expect(info({ later: true }).up).toBe("z");
  });

  it("refuses graphs that go round or leave their range", () => {
    for (const finer of [
      [0, -1],
      [2, -1],
      [-2, -1],
      [1, 1],
      [1, 0],
    ]) {
      expect(() => openGraph(fovFile(HEADER, [graphChunk(finer), ...PATCHES])), String(finer)).toThrow(
        Problem,
      );
    }
  });

  it("says that something else is not a .fov", () => {
    for (const text of ["", "ply\n", "<!doctype html><html>".repeat(9)]) {
      expect(() => headLength(new TextEncoder().encode(text), name)).toThrow(/not a .fov/);
    }
  });
});
