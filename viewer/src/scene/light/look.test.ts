import { expect, it } from "vitest";
import { filtersOf } from "./look";

it("offers what a light has", () => {
  expect(filtersOf({ kind: "one", images: 1 })).toEqual(["hard", "3x3", "5x5", "smooth"]);
  expect(filtersOf({ kind: "path", images: 8 })).toEqual(["hard", "3x3", "5x5"]);
  expect(filtersOf({ kind: "area", images: 64 })).toEqual(["hard", "3x3", "5x5", "soft"]);
});
