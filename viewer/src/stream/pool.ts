/** Workers that decode; each job goes to the one with the least to do. */
import type { PatchStream } from "../format/patch";
import type { FromWorker, OpenMessage, ToWorker } from "./messages";
import type { PackedPatch } from "./pack";

/** The bytes are not those that were written: fetching them once more may help. */
export class ChecksumError extends Error {}

/** The part of a Worker that is used, so that tests need none. */
export interface WorkerLike {
  postMessage(message: ToWorker, transfer: Transferable[]): void;
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  terminate(): void;
}

interface Job {
  readonly resolve: (patches: PackedPatch[]) => void;
  readonly reject: (error: Error) => void;
}

export interface DecodeRequest {
  readonly asset: number;
  readonly bytes: Uint8Array<ArrayBuffer>;
  readonly patchBytes: Uint32Array;
  readonly checksum: number;
}

export class DecoderPool {
  readonly #members: { worker: WorkerLike; jobs: Map<number, Job> }[] = [];
  readonly #opened: OpenMessage[] = [];
  #next = 0;

  constructor(
    private readonly make: () => WorkerLike,
    size: number,
  ) {
    for (let i = 0; i < size; i++) this.#members.push(this.#start());
  }

  /** How many to start on this device: one core is left to the page. */
  static sizeFor(cores: number | undefined): number {
    return Math.max(1, Math.min(4, (cores ?? 2) - 1));
  }

  open(asset: number, tables: Uint8Array, streams: readonly PatchStream[]): void {
    const message: OpenMessage = { type: "open", asset, tables, streams };
    this.#opened.push(message);
    for (const member of this.#members) member.worker.postMessage(message, []);
  }

  /**
   * Decode a node; its bytes are handed over and gone from here.
   *
   * @throws ChecksumError if the bytes are not those that were written, Error if they cannot be decoded.
   */
  decode(request: DecodeRequest): Promise<PackedPatch[]> {
    const member = this.#members.reduce((least, other) =>
      other.jobs.size < least.jobs.size ? other : least,
    );
    const job = this.#next++;
    return new Promise((resolve, reject) => {
      member.jobs.set(job, { resolve, reject });
      member.worker.postMessage({ type: "decode", job, ...request }, [request.bytes.buffer]);
    });
  }

  dispose(): void {
    for (const member of this.#members) member.worker.terminate();
  }

  #start(): { worker: WorkerLike; jobs: Map<number, Job> } {
    const member = { worker: this.make(), jobs: new Map<number, Job>() };
    member.worker.onmessage = ({ data }) => {
      const job = member.jobs.get(data.job);
      member.jobs.delete(data.job);
      if ("patches" in data) job?.resolve(data.patches);
      else job?.reject(data.isChecksum ? new ChecksumError(data.error) : new Error(data.error));
    };
    member.worker.onerror = (event) => this.#replace(member, event.message);
    for (const message of this.#opened) member.worker.postMessage(message, []);
    return member;
  }

  /** A worker that died takes its jobs with it; a new one takes its place for the next. */
  #replace(member: { worker: WorkerLike; jobs: Map<number, Job> }, why: string): void {
    const index = this.#members.indexOf(member);
    if (index < 0) return;
    member.worker.terminate();
    this.#members[index] = this.#start();
    for (const job of member.jobs.values()) job.reject(new Error(`A decoder stopped: ${why}`));
  }
}
