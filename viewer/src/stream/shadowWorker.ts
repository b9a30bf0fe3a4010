/** A worker that turns the chunks of a shadow map into words for the GPU, level by level. */
import { crc32 } from "../format/crc32";
import { sentenceOf } from "../format/problem";
import { ShadowReader } from "../format/shadow";
import { pack } from "../format/shadowPack";
import type {
  FromShadowWorker,
  OpenShadowMessage,
  ShadowChunkMessage,
  ToShadowWorker,
} from "./shadowMessages";
import { type ShadowStage, stageOf } from "./shadowStage";

/** A map is made of a level where it has so much more than the last that was: all of them cost twice the last. */
const GROWTH = 2;

let opened: OpenShadowMessage | undefined;
let reader: ShadowReader | undefined;
let received = 0;
let shown = 0;

const post = self.postMessage.bind(self) as (message: FromShadowWorker, transfer?: Transferable[]) => void;

self.onmessage = ({ data }: MessageEvent<ToShadowWorker>) => {
  if (data.type === "open") {
    opened = data;
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

/** Chunk 0 has the counts; a map is whole after so many more as there are trees. */
function take({ bytes, isLast }: ShadowChunkMessage): ShadowStage | null {
  if (!opened) throw new Error("A chunk came before its file was opened.");
  const { info, name } = opened;
  if (!reader) {
    reader = new ShadowReader(info, bytes, name);
    return null;
  }
  const isWhole = reader.push(bytes);
  received += bytes.length;
  if (!isWhole || !(isLast || received >= GROWTH * shown)) return null;
  shown = received;
  return stageOf(reader.trees().map((tree) => pack(tree, name)));
}
