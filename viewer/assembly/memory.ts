// Where things lie in the module's memory: the file's tables first, then what the patch at hand needs.

import { CONTEXTS, DEGREES, KINDS, PROBABILITY_BITS } from "./layout";

/** Zeros behind the words of a patch: more than one code, vertex or colour can read. */
const PADDING: usize = 64;
const PAGE: usize = 65536;

export let slots: usize = 0; // u32 a slot of a table
export let choices: usize = 0; // u32 a context: bytes from `slots` to its table, and its shift in the low 4 bits
export let weights: usize = 0; // four i64 a kind and three degrees
let free: usize = 0;

export let vertices: u32 = 0;
export let triangles: u32 = 0;
export let words: usize = 0;
export let wordsEnd: usize = 0;
export let positions: usize = 0; // three i32 a vertex
export let faces: usize = 0; // three u32 a triangle
export let normals: usize = 0; // two i16 a vertex
export let colours: usize = 0; // three u8 a vertex
export let corners: usize = 0; // six u32 a vertex
export let degrees: usize = 0; // u32 a vertex
export let edges: usize = 0; // u8 a vertex
export let front: usize = 0; // following, previous, origin, opposite: four u32 a slot
export let states: usize = 0; // u8 a slot
export let stack: usize = 0; // u32
export let sums: usize = 0; // three i64 a vertex: sums of cross products, then three i32: luma and chroma

function take(bytes: usize): usize {
  const at = free;
  free = (at + bytes + 15) & ~15;
  return at;
}

function grow(): bool {
  const pages = <i32>((free + PAGE - 1) / PAGE) - memory.size();
  return pages <= 0 || memory.grow(pages) >= 0;
}

/** Make room for the tables; they are written from here on: slots, choices, weights. 0 if there is no memory. */
export function reserveTables(tables: u32): usize {
  free = (__heap_base + 15) & ~15;
  slots = take((<usize>tables) << (PROBABILITY_BITS + 2));
  choices = take(CONTEXTS << 2);
  weights = take((KINDS * DEGREES * DEGREES * DEGREES) << 5);
  return grow() ? slots : 0;
}

export function addressOfChoices(): usize {
  return choices;
}

export function addressOfWeights(): usize {
  return weights;
}

/** Make room for a patch; its words are to be written at the address that is returned, 0 for no memory. */
export function reservePatch(n: u32, m: u32, bytes: usize, hasNormals: bool, hasColours: bool): usize {
  const begin = weights + ((KINDS * DEGREES * DEGREES * DEGREES) << 5);
  free = (begin + 15) & ~15;
  vertices = n;
  triangles = m;
  words = take(bytes + PADDING);
  wordsEnd = words + bytes;
  positions = take(<usize>n * 12);
  faces = take(<usize>m * 12);
  normals = take(hasNormals ? <usize>n * 4 : 0);
  colours = take(hasColours ? <usize>n * 3 : 0);
  corners = take(<usize>n * 24);
  degrees = take(<usize>n * 4);
  edges = take(n);
  front = take((<usize>m * 3 + 4) << 4);
  states = take(<usize>m * 3 + 4);
  stack = take((<usize>m + 1) << 2);
  sums = hasNormals || hasColours ? take(<usize>n * 24) : 0;
  if (!grow()) return 0;
  memory.fill(wordsEnd, 0, PADDING);
  memory.fill(degrees, 0, <usize>n * 4);
  memory.fill(edges, 0, n);
  return words;
}

export function addressOfPositions(): usize {
  return positions;
}

export function addressOfFaces(): usize {
  return faces;
}

export function addressOfNormals(): usize {
  return normals;
}

export function addressOfColours(): usize {
  return colours;
}
