/** Polygons in files: read as they were written, and refused in a sentence whatever else the bytes are. */
import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import { parseCage } from "../format/cage";
import { parseContainer } from "../format/container";
import { polygonsOf } from "../format/polygons";
import { Problem } from "../format/problem";
import type { OpenFile } from "../stream/file";
import { readPolygons } from "./controlMesh";
import { Slates } from "./slates/slates";

describe("polygons in a file", () => {
  const folder = new URL("../../../spec/golden/", import.meta.url);
  const bytes = new Uint8Array(readFileSync(new URL("cage_polygons.fov", folder)));
  const written = JSON.parse(readFileSync(new URL("cage_polygons.json", folder), "utf8"));
  const container = parseContainer(bytes, "cage.fov", bytes.length);
  const fileOf = (head: Uint8Array) =>
    ({ source: { head, name: "cage.fov" }, container }) as unknown as OpenFile;

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
    await expect(readPolygons(fileOf(wrong), info)).rejects.toThrow("cage.fov is damaged");
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
