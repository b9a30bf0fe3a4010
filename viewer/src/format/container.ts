/** The `.fov` file: prefix, header, index (spec/container.md). Nothing is allocated before it is checked. */
import { crc32 } from "./crc32";
import { Problem } from "./problem";

const MAGIC = 0x1a564f46;
const CONTAINER_VERSION = 1;
const PREFIX_BYTES = 20;
const MAX_HEADER_BYTES = 1 << 24;
const MAX_CHUNKS = 1 << 24;

/** A JSON object of unknown keys. */
export type Header = Readonly<Record<string, unknown>>;

/** Where the chunks of a file are. */
export interface Container {
  readonly header: Header;
  /** First byte of chunk i; one more entry for the end of the file. */
  readonly starts: Float64Array;
  /** Its length without padding. */
  readonly lengths: Uint32Array;
  readonly checksums: Uint32Array;
  /** Bytes of the whole file. */
  readonly size: number;
}

/**
 * How many bytes from the start hold header and index, read from the first 20.
 *
 * @throws Problem if these are not a `.fov`'s, or one of a container version that is not known here.
 */
export function headLength(bytes: Uint8Array, name: string): number {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < PREFIX_BYTES || view.getUint32(0, true) !== MAGIC) {
    throw new Problem("foreign", `${name} is not a .fov file. Build one with: foveal build`);
  }
  const version = view.getUint16(4, true);
  if (version !== CONTAINER_VERSION) {
    throw new Problem(
      "version",
      `${name} has container version ${version}; this viewer knows version ${CONTAINER_VERSION}. Update foveal, or build the file again.`,
    );
  }
  const headerBytes = view.getUint32(8, true);
  const chunks = view.getUint32(12, true);
  const isAligned = (PREFIX_BYTES + headerBytes) % 4 === 0;
  if (headerBytes > MAX_HEADER_BYTES || chunks > MAX_CHUNKS || chunks < 1 || !isAligned) throw damaged(name);
  return PREFIX_BYTES + headerBytes + 8 * chunks;
}

/**
 * Header and index from at least the first `headLength` bytes.
 *
 * @param size - Bytes of the whole file where that is known: it must be what the index says.
 * @throws Problem if a checksum, an offset or the header is wrong.
 */
export function parseContainer(bytes: Uint8Array, name: string, size: number | null = null): Container {
  const length = headLength(bytes, name);
  if (bytes.length < length) throw damaged(name);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (view.getUint32(16, true) !== crc32(bytes.subarray(PREFIX_BYTES, length))) throw damaged(name);
  const indexStart = PREFIX_BYTES + view.getUint32(8, true);
  const count = view.getUint32(12, true);
  const starts = new Float64Array(count + 1);
  const lengths = new Uint32Array(count);
  const checksums = new Uint32Array(count);
  starts[0] = length;
  for (let i = 0; i < count; i++) {
    const bytesOf = view.getUint32(indexStart + 8 * i, true);
    lengths[i] = bytesOf;
    checksums[i] = view.getUint32(indexStart + 8 * i + 4, true);
    starts[i + 1] = starts[i]! + bytesOf + ((4 - (bytesOf % 4)) % 4);
  }
  const end = starts[count]!;
  if (size !== null && size !== end) {
    throw new Problem(
      "damaged",
      `${name} has ${size.toLocaleString("en")} bytes and should have ${end.toLocaleString("en")}: it was not copied whole. Copy it again.`,
    );
  }
  return {
    header: parseHeader(bytes.subarray(PREFIX_BYTES, indexStart), name),
    starts,
    lengths,
    checksums,
    size: end,
  };
}

function parseHeader(bytes: Uint8Array, name: string): Header {
  try {
    const header: unknown = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    if (typeof header === "object" && header !== null && !Array.isArray(header)) return header as Header;
  } catch {
    // not JSON: falls through to the one sentence
  }
  throw damaged(name);
}

/** The one sentence for bytes that contradict each other. */
export function damaged(name: string): Problem {
  return new Problem(
    "damaged",
    `${name} is damaged: its header, index or graph does not hold together. Copy or build it again.`,
  );
}
