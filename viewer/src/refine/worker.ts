/** A worker that refines: requests come in as the text of spec/wire.md, its messages go out. */
import type { Triple } from "../format/graph";
import { Problem } from "../format/problem";
import type { Dialogue } from "./dialogue";
import { type Cage, sessionOf } from "./sessions";

/** What a worker is told first. */
export interface StartMessage {
  readonly cage: Cage;
  /** What positions are told relative to. */
  readonly origin: Triple;
  /** Of the file, for sentences. */
  readonly name: string;
}

const post = self.postMessage.bind(self) as (
  message: ArrayBuffer | string,
  transfer?: Transferable[],
) => void;

let start: StartMessage | undefined;
let session: Dialogue | undefined;

self.onmessage = ({ data }: MessageEvent<StartMessage | string>) => {
  if (typeof data !== "string") {
    start = data;
    return;
  }
  try {
    // Made when it is first asked for something, so that there is somebody to hear what is wrong.
    session ??= sessionOf(start!.cage, start!.origin, start!.name);
    const message = session.answer(JSON.parse(data));
    if (message) post(message, [message]);
  } catch (error) {
    post(JSON.stringify({ error: sentence(error) }));
  }
};

function sentence(error: unknown): string {
  if (error instanceof Problem) return error.message;
  if (error instanceof RangeError) {
    return "This device has not enough memory for so many triangles. Allow fewer, and reload the page.";
  }
  return `The refinement stopped (${String(error)}). Reload the page.`;
}
