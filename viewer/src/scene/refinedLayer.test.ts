import { type BufferAttribute, type Mesh, PerspectiveCamera, type ShaderMaterial, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { Refinement } from "../format/cage";
import type { Triple } from "../format/graph";
import { parseMessage, SlotBuffers } from "../format/wire";
import { freshMessage, nextMessage, SPLIT, TETRAHEDRON } from "../format/wire.fixture";
import type { RefinementListener, RefinementSource, Wish } from "../stream/refinement";
import { type Box, frameOf, toFrame } from "./frame";
import type { Look, Pass } from "./layer";
import { RefinedLayer } from "./refinedLayer";
import { RefinedPlace } from "./refinedPlace";

const LIMITS = { iterations: 4, edge_px: 8, bend: 0.1 };
const REFINEMENT: Refinement = {
  scheme: "sqrt3",
  criteria: { front: LIMITS, silhouette: LIMITS, back: LIMITS },
  depths: { most: 4, cone_degrees: null, backs: true, silhouettes: false, epsilon: 0.1, size_px: [2, 9] },
  positions: "limit",
  budget: 5000,
  rate: 30,
};
const LOOK: Look = {
  areColoursOn: true,
  arePatchesTinted: false,
  isWireframe: false,
  areSpheresOn: false,
  faceColours: "plain",
  background: { middle: "#ffffff", corners: "#ffffff" },
};
/** UTM coordinates: large numbers, and what matters is behind the point. */
const ORIGIN: Triple = [500_000.25, 4_800_000.5, 12];
const BOX: Box = [
  [ORIGIN[0] - 1, ORIGIN[1] - 2, ORIGIN[2] - 3],
  [ORIGIN[0] + 1, ORIGIN[1] + 2, ORIGIN[2] + 3],
];
const FRAME = frameOf([BOX]);

/** Somebody who refines, in the test's hands. */
class FakeSource implements RefinementSource {
  readonly slots = new SlotBuffers();
  figures = { triangles: 0, milliseconds: 1, threshold: 1, updates: 0, receivedBytes: 0 };
  isSettled = true;
  readonly wishes: Wish[] = [];
  readonly drawn: number[] = [];
  #listener: RefinementListener | undefined;

  listen(listener: RefinementListener): void {
    this.#listener = listener;
  }

  request(wish: Wish, drawnMs: number): void {
    this.wishes.push(wish);
    this.drawn.push(drawnMs);
  }

  say(data: ArrayBuffer): void {
    const message = parseMessage(data);
    const changes = this.slots.apply(message);
    this.figures = { ...this.figures, triangles: message.triangles };
    this.#listener?.onChange(changes);
  }

  retry(): void {}
  dispose(): void {}
}

function started() {
  const source = new FakeSource();
  const events: string[] = [];
  const asset = {
    name: "ball",
    origin: ORIGIN,
    box: BOX,
    fileBytes: 100,
    source,
    refinement: REFINEMENT,
  };
  const layer = new RefinedLayer(asset, FRAME, {
    onChange: () => events.push("change"),
    onProblem: () => events.push("problem"),
    drawnMs: () => 7,
  });
  layer.dress(LOOK);
  return { source, layer, events };
}

/** A camera of the scene's frame that looks at a place of the asset. */
function cameraAt(eye: Triple, target: Triple): PerspectiveCamera {
  const camera = new PerspectiveCamera(40, 1.5, 0.01, 1e5);
  camera.position.set(...toFrame(FRAME, eye));
  camera.lookAt(new Vector3(...toFrame(FRAME, target)));
  camera.updateMatrixWorld();
  return camera;
}

describe("a refined layer", () => {
  it("asks for each picture in the asset's own coordinates", () => {
    const { source, layer } = started();
    const eye: Triple = [ORIGIN[0] + 4, ORIGIN[1] + 3, ORIGIN[2]];
    layer.choose(cameraAt(eye, ORIGIN), 600, 1, { triangles: 1e6, bytes: 0 });
    const [{ camera, criteria, budget, positions, rate }] = source.wishes as [Wish];
    camera.position.forEach((x, a) => {
      expect(Math.abs(x - eye[a]!)).toBeLessThan(2e-9);
    });
    const ahead = camera.target.map((x, a) => x - camera.position[a]!);
    const length = Math.hypot(...ahead);
    [-0.8, -0.6, 0].forEach((x, a) => {
      expect(ahead[a]! / length).toBeCloseTo(x, 9);
    });
    expect(camera).toMatchObject({ width: 900, height: 600 });
    expect(camera.fov).toBeCloseTo((40 * Math.PI) / 180, 12);
    expect(criteria).toEqual(REFINEMENT.criteria);
    expect([budget, positions, rate]).toEqual([5000, "limit", 30]);
    expect(source.drawn).toEqual([7]);
  });

  it("wants no more triangles than the picture may have, and at least one", () => {
    const { source, layer } = started();
    const camera = cameraAt([ORIGIN[0], ORIGIN[1], ORIGIN[2] + 9], ORIGIN);
    for (const triangles of [100.7, 0, 1e6]) layer.choose(camera, 600, 1, { triangles, bytes: 0 });
    layer.wants = { ...REFINEMENT, budget: 0 };
    layer.choose(camera, 600, 1, { triangles: 9e5, bytes: 0 });
    expect(source.wishes.map(({ budget }) => budget)).toEqual([100, 1, 5000, 900_000]);
  });

  it("fades for a moment after each change, or not at all where nothing shall move", () => {
    const { source, layer, events } = started();
    source.say(freshMessage(TETRAHEDRON));
    expect(events).toEqual(["change"]);
    expect(layer.isFading).toBe(false); // all from nothing comes at once
    source.say(nextMessage(TETRAHEDRON, SPLIT, 2));
    expect(layer.isFading).toBe(true);
    for (let milliseconds = 0; milliseconds < 160; milliseconds += 16) layer.show(16);
    expect(layer.isFading).toBe(false);
    source.say(nextMessage(SPLIT, { ...SPLIT, positions: SPLIT.positions.map(([x]) => [x, 0, 0]) }, 3));
    layer.isStill = true;
    expect(layer.isFading).toBe(false);
  });

  it("keeps nobody waiting for what is not seen", () => {
    const { source, layer } = started();
    source.isSettled = false;
    expect(layer.isSettled).toBe(false);
    layer.group.visible = false;
    expect(layer.isSettled).toBe(true);
  });

  it("shows for each pass one kind of its meshes", () => {
    const { source, layer } = started();
    source.say(freshMessage(TETRAHEDRON));
    const [surface, wires, tagged] = layer.group.children as [Mesh, Mesh, Mesh];
    const worn = (pass: Pass): string => {
      layer.wear(pass);
      return [surface, wires, tagged].map(({ visible }) => (visible ? "x" : "-")).join("");
    };
    const looks: [Partial<Look>, Record<Exclude<Pass, "warm-up">, string>][] = [
      [{}, { picture: "x--", wires: "-x-", depth: "x--", cast: "x--", inset: "--x" }],
      [{ faceColours: "levels" }, { picture: "--x", wires: "---", depth: "x--", cast: "x--", inset: "--x" }],
    ];
    for (const [look, passes] of looks) {
      layer.dress({ ...LOOK, ...look });
      layer.show(16);
      for (const [pass, kinds] of Object.entries(passes)) expect(worn(pass as Pass), pass).toBe(kinds);
      expect(worn("picture")).toBe(passes.picture);
    }
    expect(tagged.geometry.drawRange.count).toBe(12); // made for the inset
  });

  it("draws the colours of its vertices where there are any and they are wanted", () => {
    const { source, layer } = started();
    const [surface] = layer.group.children as [Mesh];
    const isColoured = (): unknown => {
      layer.show(16);
      return (surface.material as ShaderMaterial).uniforms.hasColours!.value;
    };
    source.say(freshMessage(SPLIT));
    expect([layer.hasColours, isColoured(), surface.geometry.getAttribute("srgb")]).toEqual([
      false,
      false,
      undefined,
    ]);
    const colours = SPLIT.positions.map((_, v) => [v, 2 * v, 255 - v, 255] as const);
    source.say(freshMessage({ ...SPLIT, colours }, 2, { flags: 15 }));
    expect([layer.hasColours, isColoured()]).toEqual([true, true]);
    const attribute = surface.geometry.getAttribute("srgb") as BufferAttribute;
    expect([...attribute.array.subarray(0, 20)]).toEqual(colours.flat());
    expect([attribute.itemSize, attribute.normalized]).toEqual([4, true]);
    layer.dress({ ...LOOK, areColoursOn: false });
    expect(isColoured()).toBe(false);
    source.say(freshMessage(SPLIT, 3));
    expect(surface.geometry.getAttribute("srgb")).toBeUndefined();
  });

  it("has the picture's faces still after a picture from elsewhere", () => {
    const { source, layer } = started();
    source.say(freshMessage(TETRAHEDRON));
    for (let frame = 0; frame < 3; frame++) {
      layer.show(16);
      layer.wear("inset");
      layer.wear("picture");
      expect(layer.group.children.map(({ visible }) => visible)).toEqual([true, false, false]);
    }
    layer.show(16);
    layer.show(16); // without one in between they are let go
    expect((layer.group.children[2] as Mesh).geometry.getAttribute("position")).toBeUndefined();
  });
});

describe("the place of a refined asset", () => {
  const { fround } = Math;

  it("draws every vertex where it is, to a few 2^-24 of its distance to the eye, in UTM coordinates too", () => {
    const place = new RefinedPlace(ORIGIN, BOX, FRAME);
    let seed = 3;
    const random = (): number => {
      seed = (seed * 1103515245 + 12345) & 0x7fffffff;
      return seed / 0x7fffffff - 0.5;
    };
    for (let n = 0; n < 300; n++) {
      const vertex = [2 * random(), 4 * random(), 6 * random()].map(fround) as unknown as Triple;
      const there = vertex.map((x, a) => x + ORIGIN[a]!) as unknown as Triple;
      const away = 10 ** (5 * random());
      const eye = there.map((x) => x + away * (random() + 0.6)) as unknown as Triple;
      const camera = cameraAt(eye, there);
      place.follow(camera);
      const reference = place.reference.toArray();
      expect(reference.map(fround)).toEqual(reference);
      const local = vertex.map((x, a) => fround(x - reference[a]!));
      const m = place.toEye.elements.map(fround);
      const seen = [0, 1, 2].map((r) =>
        fround(
          fround(fround(m[r]! * local[0]!) + fround(m[4 + r]! * local[1]!)) +
            fround(fround(m[8 + r]! * local[2]!) + m[12 + r]!),
        ),
      );
      const wanted = new Vector3(...toFrame(FRAME, there)).applyMatrix4(camera.matrixWorldInverse).toArray();
      // what doubles lose of coordinates in the millions, and floats of the distance
      const allowed = 2e-9 * FRAME.scale + 16 * 2 ** -24 * Math.hypot(...wanted);
      seen.forEach((x, a) => {
        expect(Math.abs(x - wanted[a]!)).toBeLessThan(allowed);
      });
    }
  });
});
