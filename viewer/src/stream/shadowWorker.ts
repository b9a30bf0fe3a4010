/** A worker that turns the chunks of a shadow map into words for the GPU, level by level. */
import { crc32 } from "../format/crc32";
import { sentenceOf } from "../format/problem";
import { pack, ShadowDecoder } from "../format/shadow";
import type { FromShadowWorker, ShadowChunkMessage, ToShadowWorker } from "./shadowMessages";
import { type ShadowStage, stageOf } from "./shadowStage";

/** A map is made of a level where it has so much more than the last that was: all of them cost twice the last. */
const GROWTH = 2;

let decoder: ShadowDecoder | undefined;
let received = 0;
let shown = 0;

const post = self.postMessage.bind(self) as (message: FromShadowWorker, transfer?: Transferable[]) => void;

self.onmessage = ({ data }: MessageEvent<ToShadowWorker>) => {
  if (data.type === "open") {
    decoder = new ShadowDecoder(data.header, data.name);
    return;
  }
  if (crc32(data.bytes) !== data.checksum) {
    post({ error: "A checksum does not agree.", isChecksum: true });
    return;
  }
  try {
    const stage = take(data);
    post({ stage }, stage ? [stage.words.buffer] : []);
  } catch (error) {
    post({ error: sentenceOf(error), isChecksum: false });
  }
};

function take({ bytes, isLast }: ShadowChunkMessage): ShadowStage | null {
  if (!decoder) throw new Error("A chunk came before its file was opened.");
  const isLevelWhole = decoder.push(bytes);
  received += bytes.length;
  if (!isLevelWhole || !(isLast || received >= GROWTH * shown)) return null;
  shown = received;
  return stageOf(decoder.trees().map(pack));
}
