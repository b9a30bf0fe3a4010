/**
 * What a page is told of a refinement: messages as of a live session (spec/wire.md), so that the page takes them in
 * as it does those of a server.
 *
 * @module refine/slotMessage
 */
import type { Triple } from "../format/graph";
import type { Sqrt3 } from "./sqrt3";

const MAGIC = 0x014c5646;
const HEAD_WORDS = 10;
const SETTLED = 1;
const LIMITS = 2;
const NORMALS = 4;
const COLOURS = 8;

/** Changes are looked for in blocks of so many words: a range costs three words itself. */
const BLOCK = 16;

/** Faces, positions, starts or normals, tags, and colours if there are any, as words. */
export type SlotWords = readonly [Uint32Array, Uint32Array, Uint32Array, Uint32Array, Uint32Array?];

/** The slots of a refinement, places relative to `origin`. √3 triangles are green, so tags are levels. */
export function slotWords(refined: Sqrt3, isLimit: boolean, origin: Triple): SlotWords {
  const shown = refined.faces();
  const count = refined.vertexSlots;
  const positions = new Float32Array(3 * count);
  const starts = new Float32Array(3 * count);
  const place = new Float64Array(6);
  for (let v = 0; v < count; v++) {
    refined.place(v, isLimit, shown, place, 0);
    refined.start(v, place, 3);
    for (let k = 0; k < 3; k++) {
      positions[3 * v + k] = place[k]! - origin[k]!;
      starts[3 * v + k] = place[3 + k]! - origin[k]!;
    }
  }
  const tags = new Uint8Array(4 * Math.ceil(shown.levels.length / 4));
  tags.set(shown.levels);
  const words = [positions, starts, tags].map((array) => new Uint32Array(array.buffer));
  return [shown.faces, ...words] as unknown as SlotWords;
}

/** What a page is to have, and what of it a message brings. */
export interface SlotParts {
  /** Nothing that the page has counts. */
  readonly isFresh: boolean;
  /** The arrays in their order on the wire. */
  readonly words: SlotWords;
  /** Of each array begins and ends of what is sent, in words, rising. */
  readonly bounds: readonly (readonly number[])[];
}

/** All that brings a page from the slots `was`, which may be fewer, to `now`; null for nothing. */
export function changedParts(now: SlotWords, was: SlotWords | null): SlotParts {
  const bounds = now.map((words, i) => changesOf(words!, was?.[i] ?? NOTHING));
  return { isFresh: was === null, words: now, bounds };
}

const NOTHING = new Uint32Array(0);

export interface SlotHead {
  readonly sequence: number;
  readonly base: number;
  readonly isSettled: boolean;
  readonly isLimit: boolean;
  readonly hasNormals: boolean;
  readonly triangles: number;
  readonly milliseconds: number;
  readonly threshold: number;
}

export function slotMessage(head: SlotHead, { words: now, bounds: changes }: SlotParts): ArrayBuffer {
  const ranges = changes.reduce((sum, bounds) => sum + bounds.length / 2, 0);
  const inner = changes.flat().reduce((sum, at, i) => sum + (i % 2 === 0 ? -at : at), 0);
  const out = new Uint32Array(HEAD_WORDS + 3 * ranges + inner);
  const kinds = (head.hasNormals ? NORMALS : 0) | (now[4] ? COLOURS : 0);
  const flags = (head.isSettled ? SETTLED : 0) | (head.isLimit ? LIMITS : 0) | kinds;
  const slots = [now[0].length / 3, now[1].length / 3];
  out.set([MAGIC, head.sequence, head.base, flags, ...slots, head.triangles, ranges]);
  new Float32Array(out.buffer).set([head.milliseconds, head.threshold], HEAD_WORDS - 2);
  let row = HEAD_WORDS;
  let at = HEAD_WORDS + 3 * ranges;
  changes.forEach((bounds, array) => {
    for (let i = 0; i < bounds.length; i += 2) {
      const words = now[array]!.subarray(bounds[i]!, bounds[i + 1]!);
      out.set([array, 4 * bounds[i]!, 4 * words.length], row);
      out.set(words, at);
      row += 3;
      at += words.length;
    }
  });
  return out.buffer;
}

/** Begins and ends of what differs: whole blocks, a lone equal one between them kept in. */
function changesOf(now: Uint32Array, was: Uint32Array): number[] {
  const bounds: number[] = [];
  for (let begin = 0; begin < now.length; begin += BLOCK) {
    const end = Math.min(begin + BLOCK, now.length);
    let i = begin;
    while (i < end && now[i] === (i < was.length ? was[i] : 0)) i++;
    if (i === end) continue;
    if (bounds.length > 0 && begin - bounds[bounds.length - 1]! <= BLOCK) bounds[bounds.length - 1] = end;
    else bounds.push(begin, end);
  }
  return bounds;
}
