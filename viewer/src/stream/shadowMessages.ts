/** What page and shadow worker say to each other. */
import type { ShadowInfo } from "../format/shadow";
import type { ShadowStage } from "./shadowStage";

export interface OpenShadowMessage {
  readonly type: "open";
  readonly info: ShadowInfo;
  readonly name: string;
}

export interface ShadowChunkMessage {
  readonly type: "chunk";
  readonly bytes: Uint8Array<ArrayBuffer>;
  readonly checksum: number;
  readonly isLast: boolean;
}

export type ToShadowWorker = OpenShadowMessage | ShadowChunkMessage;

/** The answer to a chunk. */
export type FromShadowWorker =
  | { readonly stage: ShadowStage | null }
  | { readonly error: string; readonly isChecksum: boolean };
