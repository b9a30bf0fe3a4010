import { readFileSync } from "node:fs";
import { type LineSegments, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { defaultBudgets } from "./device";
import { Fade } from "./fade";
import { boxOf, frameOf, fromFrame, SCENE_RADIUS, toFrame } from "./frame";
import { FrameClock } from "./frameClock";
import { Inset } from "./inset";
import { LEAST_TRIANGLES, MotionBudget } from "./motionBudget";
import { decode, encode, type Rgb, shade, shadeFast } from "./shading";
import { turned } from "./turn";

describe("shading", () => {
  const golden = JSON.parse(
    readFileSync(new URL("../../../spec/golden/shading.json", import.meta.url), "utf8"),
  );

  it("agrees with every golden case", () => {
    type Case = { colour: Rgb; normal: Rgb; facing: Rgb; shadow?: number; to_light?: Rgb; pixel: Rgb };
    const cases: Case[] = [...golden.cases, ...golden.with_light];
    for (const { colour, normal, facing, shadow, to_light, pixel } of cases) {
      shade(colour, normal, facing, shadow, to_light).forEach((byte, i) => {
        expect(Math.abs(byte - pixel[i]!)).toBeLessThanOrEqual(1);
      });
    }
  });

  it("is in the shader the same within a third of a level, for every colour in every light", () => {
    for (let byte = 0; byte < 256; byte++) {
      for (let light = 0.08; light <= 1.15; light += 0.001) {
        const true_ = encode(Math.min(1, decode(byte / 255) * light));
        expect(255 * Math.abs(shadeFast(byte / 255, light) - true_)).toBeLessThan(1 / 3);
      }
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
    const slow = new Fade(2, 150);
    slow.advance(expanded, 76); // a single step between would be no fade
    expect([...slow.phase]).toEqual([1, 1]);
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

describe("motion budget", () => {
  /** Frames of a machine that takes so long for the rest of a picture, and for a million triangles. */
  function run(budget: MotionBudget, rest: number, million: number, frames: number, wish = 1e6): number {
    const late = [wish, wish]; // what was asked for shows in the interval after the next
    for (let i = 0; i < frames; i++) {
      late.push(Math.min(wish, budget.triangles));
      const drawn = late.shift()!;
      budget.frame(rest + (drawn * million) / 1e6, drawn, true);
    }
    return Math.min(wish, budget.triangles);
  }

  it("leaves a quick machine alone", () => {
    const budget = new MotionBudget();
    run(budget, 10, 10, 500);
    expect(budget.triangles).toBe(Number.POSITIVE_INFINITY);
  });

  it("falls on a slow machine to where frames are in time, and stays about there", () => {
    const budget = new MotionBudget();
    run(budget, 10, 100, 60);
    for (let i = 0; i < 40; i++) {
      const milliseconds = 10 + (run(budget, 10, 100, 5) * 100) / 1e6;
      expect(milliseconds).toBeGreaterThan(15);
      expect(milliseconds).toBeLessThan(32);
    }
  });

  it("goes by another time where another rate is wanted", () => {
    const budget = new MotionBudget();
    budget.aimMs = 60;
    run(budget, 10, 100, 60);
    for (let i = 0; i < 20; i++) {
      const milliseconds = 10 + (run(budget, 10, 100, 5) * 100) / 1e6;
      expect(milliseconds).toBeGreaterThan(45);
      expect(milliseconds).toBeLessThan(70);
    }
  });

  it("is there in a dozen frames where frames take half a second", () => {
    const budget = new MotionBudget();
    expect(10 + (run(budget, 10, 500, 16) * 500) / 1e6).toBeLessThan(50);
  });

  it("keeps a least, which costs little, where the rest of the picture is what takes the time", () => {
    const budget = new MotionBudget();
    expect(run(budget, 90, 300, 100)).toBe(LEAST_TRIANGLES);
    run(budget, 10, 10, 2000);
    expect(budget.triangles).toBeGreaterThan(1e6); // and comes back
  });

  it("does not take for tried what was not used", () => {
    const budget = new MotionBudget();
    const there = run(budget, 10, 100, 100);
    run(budget, 10, 100, 1000, 1000); // far away there is next to nothing to draw
    expect(budget.triangles).toBeLessThan(2 * there);
  });

  it("learns from frames at rest, where it rules nothing, without running away", () => {
    const budget = new MotionBudget();
    for (let i = 0; i < 100; i++) budget.frame(100, 1e6, false);
    expect(budget.triangles).toBeCloseTo(250_000, -4);
  });

  it("does not take a pause for a slow frame", () => {
    const budget = new MotionBudget();
    for (let i = 0; i < 50; i++) budget.frame(i % 5 === 4 ? 60_000 : 17, 1e6, true);
    expect(budget.triangles).toBe(Number.POSITIVE_INFINITY);
  });
});

describe("frame clock", () => {
  it("tells intervals only of frames that followed one another", () => {
    const clock = new FrameClock();
    expect(clock.begin(1000)).toBeNull();
    expect(clock.elapsed).toBe(16);
    clock.isOn = true;
    expect(clock.begin(1040)).toBe(40);
    expect(clock.elapsed).toBe(40);
    expect(clock.begin(1540)).toBe(500);
    expect(clock.elapsed).toBe(100);
    clock.isOn = false;
    expect(clock.begin(60_000)).toBeNull();
    expect(clock.elapsed).toBe(16);
    expect(clock.times).toEqual([40, 500]);
    clock.end(60_012);
    expect(clock.spent).toBe(12);
  });

  it("takes the camera for moving until a moment after it stopped", () => {
    const clock = new FrameClock();
    clock.begin(1000);
    expect(clock.isMoving).toBe(false);
    clock.move();
    expect(clock.isMoving).toBe(true);
    clock.begin(1150);
    expect(clock.isMoving).toBe(true);
    clock.begin(1200);
    expect(clock.isMoving).toBe(false);
  });
});

describe("a picture from elsewhere", () => {
  it("turns round without end, and up and down until straight above and below", () => {
    expect(turned([150, 35], 60, 0)).toEqual([-150, 35]);
    expect(turned([-170, 0], -40, 0)).toEqual([150, 0]);
    expect(turned([0, 35], 0, 400)).toEqual([0, 89]);
    expect(turned([0, 35], 720, -400)).toEqual([0, -89]);
  });

  it("shows all of the scene from every side, and the camera's frustum as far as it looks", () => {
    const inset = new Inset();
    inset.place = { left: 0, top: 0, width: 200, height: 150 };
    const main = new PerspectiveCamera(60, 1, 1, 1e4);
    main.position.set(0, 0, 2000);
    main.updateMatrixWorld();
    for (const turn of [
      [0, 0],
      [150, 35],
      [-90, 89],
    ] as const) {
      inset.turn = turn;
      inset.follow(main, 1000);
      for (let axis = 0; axis < 3; axis++) {
        const end = new Vector3().setComponent(axis, 577).project(inset.camera);
        expect(Math.max(Math.abs(end.x), Math.abs(end.y), Math.abs(end.z))).toBeLessThan(1);
      }
    }
    const lines = (inset.frustum.children[0] as LineSegments).geometry.getAttribute("position");
    const tan = 1000 * Math.tan(Math.PI / 6);
    expect([lines.getX(0), lines.getY(0), lines.getZ(0)]).toEqual([0, 0, 2000]);
    expect(lines.getX(1)).toBeCloseTo(-tan, 3);
    expect(lines.getY(1)).toBeCloseTo(-tan, 3);
    expect(lines.getZ(1)).toBeCloseTo(1000, 3);
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
    } as const;
    const frame = frameOf([boxOf(info)]);
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
