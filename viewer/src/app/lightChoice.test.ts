import { describe, expect, it } from "vitest";
import { clockOf, formatLight, imageAt, NO_LIGHT_CHOICE, parseLightChoice } from "./lightChoice";
import { parseScene } from "./sceneFile";

describe("a choice of light", () => {
  it("is short, and what is said badly is not chosen", () => {
    expect(formatLight(NO_LIGHT_CHOICE)).toBe("");
    expect(formatLight({ isOn: false, filter: "soft", minutes: 65 })).toBe("off,soft,01:05");
    for (const text of ["7x7", "25:61", "9:00", "on", "", ",,", "99:00"]) {
      expect(parseLightChoice(text)).toEqual(NO_LIGHT_CHOICE);
    }
  });

  it("shows a clock, after midnight as well", () => {
    expect([0, 59.6, 870, 1470].map(clockOf)).toEqual(["00:00", "01:00", "14:30", "24:30"]);
  });

  it("finds the image of a time, between two in proportion, at the ends the outer ones", () => {
    const times = [480, 500, 540];
    expect([0, 480, 490, 500, 530, 540, 999].map((m) => imageAt(times, m))).toEqual([
      0, 0, 0.5, 1, 1.75, 2, 2,
    ]);
  });
});

describe("a scene with a light", () => {
  const scene = (light: unknown): ReturnType<typeof parseScene> =>
    parseScene({ version: 1, layers: [{ asset: "a.fov" }], light }, "https://here/folder/scene.json");

  it("says where its file is and what moves", () => {
    expect(scene({ asset: "data/s.fov", moving: ["ball", 3] }).light).toEqual({
      url: "https://here/folder/data/s.fov",
      moving: ["ball"],
    });
    expect(scene(undefined).light).toBeNull();
  });

  it("is refused if the light has no file", () => {
    expect(() => scene({ moving: [] })).toThrow("the light names no asset");
    expect(() => scene("sun")).toThrow("the light names no asset");
  });
});
