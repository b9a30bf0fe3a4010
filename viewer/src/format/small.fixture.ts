/** A small `.fov` for tests, written by spec/container.md. */
import { crc32 } from "./crc32";

/** Two nodes: one patch of one triangle, refined by one patch of two. Patch bytes are a plain payload. */
export const PATCHES: readonly Uint8Array[] = [new Uint8Array([1, 2, 3, 4, 5]), new Uint8Array([6, 7, 8])];

export const HEADER = {
  kind: "multires",
  version: 1,
  first_bytes: 0,
  generator: "test",
  origin: [500000.25, 4800000.5, 10],
  step: 0.001,
  box: [
    [0, 0, 0],
    [1000, 1000, 500],
  ],
  up: "z",
  unit: "m",
  triangles: 2,
  vertices: 4,
  nodes: 2,
  patches: 2,
  levels: 2,
  streams: [
    { name: "position", type: "grid3" },
    { name: "normal", type: "octahedron", bits: 10 },
  ],
  codec: "test",
};

export function graphChunk(finer: readonly number[] = [1, -1]): Uint8Array {
  const lengths = PATCHES.map((patch) => patch.length);
  const parts: ArrayBufferView[] = [
    new Uint32Array([0, 1, 2]),
    new Float32Array([0.5, 0.5, 0.25, 1, 0.5, 0.5, 0.25, 1]),
    new Float32Array([Number.POSITIVE_INFINITY, 0.01]),
    new Int32Array(finer),
    new Uint32Array([1, 2]),
    new Uint32Array([3, 4]),
    new Uint32Array(lengths),
    new Uint8Array([10, 20]), // tables
  ];
  return concat(parts.map((part) => new Uint8Array(part.buffer)));
}

export function fovFile(
  header: object = HEADER,
  chunks = [graphChunk(), ...PATCHES],
): Uint8Array<ArrayBuffer> {
  let text = JSON.stringify(header);
  text += " ".repeat((4 - (text.length % 4)) % 4);
  const headerBytes = new TextEncoder().encode(text);
  const index = new Uint32Array(chunks.flatMap((chunk) => [chunk.length, crc32(chunk)]));
  const checked = concat([headerBytes, new Uint8Array(index.buffer)]);
  const prefix = new DataView(new ArrayBuffer(20));
  prefix.setUint32(0, 0x1a564f46, true);
  prefix.setUint16(4, 1, true);
  prefix.setUint32(8, headerBytes.length, true);
  prefix.setUint32(12, chunks.length, true);
  prefix.setUint32(16, crc32(checked), true);
  const padded = chunks.flatMap((chunk) => [chunk, new Uint8Array((4 - (chunk.length % 4)) % 4)]);
  return concat([new Uint8Array(prefix.buffer), checked, ...padded]);
}

function concat(parts: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const out = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
