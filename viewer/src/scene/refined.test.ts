import type { LineSegments, Mesh } from "three";
import { describe, expect, it } from "vitest";
import { parseMessage, SlotBuffers, type SlotChanges } from "../format/wire";
import { freshMessage, nextMessage, type Slots, SPLIT, TETRAHEDRON } from "../format/wire.fixture";
import { LEVELS } from "./palette";
import { makeRefinedMaterials } from "./refinedMaterial";
import { BLEND_SECONDS, SlotBlend } from "./slotBlend";
import { runsOf, SlotMesh } from "./slotMesh";
import { SlotNormals } from "./slotNormals";

type Three = [number, number, number];

function random(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 1103515245 + 12345) & 0x7fffffff;
    return state / 0x7fffffff;
  };
}

/** A mesh that nobody built: any corners, free slots among them. */
function randomSlots(next: () => number, faces: number, vertices: number): Slots {
  const vertex = (): number => Math.floor(next() * vertices);
  const point = (): Three => [next(), next(), next()];
  return {
    faces: Array.from({ length: faces }, (): Three => {
      const [a, b, c] = [vertex(), vertex(), vertex()];
      return a === b || b === c || c === a || next() < 0.1 ? [0, 0, 0] : [a, b, c];
    }),
    positions: Array.from({ length: vertices }, point),
    starts: Array.from({ length: vertices }, point),
    tags: Array.from({ length: faces }, () => Math.floor(next() * 8)),
  };
}

/** The same with some of it changed, and a little more of it. */
function changed(next: () => number, { faces, positions, starts, tags }: Slots): Slots {
  const share = 0.1 * next();
  const other = randomSlots(next, faces.length + 3, positions.length + 2);
  const mix = <T>(old: readonly T[], now: readonly T[]): T[] =>
    now.map((x, i) => (i >= old.length || next() < share ? x : old[i]!));
  return {
    faces: mix(faces, other.faces),
    positions: mix(positions, other.positions),
    starts: mix(starts!, other.starts!),
    tags: mix(tags!, other.tags!),
  };
}

/** Apply a message; what it changed and the corners before. */
function step(slots: SlotBuffers, message: ArrayBuffer): { changes: SlotChanges; old: Uint32Array } {
  const old = slots.faces.slice(0, 3 * slots.faceCount);
  return { changes: slots.apply(parseMessage(message)), old };
}

/** Slow and plain: the sum of all faces' area vectors, made unit. */
function plainNormals({ faces, positions, faceCount, vertexCount }: SlotBuffers): Float32Array {
  const sums = new Float32Array(3 * vertexCount);
  const at = (v: number): Three => [positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!];
  for (let f = 0; f < faceCount; f++) {
    const corners = [...faces.subarray(3 * f, 3 * f + 3)];
    if (corners[0] === corners[1]) continue;
    const [a, b, c] = corners.map(at) as [Three, Three, Three];
    const u = b.map((x, k) => x - a[k]!) as Three;
    const v = c.map((x, k) => x - a[k]!) as Three;
    const area = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const corner of corners) for (let k = 0; k < 3; k++) sums[3 * corner + k]! += area[k]!;
  }
  for (let v = 0; v < vertexCount; v++) {
    const [x, y, z] = sums.subarray(3 * v, 3 * v + 3) as unknown as Three;
    const length = Math.sqrt(x * x + y * y + z * z);
    const scale = length > 0 ? 1 / length : 0;
    sums.set([x * scale, y * scale, z * scale], 3 * v);
  }
  return sums;
}

describe("normals of slots", () => {
  it("are those of a tetrahedron", () => {
    const slots = new SlotBuffers();
    const normals = new SlotNormals();
    const { changes, old } = step(slots, freshMessage(TETRAHEDRON));
    normals.update(slots, old, changes);
    const third = -Math.sqrt(1 / 3);
    [third, third, third].forEach((x, k) => {
      expect(normals.values[k]).toBeCloseTo(x, 6); // three right angles meet there
    });
  });

  it("are, kept up by what changed, bit for bit those made from nothing, over long random walks", () => {
    for (let seed = 1; seed < 6; seed++) {
      const next = random(seed);
      const slots = new SlotBuffers();
      const normals = new SlotNormals();
      let now = randomSlots(next, 40, 25);
      let done = step(slots, freshMessage(now));
      normals.update(slots, done.old, done.changes);
      for (let n = 2; n < 40; n++) {
        const before = now;
        now = changed(next, before);
        done = step(slots, nextMessage(before, now, n));
        normals.update(slots, done.old, done.changes);
        expect(normals.values.slice(0, 3 * slots.vertexCount)).toEqual(plainNormals(slots));
      }
    }
  });

  it("touch only vertices near what changed", () => {
    const slots = new SlotBuffers();
    const normals = new SlotNormals();
    let done = step(slots, freshMessage(TETRAHEDRON));
    normals.update(slots, done.old, done.changes);
    done = step(slots, nextMessage(TETRAHEDRON, SPLIT, 2));
    normals.update(slots, done.old, done.changes);
    expect([...normals.marks.subarray(0, 5)].map(Boolean)).toEqual([true, true, true, false, true]);
  });
});

describe("normals that are sent", () => {
  it("are drawn as they are, where they are, at once", () => {
    const next = random(9);
    const slots = new SlotBuffers();
    const blend = new SlotBlend();
    let now = randomSlots(next, 30, 20);
    let done = step(slots, freshMessage(now, 1, { flags: 7 }));
    for (let n = 2; n < 30; n++) {
      blend.update(slots, done.old, done.changes, n);
      expect(blend.isMoving(n)).toBe(false);
      const used = 3 * slots.vertexCount;
      for (const points of [blend.position, blend.from])
        expect(points.subarray(0, used)).toEqual(slots.positions.subarray(0, used));
      for (const normals of [blend.normal, blend.fromNormal])
        expect(normals.subarray(0, used)).toEqual(slots.starts.subarray(0, used));
      const before = now;
      now = changed(next, before);
      done = step(slots, nextMessage(before, now, n, { flags: 7 }));
    }
  });
});

describe("blending", () => {
  function started(): { slots: SlotBuffers; blend: SlotBlend } {
    const slots = new SlotBuffers();
    const blend = new SlotBlend();
    const { changes, old } = step(slots, freshMessage(TETRAHEDRON));
    blend.update(slots, old, changes, 0);
    return { slots, blend };
  }

  /** Where the shader draws a vertex at a moment. */
  function drawn({ position, from, since }: SlotBlend, v: number, now: number): number[] {
    const share = Math.min(1, (now - since[v]!) / BLEND_SECONDS);
    return [0, 1, 2].map((k) => from[3 * v + k]! * (1 - share) + position[3 * v + k]! * share);
  }

  it("does nothing where all is sent anew", () => {
    const { blend } = started();
    expect(blend.isMoving(0)).toBe(false);
    TETRAHEDRON.positions.forEach((point, v) => {
      expect(drawn(blend, v, 0)).toEqual([...point]);
    });
  });

  it("begins new vertices where they were born and ends where they belong", () => {
    const { slots, blend } = started();
    const { changes, old } = step(slots, nextMessage(TETRAHEDRON, SPLIT, 2));
    blend.update(slots, old, changes, 10);
    expect(drawn(blend, 4, 10)).toEqual([1, 1, 0]);
    expect(drawn(blend, 4, 10 + BLEND_SECONDS / 2)[2]).toBeCloseTo(-0.25, 5);
    expect(drawn(blend, 4, 11)).toEqual([1, 1, -0.5]);
    expect(drawn(blend, 1, 10)).toEqual([3, 0, 0]);
    expect(blend.isMoving(10)).toBe(true);
    expect(blend.isMoving(10 + BLEND_SECONDS)).toBe(false);
    // lit at first as the corners of the face that it was born in
    const first = blend.fromNormal.subarray(12, 15);
    expect(first[2]!).toBeLessThan(0);
    expect(Math.hypot(...first)).toBeCloseTo(1, 6);
  });

  it("goes on from where a vertex is drawn when it moves again on its way", () => {
    const { slots, blend } = started();
    const move = (z: number): Slots => ({
      ...TETRAHEDRON,
      starts: TETRAHEDRON.positions,
      positions: TETRAHEDRON.positions.map((p, v) => (v === 3 ? ([0, 0, z] as const) : p)),
    });
    let done = step(slots, nextMessage(TETRAHEDRON, move(5), 2));
    blend.update(slots, done.old, done.changes, 1);
    const half = 1 + BLEND_SECONDS / 2;
    const before = drawn(blend, 3, half);
    expect(before[2]).toBeCloseTo(4, 5);
    done = step(slots, nextMessage(move(5), move(1), 3));
    blend.update(slots, done.old, done.changes, half);
    expect(drawn(blend, 3, half)[2]).toBeCloseTo(before[2]!, 5);
    expect(drawn(blend, 3, half + 2 * BLEND_SECONDS)).toEqual([0, 0, 1]);
  });
});

describe("slots on the GPU", () => {
  /** What the GPU has after the uploads that are due, if it had all that was due before. */
  class Upload {
    readonly #copies = new Map<object, { array: Float32Array | Uint32Array | Uint8Array; version: number }>();
    elements = 0;

    take(mesh: Mesh | LineSegments): void {
      const { geometry } = mesh;
      for (const attribute of [...Object.values(geometry.attributes), geometry.index]) {
        if (!attribute || !("version" in attribute)) continue;
        const array = attribute.array as Float32Array;
        const copy = this.#copies.get(attribute);
        if (!copy) {
          this.#copies.set(attribute, { array: array.slice(), version: attribute.version });
        } else if (copy.version < attribute.version) {
          expect(attribute.updateRanges.length).toBeGreaterThan(0);
          for (const { start, count } of attribute.updateRanges) {
            copy.array.set(array.subarray(start, start + count), start);
            this.elements += count;
          }
          copy.version = attribute.version;
        }
        attribute.clearUpdateRanges();
        expect(this.#copies.get(attribute)!.array).toEqual(array);
      }
    }
  }

  it("are what the page has, after uploads of what changed only", () => {
    for (let seed = 1; seed < 5; seed++) {
      const next = random(seed);
      const slots = new SlotBuffers();
      const mesh = new SlotMesh(slots, makeRefinedMaterials());
      const upload = new Upload();
      const hasColours = seed % 2 === 0;
      const flags = hasColours ? 15 : 1;
      const coloured = (there: Slots): Slots =>
        hasColours ? { ...there, colours: there.positions.map(() => [byte(), byte(), byte(), 255]) } : there;
      const byte = (): number => Math.floor(256 * next());
      let now = coloured(randomSlots(next, 60, 40));
      mesh.update(slots.apply(parseMessage(freshMessage(now, 1, { flags }))), 0);
      for (let n = 2; n < 40; n++) {
        const before = now;
        now = coloured(changed(next, before));
        mesh.show(n % 7 < 3, n % 5 < 3);
        mesh.update(slots.apply(parseMessage(nextMessage(before, now, n, { flags }))), n);
        for (const part of [mesh.surface, mesh.wires, mesh.tagged]) upload.take(part);
        const { surface, tagged } = mesh;
        expect(surface.geometry.attributes.srgb?.array).toBe(hasColours ? slots.colours : undefined);
        const corners = surface.geometry.index!.array.subarray(0, 3 * slots.faceCount);
        expect(corners).toEqual(slots.faces.subarray(0, 3 * slots.faceCount));
        expect(surface.geometry.drawRange.count).toBe(3 * slots.faceCount);
        if (n % 5 >= 3) continue;
        const { position, tag } = tagged.geometry.attributes;
        for (let i = 0; i < 3 * slots.faceCount; i++) {
          const v = corners[i]!;
          expect(tag!.array[i]).toBe(slots.tags[Math.floor(i / 3)]);
          expect(position!.array.slice(3 * i, 3 * i + 3)).toEqual(slots.positions.slice(3 * v, 3 * v + 3));
        }
      }
    }
  });

  it("have runs that hold all marks and join what is near", () => {
    const marks = new Uint8Array(500);
    for (const i of [3, 4, 20, 300, 499]) marks[i] = 1;
    expect(runsOf(marks, 500)).toEqual([
      [3, 21],
      [300, 301],
      [499, 500],
    ]);
    expect(runsOf(marks, 3)).toEqual([]);
  });
});

describe("colours of levels", () => {
  it("get darker with each level", () => {
    const light = LEVELS.map(([r, g, b]) => 0.2126 * r ** 2.2 + 0.7152 * g ** 2.2 + 0.0722 * b ** 2.2);
    for (let i = 1; i < light.length; i++) expect(light[i]!).toBeLessThan(0.93 * light[i - 1]!);
  });
});
