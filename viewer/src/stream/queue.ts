/** What to fetch next: greatest screen error first, few at a time, neighbours in one request. */
import { Passing } from "./source";

/** A node that is wanted: where its bytes are. */
export interface Want {
  /** Identity over all files. */
  readonly key: number;
  /** File that it is in. */
  readonly asset: number;
  readonly start: number;
  readonly end: number;
}

export interface QueueOptions {
  /** Fetch bytes of a file; throws Passing if trying again may help. */
  readonly read: (
    asset: number,
    start: number,
    end: number,
    signal: AbortSignal,
    isFresh: boolean,
  ) => Promise<Uint8Array>;
  readonly deliver: (want: Want, bytes: Uint8Array) => void;
  /** Given up after all tries, or at once for what cannot pass. */
  readonly fail: (want: Want, error: unknown) => void;
  readonly limit?: number;
  readonly mergeBytes?: number;
  readonly pause?: (milliseconds: number) => Promise<void>;
}

interface Flight {
  readonly wants: Want[];
  readonly abort: AbortController;
}

const TRIES = 5;
const FIRST_PAUSE_MS = 400;

export class RequestQueue {
  #wanted: readonly Want[] = [];
  readonly #flights = new Set<Flight>();
  readonly #flying = new Set<number>();
  readonly #tries = new Map<number, number>();
  readonly #waiting = new Set<number>();
  readonly #fresh = new Set<number>();
  readonly #limit: number;
  readonly #mergeBytes: number;
  readonly #pause: (milliseconds: number) => Promise<void>;

  constructor(private readonly options: QueueOptions) {
    this.#limit = options.limit ?? 6;
    this.#mergeBytes = options.mergeBytes ?? 1 << 18;
    this.#pause = options.pause ?? ((ms) => new Promise((resolve) => setTimeout(resolve, ms)));
  }

  /** Requests under way; not those given up, of whose end nobody is told. */
  get inFlight(): number {
    let count = 0;
    for (const flight of this.#flights) if (!flight.abort.signal.aborted) count++;
    return count;
  }

  has(key: number): boolean {
    return this.#flying.has(key) || this.#waiting.has(key);
  }

  /** Replace what is wanted, most urgent first. Requests for nothing that is still wanted are aborted. */
  want(wanted: readonly Want[]): void {
    this.#wanted = wanted;
    const keys = new Set(wanted.map((want) => want.key));
    for (const flight of this.#flights) {
      if (!flight.wants.some((want) => keys.has(want.key))) flight.abort.abort();
    }
    this.#pump();
  }

  /** Ask for this node past all caches the next time: its checksum did not agree. */
  refresh(key: number): void {
    this.#fresh.add(key);
  }

  /** Forget failures, e.g. when the network is back. */
  forgive(): void {
    this.#tries.clear();
  }

  #pump(): void {
    while (this.#flights.size < this.#limit) {
      const first = this.#wanted.find((want) => !this.has(want.key));
      if (!first) return;
      void this.#fly(this.#merge(first));
    }
  }

  /** The want and its wanted neighbours in the file, up to a size that does not delay the first. */
  #merge(first: Want): Want[] {
    const isAlone = this.#fresh.has(first.key);
    const group = [first];
    const candidates = isAlone
      ? []
      : this.#wanted.filter((want) => want.asset === first.asset && !this.has(want.key));
    const byStart = new Map(candidates.map((want) => [want.start, want]));
    let last = first;
    for (;;) {
      // chunks are padded to a multiple of four, so the next one starts up to three bytes later
      const next = byStart.get(Math.ceil(last.end / 4) * 4);
      if (!next || next.end - first.start > this.#mergeBytes) return group;
      group.push(next);
      last = next;
    }
  }

  async #fly(wants: Want[]): Promise<void> {
    const flight: Flight = { wants, abort: new AbortController() };
    this.#flights.add(flight);
    for (const want of wants) this.#flying.add(want.key);
    const start = wants[0]!.start;
    const end = wants.at(-1)!.end;
    const isFresh = wants.some((want) => this.#fresh.delete(want.key));
    try {
      const bytes = await this.options.read(wants[0]!.asset, start, end, flight.abort.signal, isFresh);
      this.#land(flight);
      this.#forget(wants);
      for (const want of wants) {
        this.#tries.delete(want.key);
        this.options.deliver(want, bytes.slice(want.start - start, want.end - start));
      }
    } catch (error) {
      this.#land(flight);
      if (!flight.abort.signal.aborted) this.#failed(wants, error);
    }
    this.#pump();
  }

  #land(flight: Flight): void {
    this.#flights.delete(flight);
    for (const want of flight.wants) this.#flying.delete(want.key);
  }

  /** Delivered or given up: not wanted again until somebody says so. */
  #forget(wants: readonly Want[]): void {
    const keys = new Set(wants.map((want) => want.key));
    this.#wanted = this.#wanted.filter((want) => !keys.has(want.key));
  }

  #failed(wants: Want[], error: unknown): void {
    for (const want of wants) {
      const tries = (this.#tries.get(want.key) ?? 0) + 1;
      this.#tries.set(want.key, tries);
      if (!(error instanceof Passing) || tries >= TRIES) {
        this.#tries.delete(want.key);
        this.#forget([want]);
        this.options.fail(want, error);
        continue;
      }
      this.#waiting.add(want.key);
      void this.#pause(FIRST_PAUSE_MS * 2 ** (tries - 1)).then(() => {
        this.#waiting.delete(want.key);
        this.#pump();
      });
    }
  }
}
