import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { COLOUR_SHIFT, Gap, LEVEL_MASK, parseMessage, SlotBuffers } from "./wire";
import {
  arraysOf,
  freshMessage,
  messageOf,
  nextMessage,
  type Slots,
  SPLIT,
  TETRAHEDRON,
} from "./wire.fixture";

/** The arrays of the slots in use, as bytes. */
function bytesOf(slots: SlotBuffers): Uint8Array[] {
  const { faceCount, vertexCount } = slots;
  const part = (array: Uint8Array | Uint32Array | Float32Array, count: number): Uint8Array =>
    new Uint8Array(array.buffer, 0, count);
  return [
    part(slots.faces, 12 * faceCount),
    part(slots.positions, 12 * vertexCount),
    part(slots.starts, 12 * vertexCount),
    part(slots.tags, 4 * Math.ceil(faceCount / 4)),
    ...(slots.hasColours ? [part(slots.colours, 4 * vertexCount)] : []),
  ];
}

const RED = [255, 0, 0, 255] as const;
const COLOURED: Slots = { ...SPLIT, colours: SPLIT.positions.map((_, v) => [9 * v, 8, 7, 255] as const) };
const COLOURED_TETRAHEDRON: Slots = { ...TETRAHEDRON, colours: COLOURED.colours!.slice(0, 4) };

const GOLDEN = new URL("../../../spec/golden/", import.meta.url);

interface GoldenMessage {
  readonly file: string;
  readonly head: Record<string, number | boolean>;
  readonly faces: number[][];
  readonly positions: number[][];
  readonly starts: number[][];
  readonly levels: number[];
  readonly colours: number[];
  readonly vertex_colours?: number[][];
}

describe("the golden session", () => {
  const { messages } = JSON.parse(readFileSync(new URL("wire.json", GOLDEN), "utf8")) as {
    messages: GoldenMessage[];
  };
  const dataOf = (file: string): ArrayBuffer => new Uint8Array(readFileSync(new URL(file, GOLDEN))).buffer;

  it("gives the arrays that it says, message by message", () => {
    const slots = new SlotBuffers();
    for (const { file, head, faces, positions, starts, levels, colours, vertex_colours } of messages) {
      const message = parseMessage(dataOf(file));
      const { sequence, base, is_settled, triangles, milliseconds, threshold } = head;
      expect(message).toMatchObject({
        sequence,
        base,
        isSettled: is_settled,
        faces: faces.length,
        vertices: positions.length,
        triangles,
        milliseconds,
        threshold,
        hasNormals: ((head.flags as number) & 4) !== 0,
        hasColours: vertex_colours !== undefined,
      });
      slots.apply(message);
      expect([...slots.faces.subarray(0, 3 * slots.faceCount)]).toEqual(faces.flat());
      expect([...slots.positions.subarray(0, 3 * slots.vertexCount)]).toEqual(positions.flat());
      expect([...slots.starts.subarray(0, 3 * slots.vertexCount)]).toEqual(starts.flat());
      const inUse = slots.hasColours ? 4 * slots.vertexCount : 0;
      expect([...slots.colours.subarray(0, inUse)]).toEqual((vertex_colours ?? []).flat());
      const tags = [...slots.tags.subarray(0, slots.faceCount)];
      expect(tags.map((tag) => tag & LEVEL_MASK)).toEqual(levels);
      expect(tags.map((tag) => tag >> COLOUR_SHIFT)).toEqual(colours);
    }
  });

  it("is refused in every part cut short", () => {
    for (const { file } of messages) {
      const data = dataOf(file);
      for (let length = 0; length < data.byteLength; length++) {
        expect(() => parseMessage(data.slice(0, length))).toThrow(/cannot be read/);
      }
    }
  });
});

describe("a live session's messages", () => {
  it("change what they say and tell what that was", () => {
    const slots = new SlotBuffers();
    expect(slots.apply(parseMessage(freshMessage(TETRAHEDRON)))).toMatchObject({ isFresh: true });
    expect(bytesOf(slots)).toEqual(arraysOf(TETRAHEDRON));
    const message = parseMessage(nextMessage(TETRAHEDRON, SPLIT, 2, { threshold: 1.5, flags: 0 }));
    expect(message).toMatchObject({ isSettled: false, threshold: 1.5, milliseconds: 1.5, triangles: 6 });
    const changes = slots.apply(message);
    expect([...changes.born]).toEqual([4]);
    expect([...changes.moved]).toEqual([]);
    expect([...changes.faces]).toEqual([0, 4, 5]);
    expect(bytesOf(slots)).toEqual(arraysOf(SPLIT));
  });

  it("tell moved vertices from new ones, and neither from those that were only within a range", () => {
    const slots = new SlotBuffers();
    slots.apply(parseMessage(freshMessage(SPLIT)));
    const positions = SPLIT.positions.map((p, v) => (v === 1 ? ([9, 0, 0] as const) : p));
    const starts = SPLIT.starts!.map((p, v) => (v === 4 ? ([1, 2, 0] as const) : p));
    const [, places, births] = arraysOf({ ...SPLIT, positions, starts });
    const ranges = [[1, 0, places!] as const, [2, 0, births!] as const];
    const counts = { faces: 6, vertices: 5 };
    const changes = slots.apply(parseMessage(messageOf({ sequence: 2, base: 1, ...counts, ranges })));
    expect([...changes.born]).toEqual([4]);
    expect([...changes.moved]).toEqual([1]);
    expect([...changes.faces]).toEqual([]);
  });

  it("have normals in place of starts, which only a fresh message may change", () => {
    const slots = new SlotBuffers();
    slots.apply(parseMessage(freshMessage(SPLIT, 1, { flags: 7 })));
    expect(slots.hasNormals).toBe(true);
    slots.apply(parseMessage(nextMessage(SPLIT, SPLIT, 2, { flags: 7 })));
    expect(() => slots.apply(parseMessage(nextMessage(SPLIT, SPLIT, 3, { flags: 3 })))).toThrow(Gap);
    expect(slots.hasNormals).toBe(true);
    slots.apply(parseMessage(freshMessage(SPLIT, 3)));
    expect(slots.hasNormals).toBe(false);
    expect(() => parseMessage(freshMessage(SPLIT, 1, { flags: 16 }))).toThrow(/its flags/);
  });

  it("have colours where they say so, which only a fresh message may change", () => {
    const slots = new SlotBuffers();
    slots.apply(parseMessage(freshMessage(COLOURED, 1, { flags: 15 })));
    expect(bytesOf(slots)).toEqual(arraysOf(COLOURED));
    const next = { ...COLOURED, colours: COLOURED.colours!.map((c, v) => (v === 2 ? RED : c)) };
    const changes = slots.apply(parseMessage(nextMessage(COLOURED, next, 2, { flags: 15 })));
    expect([[...changes.born], [...changes.moved], [...changes.faces]]).toEqual([[], [2], []]);
    expect(bytesOf(slots)).toEqual(arraysOf(next));
    expect(() => slots.apply(parseMessage(nextMessage(SPLIT, SPLIT, 3, { flags: 7 })))).toThrow(Gap);
    expect(() => parseMessage(freshMessage(COLOURED, 3, { flags: 7 }))).toThrow(/its ranges/);
    slots.apply(parseMessage(freshMessage(SPLIT, 3, { flags: 7 })));
    expect(slots.colours.length).toBe(0);
    slots.apply(parseMessage(freshMessage(COLOURED, 4, { flags: 15 })));
    expect(bytesOf(slots)).toEqual(arraysOf(COLOURED));
  });

  it("tell faces of which only the level changed", () => {
    const slots = new SlotBuffers();
    slots.apply(parseMessage(freshMessage(SPLIT)));
    const next = { ...SPLIT, tags: [1, 0, 3, 0, 1, 2] };
    expect([...slots.apply(parseMessage(nextMessage(SPLIT, next, 2))).faces]).toEqual([2, 5]);
  });

  it("are refused where they do not build on what is here, and change nothing then", () => {
    const slots = new SlotBuffers();
    slots.apply(parseMessage(freshMessage(SPLIT)));
    const before = bytesOf(slots).map((bytes) => bytes.slice());
    expect(() => slots.apply(parseMessage(nextMessage(SPLIT, SPLIT, 3)))).toThrow(Gap);
    expect(() => slots.apply(parseMessage(nextMessage(SPLIT, TETRAHEDRON, 2)))).toThrow(Gap);
    expect(bytesOf(slots)).toEqual(before);
    slots.apply(parseMessage(freshMessage(TETRAHEDRON, 7)));
    expect(bytesOf(slots)).toEqual(arraysOf(TETRAHEDRON));
    expect(slots.sequence).toBe(7);
  });

  it("leave zeros where arrays grew and nothing was written", () => {
    const slots = new SlotBuffers();
    slots.apply(parseMessage(freshMessage(TETRAHEDRON)));
    for (let n = 2; n < 40; n++) {
      slots.apply(
        parseMessage(
          messageOf({ sequence: n, base: n - 1, faces: 4 + n, vertices: 4 + n, triangles: 4, ranges: [] }),
        ),
      );
      const [faces, positions] = bytesOf(slots);
      expect(faces!.subarray(48).every((byte) => byte === 0)).toBe(true);
      expect(positions!.subarray(48).every((byte) => byte === 0)).toBe(true);
      expect(faces!.subarray(0, 48)).toEqual(arraysOf(TETRAHEDRON)[0]);
    }
  });

  it("are refused with a sentence where a prefix is all that came", () => {
    const whole = freshMessage(COLOURED, 1, { flags: 15 });
    for (let length = 0; length < whole.byteLength; length++) {
      expect(() => parseMessage(whole.slice(0, length))).toThrow(/cannot be read/);
    }
    const longer = new Uint8Array(whole.byteLength + 4);
    longer.set(new Uint8Array(whole));
    expect(() => parseMessage(longer.buffer)).toThrow(/cannot be read/);
  });

  it.each([
    [TETRAHEDRON, SPLIT, 1],
    [COLOURED_TETRAHEDRON, COLOURED, 15],
  ])("are refused or harmless whatever bit is flipped", (from, to, flags) => {
    const message = nextMessage(from, to, 2, { flags });
    for (let bit = 0; bit < 8 * message.byteLength; bit++) {
      const bytes = new Uint8Array(message.slice(0));
      bytes[bit >> 3]! ^= 1 << (bit & 7);
      const slots = new SlotBuffers();
      slots.apply(parseMessage(freshMessage(from, 1, { flags })));
      try {
        slots.apply(parseMessage(bytes.buffer));
      } catch (error) {
        expect((error as Error).message === "" || /cannot be read/.test((error as Error).message)).toBe(true);
      }
      const { faces, faceCount, vertexCount, positions } = slots;
      expect(faces.subarray(0, 3 * faceCount).every((corner) => corner < vertexCount)).toBe(true);
      expect(positions.every(Number.isFinite)).toBe(true);
    }
  });

  it("are refused with ranges that overlap, stand in the wrong order or leave the array", () => {
    const four = new Uint8Array(4);
    const bad: (readonly [number, number, Uint8Array])[][] = [
      [[4, 0, four]],
      [
        [1, 0, four],
        [0, 0, four],
      ],
      [
        [0, 8, four],
        [0, 8, four],
      ],
      [[0, 48, four]],
      [[0, 2, four]],
      [[0, 0, new Uint8Array(0)]],
    ];
    for (const ranges of bad) {
      const message = messageOf({ sequence: 1, base: 0, faces: 4, vertices: 4, ranges });
      expect(() => parseMessage(message)).toThrow(/cannot be read/);
    }
  });
});
