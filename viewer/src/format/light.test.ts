import { describe, expect, it } from "vitest";
import { lightOf } from "./light";
import type { ShadowInfo } from "./shadow";

const ONE = Float64Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
const info = (light: object, count: number, children: 4 | 8 = 4): ShadowInfo => ({
  light: light as ShadowInfo["light"],
  projections: new Array(count).fill(ONE),
  levels: 3,
  children,
  images: children === 8 ? count : 1,
  spread: 0,
  parts: [3],
  trees: children === 8 ? 1 : count,
});

describe("what a shadow map's file says of its light", () => {
  it("one projection, six, or a stack", () => {
    expect(lightOf(info({ kind: "sun", time: "2026-06-21T15:00:00+02:00" }, 1), "x")).toMatchObject({
      kind: "one",
      begin: "2026-06-21T15:00:00+02:00",
      minutes: null,
      cone: null,
    });
    expect(lightOf(info({ kind: "point" }, 6), "x").kind).toBe("cube");
    expect(lightOf(info({ kind: "area", light: {} }, 4, 8), "x")).toMatchObject({ kind: "area", images: 4 });
    for (const [kind, count, children] of [
      ["sun", 6, 4],
      ["point", 1, 4],
      ["sun_path", 4, 4],
      ["sun", 1, 8],
    ] as const) {
      expect(() => lightOf(info({ kind }, count, children), "x.fov")).toThrow("x.fov is damaged");
    }
  });

  it("a spot's cone, also of what is around one", () => {
    const spot = { kind: "spot", position: [1, 2, 3], target: [1, 2, 0], angle_degrees: 90 };
    expect(lightOf(info(spot, 1), "x").cone).toEqual({
      axis: [0, 0, -3],
      cosine: expect.closeTo(Math.SQRT1_2),
    });
    const around = lightOf(info({ kind: "area", light: spot }, 4, 8), "x");
    expect(around.middle).toEqual([1, 2, 3, 1]);
    expect(around.cone?.axis).toEqual([0, 0, -3]);
    const disc = { kind: "area", light: { kind: "sun", direction: [0, 0, -2] } };
    expect(lightOf(info(disc, 4, 8), "x").middle).toEqual([-0, -0, 1, 0]);
  });

  it("the clock of a path's first image, and time from there on", () => {
    const times = ["2026-06-21T23:30:00+02:00", "2026-06-21T21:45:00+00:00", "2026-06-22T00:10:30+02:00"];
    const path = (all: unknown): unknown =>
      lightOf(info({ kind: "sun_path", times: all }, 3, 8), "x").minutes;
    expect(path(times)).toEqual([1410, 1425, 1450.5]);
    for (const bad of [undefined, times.slice(1), [...times].reverse(), ["a", "b", "c"]]) {
      expect(path(bad)).toBeNull();
    }
  });
});
