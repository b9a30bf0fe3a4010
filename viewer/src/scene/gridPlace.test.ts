/** The vertex shader's arithmetic, in float32 as a GPU does it, on what the layer hands over. */
import { type BufferAttribute, type Mesh, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { MultiresInfo, Triple } from "../format/graph";
import type { Asset } from "../stream/asset";
import { packPatch } from "../stream/pack";
import { boxOf, type Frame, frameOf } from "./frame";
import { makeMaterials } from "./material";
import { PatchLayer } from "./patchLayer";

const { fround } = Math;
const MATERIALS = makeMaterials();
const SUPPLY = { isSettled: true, touch: () => {} };

/** A surface of 9 x 9 vertices over the whole grid, as four patches that share borders of 5 and a corner. */
const SIDE = 9;
const QUARTERS = [
  [0, 0],
  [4, 0],
  [0, 4],
  [4, 4],
] as const;

/** The greatest grid position of a box of `bits`; the surface fills the corner there, at most `REACH` wide. */
const mostOf = (bits: number): number => 2 ** bits - 1;
const REACH = 2 ** 25;

/** A point of the surface, rough enough to end in all kinds of bits. */
function gridPoint(x: number, y: number, bits: number): Triple {
  const width = Math.min(mostOf(bits), REACH);
  const height = Math.abs(Math.sin(12.9898 * x + 78.233 * y) * 43758.5453) % 1;
  const shares = [x / (SIDE - 1), y / (SIDE - 1), height];
  return shares.map((share) => mostOf(bits) - Math.round(share * width)) as unknown as Triple;
}

function layerOf(
  bits: number,
  origin: Triple,
  step: number,
): { layer: PatchLayer; info: MultiresInfo; frame: Frame } {
  const most = mostOf(bits);
  const box: MultiresInfo["box"] = [
    [0, 0, 0],
    [most, most, most],
  ];
  const info: MultiresInfo = { origin, step, box, up: "z", unit: null, triangles: 0, streams: [] };
  const graph = {
    nodes: 1,
    firstPatch: Uint32Array.of(0, 4),
    finer: Int32Array.of(-1, -1, -1, -1),
    triangles: Uint32Array.of(2, 2, 2, 2),
    errors: Float32Array.of(Infinity),
  };
  const asset = { info, graph, nodeBytes: new Float64Array(1) } as unknown as Asset;
  const frame = frameOf([boxOf(info)]);
  return { layer: new PatchLayer("a", asset, 0, frame, MATERIALS, SUPPLY), info, frame };
}

/** The local positions of each patch, five by five. */
function patchesOf(bits: number) {
  return QUARTERS.map(([left, low]) => {
    const points: number[] = [];
    for (let y = low; y < low + 5; y++)
      for (let x = left; x < left + 5; x++) points.push(...gridPoint(x, y, bits));
    const indices = Uint32Array.of(0, 1, 5, 1, 6, 5);
    return packPatch({ positions: Int32Array.from(points), indices, normals: null, colours: null });
  });
}

/** `toEye * vec4(vec3(ivec3(position) + offset), 1.0)` */
function seen(toEye: readonly number[], offset: Int32Array, local: Triple): Triple {
  const [x, y, z] = local.map((l, a) => fround((l + offset[a]!) | 0)) as unknown as [number, number, number];
  const m = toEye.map(fround);
  return [0, 1, 2].map((r) =>
    fround(fround(fround(fround(m[r]! * x) + fround(m[4 + r]! * y)) + fround(m[8 + r]! * z)) + m[12 + r]!),
  ) as unknown as Triple;
}

/** For each grid point, where each of its patches draws it, and where it is in doubles. */
function draw(layer: PatchLayer, camera: PerspectiveCamera): Map<string, Triple[]> {
  const places = new Map<string, Triple[]>();
  const { uniforms, solid } = MATERIALS;
  layer.follow(camera);
  for (const mesh of layer.group.children as Mesh[]) {
    (mesh.onBeforeRender as (...args: unknown[]) => void)(null, null, camera, null, solid);
    const positions = mesh.geometry.getAttribute("position") as BufferAttribute;
    const { centre } = mesh.userData as { centre: Triple };
    for (let v = 0; v < positions.count; v++) {
      const local: Triple = [positions.getX(v), positions.getY(v), positions.getZ(v)];
      const key = local.map((l, a) => l + centre[a]!).join();
      const all = places.get(key) ?? [];
      all.push(seen(uniforms.toEye.value.elements, uniforms.offset.value, local));
      places.set(key, all);
    }
  }
  return places;
}

/** From far away to very close to one of the surface's points, and in all directions. */
function cameras(points: readonly Triple[], count: number): PerspectiveCamera[] {
  let seed = 7;
  const random = (): number => {
    seed = (seed * 1103515245 + 12345) & 0x7fffffff;
    return seed / 0x7fffffff;
  };
  return Array.from({ length: count }, () => {
    const camera = new PerspectiveCamera(40, 1.5, 0.01, 1e5);
    const target = new Vector3(...points[Math.floor(random() * points.length)]!);
    const away = new Vector3(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
    camera.position.copy(target).addScaledVector(away, 0.01 * 10 ** (6.5 * random()));
    camera.up.set(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
    camera.lookAt(target);
    camera.updateMatrixWorld();
    return camera;
  });
}

describe.each([
  { bits: 11, origin: [0, 0, 0], step: 0.001 },
  { bits: 17, origin: [500_000.25, 4_800_000.5, 12], step: 0.001 },
  { bits: 25, origin: [-3, 1e6, 0], step: 1e-6 },
  { bits: 30, origin: [500_000.25, 4_800_000.5, 12], step: 1e-5 },
] as const)("a grid of $bits bits at $origin", ({ bits, origin, step }) => {
  const { layer, info, frame } = layerOf(bits, origin, step);
  layer.addNode(0, patchesOf(bits));
  const inFrame = (g: Triple): Triple =>
    g.map((q, a) => (info.origin[a]! - frame.centre[a]! + step * q) * frame.scale) as unknown as Triple;
  const points = QUARTERS.map(([x, y]) => inFrame(gridPoint(x, y, bits)));
  const all = cameras(points, 60);

  it("has 17 points in more than one patch, and one in all", () => {
    const counts = [...draw(layer, all[0]!).values()].map((places) => places.length);
    expect(counts.filter((count) => count > 1)).toHaveLength(17);
    expect(Math.max(...counts)).toBe(4);
  });

  it("gives a grid point the same bits in every patch, for every camera", () => {
    for (const camera of all) {
      for (const places of draw(layer, camera).values()) {
        for (const other of places) expect(other).toEqual(places[0]);
      }
    }
  });

  it("is where doubles say, to less than a thousandth of a pixel in a picture of 2000", () => {
    for (const camera of all) {
      for (const [key, places] of draw(layer, camera)) {
        const grid = key.split(",").map(Number) as unknown as Triple;
        const exact = new Vector3(...inFrame(grid)).applyMatrix4(camera.matrixWorldInverse);
        const off = exact.distanceTo(new Vector3(...places[0]!));
        // to the double's own last bit where the eye is next to the point, in UTM coordinates
        expect(off).toBeLessThan(4e-7 * exact.length() + 1e-15 * Math.hypot(...origin) * frame.scale + 1e-12);
      }
    }
  });
});
