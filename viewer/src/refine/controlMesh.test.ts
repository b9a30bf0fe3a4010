/** Polygons in files: read as they were written, and refused in a sentence whatever else the bytes are. */
import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import { parseCage } from "../format/cage";
import { parseContainer } from "../format/container";
import { crc32 } from "../format/crc32";
import { polygonsOf } from "../format/polygons";
import { Problem } from "../format/problem";
import type { OpenFile } from "../stream/file";
import { readPlacements, readPolygons } from "./controlMesh";
import { sessionOf } from "./sessions";
import { placed } from "./slates/placed";
import { Slates } from "./slates/slates";

const folder = new URL("../../../spec/golden/", import.meta.url);

function fileOf(head: Uint8Array): OpenFile {
  const container = parseContainer(head, "cage.fov");
  return { source: { head, name: "cage.fov" }, container } as unknown as OpenFile;
}

/** The same file with another header or other chunks, and checksums that are right. */
function rewritten(file: OpenFile, header: Record<string, unknown>, chunks: Uint8Array[]): OpenFile {
  const parts = { ...file.container.header, ...header };
  const starts = [0];
  for (const chunk of chunks) starts.push(starts.at(-1)! + chunk.length);
  const head = new Uint8Array(starts.at(-1)!);
  chunks.forEach((chunk, i) => {
    head.set(chunk, starts[i]!);
  });
  const index = {
    lengths: chunks.map(({ length }) => length),
    checksums: chunks.map((chunk) => crc32(chunk)),
  };
  const container = { header: parts, starts, size: head.length, ...index };
  return { source: { head, name: "cage.fov" }, container } as unknown as OpenFile;
}

function chunksOf({ source, container }: OpenFile): Uint8Array[] {
  return [...container.lengths].map((length, i) =>
    source.head.slice(container.starts[i]!).subarray(0, length),
  );
}

/** Whether a page takes it and begins to show it; else it says so in a sentence. */
async function isShown(file: OpenFile): Promise<boolean> {
  try {
    const info = parseCage(file.container.header, "cage.fov");
    const [mesh, placements] = [await readPolygons(file, info), await readPlacements(file, info)];
    sessionOf({ scheme: "catmull-clark", mesh, placements }, info.origin, "cage.fov");
    return true;
  } catch (error) {
    expect(error).toBeInstanceOf(Problem);
    return false;
  }
}

describe("polygons in a file", () => {
  const bytes = new Uint8Array(readFileSync(new URL("cage_polygons.fov", folder)));
  const written = JSON.parse(readFileSync(new URL("cage_polygons.json", folder), "utf8"));
  const container = parseContainer(bytes, "cage.fov", bytes.length);

  test("are read as they were written, and damaged ones are not", async () => {
    const mesh = await readPolygons(fileOf(bytes), parseCage(container.header, "cage.fov"));
    const names = {
      starts: "starts",
      corners: "corners",
      creaseEdges: "crease_edges",
      creaseSharpness: "crease_sharpness",
      cornerVertices: "corner_vertices",
      cornerSharpness: "corner_sharpness",
      positions: "positions",
      colours: "colours",
      uvs: "uvs",
    } as const;
    for (const [own, theirs] of Object.entries(names)) {
      const values = [...(mesh[own as keyof typeof names] as Float32Array)];
      expect(values.map((v) => (v === Infinity ? 2 ** 100 : v))).toEqual(written[theirs].flat());
    }
    expect(mesh.boundary).toBe(written.boundary);
    expect(new Slates(mesh).cage.patches).toBe(28);
    const wrong = bytes.slice();
    wrong[bytes.length - 5]! ^= 1;
    const info = parseCage(container.header, "cage.fov");
    const torn = { ...fileOf(bytes), source: { head: wrong, name: "cage.fov" } } as unknown as OpenFile;
    await expect(readPolygons(torn, info)).rejects.toThrow("cage.fov is damaged");
  });

  test("are decoded or refused, whatever the bytes are", () => {
    const [begin, length] = [container.starts[0]!, container.lengths[0]!];
    const chunk = bytes.slice(begin, begin + length);
    const read = (data: Uint8Array, header = container.header): boolean => {
      try {
        const surface = new Slates(polygonsOf(data, header, "cage.fov"));
        surface.show([1]);
        return true;
      } catch (error) {
        expect(error).toBeInstanceOf(Problem);
        return false;
      }
    };
    expect(read(chunk)).toBe(true);
    for (let end = 0; end < length; end++) expect(read(chunk.subarray(0, end))).toBe(false);
    let refused = 0;
    for (let bit = 0; bit < 8 * length; bit += 3) {
      const flipped = chunk.slice();
      flipped[bit >> 3]! ^= 1 << (bit & 7);
      if (!read(flipped)) refused++;
    }
    expect(refused).toBeGreaterThan(100);
    for (const key of ["vertices", "faces", "corners", "creases", "sharp_corners"]) {
      for (const wrong of [0, -1, 1.5, 2 ** 31, "7", null, undefined]) {
        expect(read(chunk, { ...container.header, [key]: wrong })).toBe(false);
      }
    }
    for (const wrong of ["open", null, 3])
      expect(read(chunk, { ...container.header, boundary: wrong })).toBe(false);
    for (const wrong of [["uv", "colour"], "uv", null, [["uv"]]]) {
      expect(read(chunk, { ...container.header, attributes: wrong })).toBe(false);
    }
  });
});

describe("placements and holes in a file", () => {
  const read = (name: string) => readFileSync(new URL(name, folder));
  const placedFile = fileOf(new Uint8Array(read("cage_placed.fov")));
  const holedFile = fileOf(new Uint8Array(read("cage_holed.fov")));
  const written = JSON.parse(read("cage_placed.json").toString());
  const holed = JSON.parse(read("cage_holed.json").toString());

  test("are read as they were written, and the box holds all copies", async () => {
    const info = parseCage(placedFile.container.header, "cage.fov");
    const placements = await readPlacements(placedFile, info);
    expect([...placements!]).toEqual(written.placements.flat(2));
    const copies = placed(await readPolygons(placedFile, info), placements!);
    expect([...copies.positions]).toEqual(written.positions.flat());
    const columns = [0, 1, 2].map((x) => written.positions.map((p: number[]) => p[x]!));
    expect(info.box).toEqual([columns.map((c) => Math.min(...c)), columns.map((c) => Math.max(...c))]);
    expect(info.origin).toEqual(columns.map((c) => 0.5 * Math.min(...c) + 0.5 * Math.max(...c)));
    expect(copies.starts.length - 1).toBe(info.polygons);
    // the mirrored one is turned round, its first corner the first
    const [first, last] = [[...copies.corners.subarray(0, 4)], [...copies.corners.subarray(56, 60)]];
    expect(last.map((v) => v - 20)).toEqual([first[0], first[3], first[2], first[1]]);
    expect(await isShown(placedFile)).toBe(true);
    const once = fileOf(new Uint8Array(read("cage_polygons.fov")));
    expect(await readPlacements(once, parseCage(once.container.header, "cage.fov"))).toBeUndefined();
  });

  test("holes are those that were written, and are not counted as faces", async () => {
    const info = parseCage(holedFile.container.header, "cage.fov");
    const mesh = await readPolygons(holedFile, info);
    expect([...mesh.holes!]).toEqual(holed.holes);
    expect(info.polygons).toBe(holed.shown);
    const { cage } = new Slates(placed(mesh, (await readPlacements(holedFile, info))!));
    const shown = new Set(cage.faces.filter((_, f) => cage.isShown[f]));
    expect(shown.size).toBe(holed.shown);
    for (const f of holed.holes) expect(shown.has(f) || shown.has(f + 7)).toBe(false);
  });

  test("headers that make no sense are refused", async () => {
    const [first, second] = chunksOf(holedFile) as [Uint8Array, Uint8Array];
    expect(await isShown(rewritten(holedFile, {}, [first, second]))).toBe(true);
    for (const wrong of [0, -1, 1, 3, 2.5, 2 ** 31, 1e300, "2", null, undefined, [2]]) {
      const placements = wrong;
      expect(await isShown(rewritten(holedFile, { placements }, [first, second])), `${wrong}`).toBe(false);
      if (wrong !== 2.5 && wrong !== 3) continue;
      expect(await isShown(rewritten(holedFile, { holes: wrong }, [first, second])), `${wrong}`).toBe(false);
    }
    const large = rewritten(holedFile, { corners: 2 ** 25 + 1 }, [first, second]);
    const info = parseCage(large.container.header, "cage.fov");
    await expect(readPlacements(large, info)).rejects.toThrow("cage.fov is damaged"); // in all places too many
    expect(await isShown(rewritten(holedFile, {}, [first]))).toBe(false);
    expect(await isShown(rewritten(holedFile, {}, [first, second, second]))).toBe(false);
    for (const holes of [
      [3, 1],
      [1, 1],
      [1, 7],
      [2 ** 32 - 1, 1],
    ]) {
      const wrong = first.slice();
      wrong.set(new Uint8Array(Uint32Array.from(holes).buffer), first.length - 8);
      expect(await isShown(rewritten(holedFile, {}, [wrong, second])), `${holes}`).toBe(false);
    }
  });

  test("are decoded or refused, whatever the bytes are", async () => {
    const [first, second] = chunksOf(holedFile) as [Uint8Array, Uint8Array];
    for (let end = 0; end < second.length; end++) {
      expect(await isShown(rewritten(holedFile, {}, [first, second.subarray(0, end)]))).toBe(false);
    }
    let refused = 0;
    for (let bit = 0; bit < 8 * second.length; bit++) {
      const flipped = second.slice();
      flipped[bit >> 3]! ^= 1 << (bit & 7);
      if (!(await isShown(rewritten(holedFile, {}, [first, flipped])))) refused++;
    }
    expect(refused).toBeGreaterThan(2 * 4 * 64); // the last rows alone
    for (let bit = 8 * (first.length - 8); bit < 8 * first.length; bit++) {
      const flipped = first.slice();
      flipped[bit >> 3]! ^= 1 << (bit & 7);
      const isLeft = (bit & 31) < 3; // other faces there are
      if (!isLeft) expect(await isShown(rewritten(holedFile, {}, [flipped, second]))).toBe(false);
      else await isShown(rewritten(holedFile, {}, [flipped, second]));
    }
  });
});
