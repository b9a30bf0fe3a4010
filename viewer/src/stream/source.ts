/** A file behind HTTP, read by ranges; where the server has none, read once and cut in memory. */
import { nameOf, Problem } from "../format/problem";

/** The part of `fetch` that is used, so that tests need no network. */
export type Fetch = (url: string, init: RequestInit) => Promise<Response>;

/** First request: holds header, index and graph of all but very large files. */
const FIRST_BYTES = 1 << 16;

/** Tells whether trying again may help: the network failed, or the server did. */
export class Passing extends Error {}

export class Source {
  /** Bytes received so far. */
  received = 0;
  /** The whole file, where the server answered a range with all of it. */
  whole: Uint8Array | null = null;
  /** Bytes of the file, where the server said so. */
  size: number | null = null;
  /** What came with the first request. */
  head: Uint8Array = new Uint8Array(0);
  #tag: string | null = null;

  private constructor(
    readonly url: string,
    private readonly fetch: Fetch,
  ) {}

  get name(): string {
    return nameOf(this.url);
  }

  /**
   * Ask for the first bytes and learn whether the server has ranges.
   *
   * @param onProgress - Called while a body without ranges is read, with the share so far, 0 to 1.
   * @throws Problem if the file is missing; Passing if trying again may help.
   */
  static async open(
    url: string,
    signal?: AbortSignal,
    onProgress: (share: number) => void = () => {},
    fetch: Fetch = (input, init) => globalThis.fetch(input, init),
  ): Promise<Source> {
    const source = new Source(url, fetch);
    const response = await source.#request(0, FIRST_BYTES, signal);
    source.#tag = validatorOf(response);
    if (response.status === 206) {
      source.size = totalOf(response);
      source.head = await source.#body(response);
    } else if (response.status === 416) {
      source.size = 0; // an empty file: the reader of the header says what is wrong with it
    } else {
      source.whole = await source.#body(response, onProgress);
      source.size = source.whole.length;
      source.head = source.whole;
    }
    return source;
  }

  /**
   * Bytes from `start` up to and without `end`.
   *
   * @param isFresh - Pass by all caches, after a checksum that did not agree.
   * @throws Problem if the file changed since it was opened; Passing if trying again may help.
   */
  async read(start: number, end: number, signal?: AbortSignal, isFresh = false): Promise<Uint8Array> {
    if (this.whole) return this.whole.subarray(start, end);
    if (end <= this.head.length) return this.head.subarray(start, end);
    const response = await this.#request(start, end, signal, isFresh);
    const isOther = validatorOf(response) !== this.#tag;
    if (response.status !== 206 || isOther || totalOf(response) !== this.size) {
      await response.body?.cancel();
      throw new Problem("changed", `${this.name} was replaced while it was being read. Reload the page.`);
    }
    const bytes = await this.#body(response);
    if (bytes.length !== end - start) throw new Passing(`${this.name}: the server cut an answer short.`);
    return bytes;
  }

  async #request(start: number, end: number, signal?: AbortSignal, isFresh = false): Promise<Response> {
    const headers: Record<string, string> = { Range: `bytes=${start}-${end - 1}` };
    if (this.#tag !== null && start > 0) headers["If-Range"] = this.#tag;
    let response: Response;
    try {
      const init: RequestInit = { headers, cache: isFresh ? "reload" : "default" };
      if (signal) init.signal = signal;
      response = await this.fetch(this.url, init);
    } catch (error) {
      if (signal?.aborted) throw error;
      throw new Passing(`${this.name} cannot be reached. Is the server running, and the network there?`);
    }
    if (response.ok || (response.status === 416 && start === 0)) return response;
    await response.body?.cancel();
    if (response.status >= 500 || response.status === 429 || response.status === 408) {
      throw new Passing(`${this.name}: the server failed (status ${response.status}).`);
    }
    const why =
      response.status === 404 ? "is not there" : `was refused by the server (status ${response.status})`;
    throw new Problem("missing", `${this.name} ${why}. Check its address: ${this.url}`);
  }

  async #body(response: Response, onProgress: (share: number) => void = () => {}): Promise<Uint8Array> {
    const expected = Number(response.headers.get("Content-Length") ?? 0);
    const pieces: Uint8Array[] = [];
    let length = 0;
    try {
      const reader = response.body?.getReader();
      for (let next = await reader?.read(); next && !next.done; next = await reader?.read()) {
        pieces.push(next.value);
        length += next.value.length;
        this.received += next.value.length;
        if (expected > 0) onProgress(Math.min(1, length / expected));
      }
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") throw error;
      throw new Passing(`${this.name}: the connection broke.`);
    }
    const bytes = new Uint8Array(length);
    let at = 0;
    for (const piece of pieces) {
      bytes.set(piece, at);
      at += piece.length;
    }
    return bytes;
  }
}

/** A strong validator, the only kind that If-Range may carry (RFC 9110, 13.1.5). */
function validatorOf(response: Response): string | null {
  const tag = response.headers.get("ETag");
  return tag && !tag.startsWith("W/") ? tag : response.headers.get("Last-Modified");
}

function totalOf(response: Response): number | null {
  const total = /\/(\d+)$/.exec(response.headers.get("Content-Range") ?? "")?.[1];
  return total === undefined ? null : Number(total);
}
