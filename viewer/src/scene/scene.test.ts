import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { ErrorTarget } from "./adapt";
import { defaultBudgets } from "./device";
import { Fade } from "./fade";
import { frameOf, fromFrame, SCENE_RADIUS, toFrame } from "./frame";
import { type Rgb, shade } from "./shading";

describe("shading", () => {
  const golden = JSON.parse(
    readFileSync(new URL("../../../spec/golden/shading.json", import.meta.url), "utf8"),
  );

  it("agrees with every golden case", () => {
    type Case = { colour: Rgb; normal: Rgb; facing: Rgb; shadow?: number; pixel: Rgb };
    for (const { colour, normal, facing, shadow, pixel } of golden.cases as Case[]) {
      shade(colour, normal, facing, shadow).forEach((byte, i) => {
        expect(Math.abs(byte - pixel[i]!)).toBeLessThanOrEqual(1);
      });
    }
  });
});

describe("fade", () => {
  /** A diamond: 0 over 1 and 2, both over 3. */
  const PARENTS = [[], [0], [0], [1, 2]];

  it("keeps every node at or below its parents, whatever comes and goes", () => {
    const fade = new Fade(4, 150);
    let seed = 12345;
    const random = () => {
      seed = (seed * 1103515245 + 12345) & 0x7fffffff;
      return seed / 0x7fffffff;
    };
    const wish = [1, 0, 0, 0];
    for (let step = 0; step < 3000; step++) {
      wish[1 + Math.floor(random() * 3)] = random() < 0.5 ? 1 : 0;
      const expanded = new Uint8Array(4);
      PARENTS.forEach((parents, node) => {
        expanded[node] = wish[node]! && parents.every((parent) => expanded[parent]) ? 1 : 0;
      });
      fade.advance(expanded, random() * 60);
      PARENTS.forEach((parents, node) => {
        for (const parent of parents)
          expect(fade.phase[node]!).toBeLessThanOrEqual(fade.phase[parent]! + 1e-6);
      });
    }
  });

  it("takes its time, or none", () => {
    const expanded = new Uint8Array([1, 1]);
    const fade = new Fade(2, 150);
    fade.advance(expanded, 75);
    expect([...fade.phase]).toEqual([1, 0.5]);
    expect(fade.isMoving).toBe(true);
    fade.advance(expanded, 80);
    expect([...fade.phase]).toEqual([1, 1]);
    expect(fade.isMoving).toBe(false);
    const sudden = new Fade(2, 0);
    sudden.advance(expanded, 1);
    expect([...sudden.phase]).toEqual([1, 1]);
  });

  it("ends whatever the steps, and when its node goes", () => {
    for (let milliseconds = 1; milliseconds < 160; milliseconds += 1 / 6) {
      const fade = new Fade(2, 150);
      const expanded = Uint8Array.of(1, 1);
      for (let passed = 0; passed < 150 + 2 * milliseconds; passed += milliseconds) {
        fade.advance(expanded, milliseconds);
      }
      expect(fade.isMoving).toBe(false); // else frames would be drawn for ever
      fade.advance(Uint8Array.of(1, 0), 10);
      expect(fade.isMoving).toBe(true);
      fade.forget(1);
      expect(fade.isMoving).toBe(false);
    }
  });
});

describe("error target", () => {
  /** Frames of a machine that draws so many milliseconds a picture at one pixel; cost falls as the error rises. */
  function run(target: ErrorTarget, costAtOnePixel: number, frames: number): number {
    for (let i = 0; i < frames; i++) target.frame(16.7 + costAtOnePixel / target.pixels(true));
    return target.pixels(true);
  }

  it("rises on a slow machine to where frames are in time, and rests there", () => {
    const target = new ErrorTarget(1);
    const there = run(target, 80, 200);
    expect(16.7 + 80 / there).toBeCloseTo(25, 0);
    expect(run(target, 80, 50)).toBeCloseTo(there, 1);
  });

  it("falls back to the visitor's own when frames are quick again, and at rest at once", () => {
    const target = new ErrorTarget(2);
    run(target, 800, 100);
    expect(target.pixels(true)).toBeGreaterThan(4);
    expect(target.pixels(false)).toBe(2);
    expect(run(target, 0, 200)).toBe(2);
  });

  it("has an end, and does not take a pause for a slow frame", () => {
    const target = new ErrorTarget(1);
    for (let i = 0; i < 200; i++) target.frame(350);
    expect(target.pixels(true)).toBeCloseTo(16);
    const calm = new ErrorTarget(1);
    run(calm, 0, 5);
    calm.frame(60_000);
    expect(calm.pixels(true)).toBe(1);
  });
});

describe("frame", () => {
  it("brings UTM coordinates to the middle and back without loss", () => {
    const origin = [500_000.25, 4_800_000.5, 12] as const;
    const info = {
      origin,
      step: 0.001,
      box: [
        [0, 0, 0],
        [1000, 2000, 2000],
      ],
    };
    const frame = frameOf([{ info }] as unknown as Parameters<typeof frameOf>[0]);
    expect(frame.scale).toBeCloseTo(SCENE_RADIUS / 1.5);
    const point = [500_000.123456, 4_800_001.654321, 12.5] as const;
    fromFrame(frame, toFrame(frame, point)).forEach((x, a) => {
      expect(Math.abs(x - point[a]!)).toBeLessThan(2e-9);
    });
  });

  it("gives small devices a quarter", () => {
    const desktop = defaultBudgets({ isCoarse: false, memoryGiB: 8 });
    for (const small of [
      { isCoarse: true, memoryGiB: undefined },
      { isCoarse: false, memoryGiB: 2 },
    ]) {
      expect(defaultBudgets(small)).toMatchObject({
        triangles: desktop.triangles / 4,
        bytes: desktop.bytes / 4,
      });
    }
  });
});
