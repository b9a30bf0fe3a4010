/**
 * Messages of a live session (spec/wire.md), and the slot buffers that they change.
 *
 * - A message is checked as a whole before anything of it is applied: any bytes are decoded or refused with a
 *   sentence, and what was refused has changed nothing.
 * - What is applied tells what truly changed, slot by slot and bit by bit, since ranges may hold slots that did not.
 *
 * @module format/wire
 */

import { Problem } from "./problem";

const MAGIC = 0x014c5646;
const HEAD_BYTES = 40;
const RANGE_BYTES = 12;
const SETTLED = 1;
const LIMITS = 2;
const NORMALS = 4;
const COLOURS = 8;
/** Slots at most: faces and tags of so many take 110 MB, and no page draws more. */
const MAX_SLOTS = 1 << 23;
const ARRAYS = 5;

/** Numbers of the arrays on the wire. */
const FACES = 0;
const POSITIONS = 1;
const STARTS = 2;
const TAGS = 3;

export const LEVEL_MASK = 31;
export const COLOUR_SHIFT = 5;

interface WireRange {
  /** Of the array, in bytes. */
  readonly offset: number;
  readonly bytes: Uint8Array;
}

/** A checked message; its bytes are still those that came. */
export interface WireMessage {
  readonly sequence: number;
  /** Sequence it builds on, 0 for nothing. */
  readonly base: number;
  readonly isSettled: boolean;
  /** The third array is of normals, and nothing is to be blended. */
  readonly hasNormals: boolean;
  /** The fifth array is there. */
  readonly hasColours: boolean;
  readonly faces: number;
  readonly vertices: number;
  /** Triangles in use. */
  readonly triangles: number;
  /** That the refinement took. */
  readonly milliseconds: number;
  /** By how much edges wanted were multiplied to keep budget and rate, 1 or more. */
  readonly threshold: number;
  /** For each array its ranges, rising. */
  readonly ranges: readonly (readonly WireRange[])[];
}

/** What a message changed: slots, each once, rising. */
export interface SlotChanges {
  /** All is new; the lists are empty. */
  readonly isFresh: boolean;
  /** Vertices that were born. */
  readonly born: Uint32Array;
  /** Vertices that were there and are elsewhere now, or have another colour. */
  readonly moved: Uint32Array;
  /** Faces with other corners or another tag. */
  readonly faces: Uint32Array;
}

/** @throws Problem if it is not a message, or not a whole and sound one. */
export function parseMessage(data: ArrayBuffer): WireMessage {
  if (data.byteLength < HEAD_BYTES || data.byteLength % 4 !== 0) throw damaged("its length");
  const words = new Uint32Array(data);
  const numbers = new Float32Array(data);
  if (words[0] !== MAGIC) throw damaged("its first bytes");
  const [, sequence, base, flags, faces, vertices, triangles, ranges] = words as unknown as number[];
  if (sequence === 0 || base! >= sequence!) throw damaged("its sequence");
  if (faces! > MAX_SLOTS || vertices! > MAX_SLOTS || triangles! > faces!) throw damaged("its counts");
  const [milliseconds, threshold] = [numbers[8]!, numbers[9]!];
  if (!(milliseconds >= 0 && threshold >= 1 && milliseconds + threshold < Infinity))
    throw damaged("its figures");
  const message: WireMessage = {
    sequence: sequence!,
    base: base!,
    isSettled: (flags! & SETTLED) !== 0,
    hasNormals: (flags! & NORMALS) !== 0,
    hasColours: (flags! & COLOURS) !== 0,
    faces: faces!,
    vertices: vertices!,
    triangles: triangles!,
    milliseconds,
    threshold,
    ranges: rangesOf(data, words, ranges!, sizesOf(faces!, vertices!, (flags! & COLOURS) !== 0)),
  };
  if ((flags! & ~(SETTLED | LIMITS | NORMALS | COLOURS)) !== 0) throw damaged("its flags");
  checkValues(message);
  return message;
}

/** Bytes of the arrays. */
function sizesOf(faces: number, vertices: number, hasColours: boolean): number[] {
  const places = 12 * vertices;
  return [12 * faces, places, places, 4 * Math.ceil(faces / 4), hasColours ? 4 * vertices : 0];
}

function rangesOf(data: ArrayBuffer, words: Uint32Array, count: number, sizes: number[]): WireRange[][] {
  const out: WireRange[][] = Array.from({ length: ARRAYS }, () => []);
  let at = HEAD_BYTES + RANGE_BYTES * count;
  if (at > data.byteLength) throw damaged("its ranges");
  let lastArray = 0;
  let end = 0;
  for (let i = 0; i < count; i++) {
    const [array, offset, length] = words.subarray(10 + 3 * i, 13 + 3 * i) as unknown as number[];
    if (array! >= ARRAYS || array! < lastArray) throw damaged("its ranges");
    if (array! > lastArray) end = 0;
    const isWhole = length! > 0 && length! % 4 === 0 && offset! % 4 === 0;
    if (!isWhole || offset! < end || offset! + length! > sizes[array!]!) throw damaged("its ranges");
    if (at + length! > data.byteLength) throw damaged("its length");
    out[array!]!.push({ offset: offset!, bytes: new Uint8Array(data, at, length) });
    at += length!;
    end = offset! + length!;
    lastArray = array!;
  }
  if (at !== data.byteLength) throw damaged("its length");
  return out;
}

/** What is drawn leans on these: corners that exist, places that are finite. */
function checkValues({ ranges, vertices }: WireMessage): void {
  for (const { bytes } of ranges[FACES]!) {
    const corners = new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
    // a slot that is free names vertex 0, whether there is one or not
    for (const corner of corners) if (corner >= vertices && corner !== 0) throw damaged("a corner");
  }
  for (const { bytes } of [...ranges[POSITIONS]!, ...ranges[STARTS]!]) {
    const places = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
    for (const place of places) if (!Number.isFinite(place)) throw damaged("a position");
  }
}

function damaged(what: string): Problem {
  return new Problem("damaged", `A message of the server cannot be read (${what}). Reload the page.`);
}

/** A message that does not build on what is here: all is to be asked for. */
export class Gap extends Error {}

/** The arrays as the server has them; only the first `faces` and `vertices` slots of each count. */
export class SlotBuffers {
  /** Of the last message applied, 0 before the first. */
  sequence = 0;
  faceCount = 0;
  vertexCount = 0;
  /** Three vertices a slot; (0, 0, 0) is free. */
  faces = new Uint32Array(0);
  positions = new Float32Array(0);
  /** Where vertices were born, or their normals. */
  starts = new Float32Array(0);
  hasNormals = false;
  tags = new Uint8Array(0);
  hasColours = false;
  /** Red, green, blue and 255 a vertex; empty where there are none. */
  colours = NO_COLOURS;

  /** Forget all; the next message must begin from nothing. */
  reset(): void {
    this.sequence = 0;
    this.faceCount = 0;
    this.vertexCount = 0;
    for (const array of this.#arrays) array.fill(0);
  }

  /**
   * Take over what the message changes.
   *
   * @throws Gap if it does not build on what is here. Then nothing has changed.
   */
  apply(message: WireMessage): SlotChanges {
    const isFresh = message.base === 0;
    const isOther = message.hasNormals !== this.hasNormals || message.hasColours !== this.hasColours;
    const hasShrunk = isOther || message.faces < this.faceCount || message.vertices < this.vertexCount;
    if (!isFresh && (message.base !== this.sequence || hasShrunk)) throw new Gap();
    if (isFresh) this.reset();
    this.hasNormals = message.hasNormals;
    this.hasColours = message.hasColours;
    this.#grow(message);
    const changes = isFresh ? NOTHING : this.#compare(message);
    this.#arrays.forEach((array, i) => {
      const bytes = new Uint8Array(array.buffer);
      for (const range of message.ranges[i]!) bytes.set(range.bytes, range.offset);
    });
    this.sequence = message.sequence;
    this.faceCount = message.faces;
    this.vertexCount = message.vertices;
    return changes;
  }

  get #arrays(): [Uint32Array, Float32Array, Float32Array, Uint8Array, Uint8Array] {
    return [this.faces, this.positions, this.starts, this.tags, this.colours];
  }

  /** Room for twice what was, where there is too little: counts grow a little with many messages. */
  #grow({ faces, vertices, hasColours }: WireMessage): void {
    if (12 * faces > this.faces.byteLength) {
      const room = 4 * Math.ceil(Math.max(faces, this.faces.length / 1.5) / 4);
      this.faces = copied(this.faces, new Uint32Array(3 * room));
      this.tags = copied(this.tags, new Uint8Array(room));
    }
    if (12 * vertices > this.positions.byteLength) {
      const room = 3 * Math.ceil(Math.max(vertices, this.positions.length / 1.5));
      this.positions = copied(this.positions, new Float32Array(room));
      this.starts = copied(this.starts, new Float32Array(room));
    }
    if (!hasColours) this.colours = NO_COLOURS;
    else if (3 * this.colours.length < 4 * this.positions.length)
      this.colours = copied(this.colours, new Uint8Array((4 * this.positions.length) / 3));
  }

  /** Find what the message will change, before it does. */
  #compare({ ranges, faces, vertices }: WireMessage): SlotChanges {
    const changed = this.#arrays.map((array, i) => {
      const now = new Uint32Array(array.buffer);
      const isChanged = new Uint8Array(i === FACES || i === TAGS ? faces : vertices);
      for (const range of ranges[i]!) markChanged(now, range, WORDS[i]!, isChanged);
      return isChanged;
    });
    const [corners, places, births, tags, colours] = changed as [
      Uint8Array,
      Uint8Array,
      Uint8Array,
      Uint8Array,
      Uint8Array,
    ];
    for (let f = 0; f < faces; f++) corners[f]! |= tags[f]!;
    for (let v = 0; v < vertices; v++) places[v] = (places[v]! | colours[v]!) & (1 - births[v]!);
    return { isFresh: false, born: marked(births), moved: marked(places), faces: marked(corners) };
  }
}

/** Of a slot of each array; of tags none, but bytes. */
const WORDS = [3, 3, 3, null, 1] as const;
const NO_COLOURS = new Uint8Array(0);
const NONE = new Uint32Array(0);
const NOTHING: SlotChanges = { isFresh: true, born: NONE, moved: NONE, faces: NONE };

/** Mark the slots that a range changes: of so many words each, or (null) of one byte. */
function markChanged(
  now: Uint32Array,
  { offset, bytes }: WireRange,
  words: number | null,
  out: Uint8Array,
): void {
  const next = new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  const first = offset / 4;
  for (let i = 0; i < next.length; i++) {
    const difference = now[first + i]! ^ next[i]!;
    if (difference === 0) continue;
    if (words !== null) out[Math.floor((first + i) / words)] = 1;
    else
      for (let byte = 0; byte < 4; byte++) {
        // beyond the last slot is padding, and writing there is nothing
        if (((difference >>> (8 * byte)) & 255) !== 0) out[4 * (first + i) + byte] = 1;
      }
  }
}

function marked(marks: Uint8Array): Uint32Array {
  let count = 0;
  for (const mark of marks) count += mark;
  const out = new Uint32Array(count);
  let at = 0;
  for (let i = 0; at < count; i++) if (marks[i]) out[at++] = i;
  return out;
}

function copied<T extends Uint32Array | Float32Array | Uint8Array>(from: T, to: T): T {
  to.set(from);
  return to;
}
