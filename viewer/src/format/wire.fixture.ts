/** Messages of a live session for tests, written by spec/wire.md. */
export interface Slots {
  readonly faces: readonly (readonly [number, number, number])[];
  readonly positions: readonly (readonly [number, number, number])[];
  readonly starts?: readonly (readonly [number, number, number])[];
  readonly tags?: readonly number[];
  /** Four bytes a vertex. */
  readonly colours?: readonly (readonly [number, number, number, number])[];
}

export interface Parts {
  readonly sequence: number;
  readonly base: number;
  readonly flags?: number;
  readonly faces: number;
  readonly vertices: number;
  readonly triangles?: number;
  readonly milliseconds?: number;
  readonly threshold?: number;
  readonly ranges: readonly (readonly [array: number, offset: number, bytes: Uint8Array])[];
}

export function messageOf(parts: Parts): ArrayBuffer {
  const { ranges } = parts;
  const length = 40 + 12 * ranges.length + ranges.reduce((sum, [, , bytes]) => sum + bytes.length, 0);
  const out = new ArrayBuffer(length);
  const view = new DataView(out);
  const words = [0x014c5646, parts.sequence, parts.base, parts.flags ?? 1, parts.faces, parts.vertices];
  words.push(parts.triangles ?? parts.faces, ranges.length);
  words.forEach((word, i) => {
    view.setUint32(4 * i, word, true);
  });
  view.setFloat32(32, parts.milliseconds ?? 1.5, true);
  view.setFloat32(36, parts.threshold ?? 1, true);
  let at = 40 + 12 * ranges.length;
  ranges.forEach(([array, offset, bytes], i) => {
    [array, offset, bytes.length].forEach((word, k) => {
      view.setUint32(40 + 12 * i + 4 * k, word, true);
    });
    new Uint8Array(out, at, bytes.length).set(bytes);
    at += bytes.length;
  });
  return out;
}

/** The arrays as bytes; of colours only if there are any. */
export function arraysOf({ faces, positions, starts, tags, colours }: Slots): Uint8Array[] {
  const padded = new Uint8Array(4 * Math.ceil(faces.length / 4));
  padded.set(tags ?? faces.map(() => 0));
  return [
    bytesOf(new Uint32Array(faces.flat())),
    bytesOf(new Float32Array(positions.flat())),
    bytesOf(new Float32Array((starts ?? positions).flat())),
    padded,
    ...(colours ? [new Uint8Array(colours.flat())] : []),
  ];
}

/** All of some slots, from nothing. */
export function freshMessage(slots: Slots, sequence = 1, more: Partial<Parts> = {}): ArrayBuffer {
  return messageOf({
    sequence,
    base: 0,
    faces: slots.faces.length,
    vertices: slots.positions.length,
    ranges: arraysOf(slots).map((bytes, i) => [i, 0, bytes] as const),
    ...more,
  });
}

/** Only the words that differ, each run a range. */
export function nextMessage(
  from: Slots,
  to: Slots,
  sequence: number,
  more: Partial<Parts> = {},
): ArrayBuffer {
  const before = arraysOf(from);
  const ranges = arraysOf(to).flatMap((bytes, array) => {
    const old = new Uint8Array(bytes.length);
    old.set(before[array]!.subarray(0, bytes.length));
    return runs(old, bytes).map(
      ([begin, end]) => [array, begin, bytes.subarray(begin, end)] as [number, number, Uint8Array],
    );
  });
  return messageOf({
    sequence,
    base: sequence - 1,
    faces: to.faces.length,
    vertices: to.positions.length,
    ranges,
    ...more,
  });
}

function runs(old: Uint8Array, now: Uint8Array): [number, number][] {
  const out: [number, number][] = [];
  for (let at = 0; at < now.length; at += 4) {
    if (old.subarray(at, at + 4).every((byte, k) => byte === now[at + k])) continue;
    const last = out.at(-1);
    if (last?.[1] === at) last[1] = at + 4;
    else out.push([at, at + 4]);
  }
  return out;
}

function bytesOf(array: Uint32Array | Float32Array): Uint8Array {
  return new Uint8Array(array.buffer);
}

/** A tetrahedron, and the same with its first face split in three. */
export const TETRAHEDRON: Slots = {
  faces: [
    [0, 2, 1],
    [0, 1, 3],
    [1, 2, 3],
    [2, 0, 3],
  ],
  positions: [
    [0, 0, 0],
    [3, 0, 0],
    [0, 3, 0],
    [0, 0, 3],
  ],
};

export const SPLIT: Slots = {
  faces: [[0, 2, 4], ...TETRAHEDRON.faces.slice(1), [2, 1, 4], [1, 0, 4]],
  positions: [...TETRAHEDRON.positions, [1, 1, -0.5]],
  starts: [...TETRAHEDRON.positions, [1, 1, 0]],
  tags: [1, 0, 0, 0, 1, 1],
};
