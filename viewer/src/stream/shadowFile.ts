/** A shadow map from its file: its light at once, its levels as they come, the coarse ones first. */
import { damaged } from "../format/container";
import { type LightInfo, lightOf } from "../format/light";
import { Problem, sentenceOf } from "../format/problem";
import { parseShadow, SHADOW, type ShadowInfo } from "../format/shadow";
import { type OpenFile, openFile, persist } from "./file";
import type { FromShadowWorker, ToShadowWorker } from "./shadowMessages";
import type { ShadowStage } from "./shadowStage";
import { Passing } from "./source";

export interface ShadowFile {
  readonly file: OpenFile;
  readonly info: ShadowInfo;
  readonly light: LightInfo;
}

/** @throws Problem in a sentence about the file. */
export async function openShadow(url: string): Promise<ShadowFile> {
  const file = await openFile(url);
  const { header } = file.container;
  const { name } = file.source;
  if (header.kind !== SHADOW) {
    throw new Problem("foreign", `${name} is no shadow map. Build one with: foveal shadow`);
  }
  const info = parseShadow(header, name);
  return { file, info, light: lightOf(info, name) };
}

export interface ShadowEvents {
  /** A map that is complete down to a level, finer than the one before. */
  readonly onStage: (stage: ShadowStage) => void;
  readonly onProblem: (problem: Problem) => void;
  /** Nothing more comes, be it for a problem. */
  readonly onEnd: () => void;
}

/** The part of a Worker that is used, so that tests need none. */
export interface ShadowWorker {
  postMessage(message: ToShadowWorker, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent<FromShadowWorker>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  terminate(): void;
}

/** Fetches a file's chunks in order, the next while the worker decodes the one before. */
export class ShadowLoad {
  isSettled = true;
  hasFailed = false;

  constructor(
    private readonly shadow: ShadowFile,
    private readonly events: ShadowEvents,
    private readonly makeWorker: () => ShadowWorker = startWorker,
  ) {}

  /** From the beginning; what was received before is in the browser's cache. */
  start(): void {
    if (!this.isSettled) return;
    this.isSettled = false;
    this.hasFailed = false;
    const worker = this.makeWorker();
    void this.#run(worker)
      .catch((error: unknown) => {
        this.hasFailed = true;
        this.events.onProblem(problemOf(error, this.shadow.file.source.name));
      })
      .finally(() => {
        worker.terminate();
        this.isSettled = true;
        this.events.onEnd();
      });
  }

  async #run(worker: ShadowWorker): Promise<void> {
    const { container, source } = this.shadow.file;
    const { lengths, checksums } = container;
    worker.postMessage({ type: "open", info: this.shadow.info, name: source.name });
    let coming = this.#read(0);
    for (let i = 0; i < lengths.length; i++) {
      const bytes = await coming;
      const isLast = i + 1 === lengths.length;
      if (!isLast) {
        coming = this.#read(i + 1);
        coming.catch(() => {}); // told when it is waited for
      }
      const checksum = checksums[i]!;
      let answer = await ask(worker, { type: "chunk", bytes, checksum, isLast });
      if ("error" in answer && answer.isChecksum) {
        const again = await this.#read(i, true); // past all caches
        answer = await ask(worker, { type: "chunk", bytes: again, checksum, isLast });
      }
      if ("error" in answer) throw new Error(answer.error);
      if (answer.stage) this.events.onStage(answer.stage);
    }
  }

  async #read(chunk: number, isFresh = false): Promise<Uint8Array<ArrayBuffer>> {
    const { container, source } = this.shadow.file;
    const start = container.starts[chunk]!;
    const end = start + container.lengths[chunk]!;
    if (source.size !== null && end > source.size) throw damaged(source.name);
    return (await persist(() => source.read(start, end, undefined, isFresh))).slice();
  }
}

function ask(worker: ShadowWorker, message: ToShadowWorker & { type: "chunk" }): Promise<FromShadowWorker> {
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(`A decoder stopped: ${message}`));
    worker.postMessage(message, [message.bytes.buffer]);
  });
}

function problemOf(error: unknown, name: string): Problem {
  if (error instanceof Problem) return error;
  if (error instanceof Passing) return new Problem("network", error.message);
  return new Problem("damaged", `The shadows in ${name} cannot be shown in full: ${sentenceOf(error)}`);
}

function startWorker(): ShadowWorker {
  return new Worker(new URL("./shadowWorker.ts", import.meta.url), { type: "module", name: "shadows" });
}
