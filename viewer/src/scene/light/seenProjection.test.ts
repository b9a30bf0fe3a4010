import { readFileSync } from "node:fs";
import { Matrix4, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { Projection } from "../../format/light";
import { SEEN_TEXELS, SeenProjection, towardsOf } from "./seenProjection";

type Triple = [number, number, number];

interface Receiver {
  readonly matrix: number[];
  readonly levels: number;
  readonly level: number;
  readonly radius: number;
  readonly point: Triple;
  readonly normal: Triple | null;
  readonly pixel: [number, number];
  readonly step: number;
}

const golden = JSON.parse(
  readFileSync(new URL("../../../../spec/golden/shadow_lookup.json", import.meta.url), "utf8"),
);
const dot = (a: ArrayLike<number>, b: Triple): number => a[0]! * b[0] + a[1]! * b[1] + a[2]! * b[2];

/** What light.glsl makes of the texels, for a place relative to the reference. */
function lookedUp(t: Float32Array, d: Triple, normal: Triple | null, half: number): Triple {
  const texel = (i: number): Float32Array => t.subarray(4 * i, 4 * i + 4);
  const at = [0, 1, 3].map((i) => dot(texel(i), d) + texel(i)[3]!);
  let rest = dot(texel(2), d) + texel(2)[3]!;
  if (normal) {
    const slope = half * (Math.abs(dot(texel(6), normal)) + Math.abs(dot(texel(7), normal)));
    const far = (at[2]! * slope) / Math.max(1 - slope * dot(texel(3), normal), 0.5);
    const way = normal.map((n) => n * far) as Triple;
    [0, 1, 3].forEach((i, k) => {
      at[k]! += dot(texel(i), way);
    });
    rest += dot(texel(2), way) - 512;
  }
  const [px, py, high, low] = texel(4) as unknown as [number, number, number, number];
  const step = Math.max(0, Math.min(2 ** 30 - 1, high * 2 ** 15 + low + Math.floor(rest)));
  return [px + at[0]! / at[2]!, py + at[1]! / at[2]!, 4 * step];
}

/** Somewhere, turned somehow. */
const EYE = new Matrix4().makeRotationFromEuler({
  x: 0.4,
  y: -1.1,
  z: 0.2,
  order: "XYZ",
  isEuler: true,
} as never);
EYE.setPosition(120, -340, 560);

describe("a projection seen from the camera", () => {
  for (const frame of [
    { centre: [0, 0, 0], scale: 1 },
    { centre: [500_000, 4_800_000, 100], scale: 37 },
  ] as const) {
    it(`places every golden receiver, its frame being at ${frame.centre}`, () => {
      const shift = frame.centre;
      for (const receiver of golden.receivers as Receiver[]) {
        const { matrix, levels, level, radius, point, normal, pixel, step } = receiver;
        const rows = [0, 4, 8, 12].map((i) => {
          const row = matrix.slice(i, i + 4) as [number, number, number, number];
          row[3] -= dot(row, [...shift]); // the same scene elsewhere
          return row;
        }) as unknown as Projection;
        if (pixel[0] === -(2 ** 30)) continue; // behind the light
        const seen = new SeenProjection(rows, 2 ** levels, towardsOf(rows), frame);
        const place = new Vector3(...point).multiplyScalar(frame.scale);
        const reference = place.clone().add(new Vector3(1, -2, 0.5).multiplyScalar(1e-3 * frame.scale));
        const texels = new Float32Array(4 * SEEN_TEXELS);
        seen.write(EYE, reference, texels, 0);
        const turn = new Matrix4().extractRotation(EYE).invert();
        const d = place.clone().sub(reference).applyMatrix4(turn).toArray() as Triple;
        const n = normal && (new Vector3(...normal).applyMatrix4(turn).toArray() as Triple);
        const half = (radius + (level < levels ? 1.0625 : 0.5625)) * 2 ** (levels - level);
        const [x, y, found] = lookedUp(texels, d, n, half);
        const side = 2 ** (level - levels);
        for (const [got, wanted] of [
          [x * side, pixel[0]],
          [y * side, pixel[1]],
        ] as const) {
          expect(Math.abs(got - wanted - 0.5)).toBeLessThan(0.5 + 1e-3);
        }
        expect(Math.abs(found - step)).toBeLessThan(2048);
      }
    });
  }

  it("finds where the light is", () => {
    const spot: Projection = [
      [1, 0, 0.5, -2],
      [0, 1, 0.5, -3],
      [0, 0, 0.1, 0],
      [0, 0, 1, -4],
    ];
    expect(towardsOf(spot)).toEqual([0, 1, 4, 1].map((a) => expect.closeTo(a)));
    const down: Projection = [
      [0.1, 0, 0.05, 0],
      [0, 0.1, 0, 0],
      [0, 0, -0.1, 1],
      [0, 0, 0, 1],
    ];
    const [x, y, z, w] = towardsOf(down);
    expect([x, y, z].map((a) => a * Math.sqrt(1.25))).toEqual([-0.5, 0, 1].map((a) => expect.closeTo(a)));
    expect(w).toBe(0);
  });
});
