/** A worker that turns a node's bytes into arrays for the GPU. */
import { crc32 } from "../format/crc32";
import { PatchDecoder } from "../format/patch";
import { sentenceOf } from "../format/problem";
import type { DecodeMessage, FromWorker, ToWorker } from "./messages";
import { buffersOf, type PackedPatch, packPatch } from "./pack";

const decoders = new Map<number, Promise<PatchDecoder>>();

const post = self.postMessage.bind(self) as (message: FromWorker, transfer?: Transferable[]) => void;

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.type === "open") {
    const decoder = PatchDecoder.create(data.tables, data.streams);
    decoder.catch(() => {}); // said when the first patch asks for it
    decoders.set(data.asset, decoder);
  } else {
    void answer(data);
  }
};

async function answer(message: DecodeMessage): Promise<void> {
  const { job } = message;
  if (crc32(message.bytes) !== message.checksum) {
    post({ job, error: "A checksum does not agree.", isChecksum: true });
    return;
  }
  try {
    const decoder = await decoders.get(message.asset);
    if (!decoder) throw new Error("A patch came before its file was opened.");
    const patches: PackedPatch[] = [];
    let at = 0;
    for (const length of message.patchBytes) {
      patches.push(packPatch(decoder.decode(message.bytes.subarray(at, at + length))));
      at += length;
    }
    post({ job, patches }, buffersOf(patches));
  } catch (error) {
    post({ job, error: sentenceOf(error), isChecksum: false });
  }
}
