/** What page and decoding workers say to each other. */
import type { PatchStream } from "../format/patch";
import type { PackedPatch } from "./pack";

export interface OpenMessage {
  readonly type: "open";
  readonly asset: number;
  readonly tables: Uint8Array;
  readonly streams: readonly PatchStream[];
}

export interface DecodeMessage {
  readonly type: "decode";
  readonly job: number;
  readonly asset: number;
  /** A node's chunk: its patches one after the other. */
  readonly bytes: Uint8Array<ArrayBuffer>;
  readonly patchBytes: Uint32Array;
  readonly checksum: number;
}

export type ToWorker = OpenMessage | DecodeMessage;

export type FromWorker =
  | { readonly job: number; readonly patches: PackedPatch[] }
  | { readonly job: number; readonly error: string; readonly isChecksum: boolean };
