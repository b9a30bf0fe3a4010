/** A `.fov` of any kind, opened: its header and index, and what came with them. */
import { type Container, damaged, headLength, parseContainer } from "../format/container";
import { type Fetch, Passing, Source } from "./source";

export interface OpenFile {
  readonly source: Source;
  readonly container: Container;
}

export interface OpenOptions {
  readonly signal?: AbortSignal;
  /** Hears the share that is there of a file that comes as a whole, 0 to 1. */
  readonly onProgress?: (share: number) => void;
  readonly fetch?: Fetch;
}

const TRIES = 4;

/**
 * Fetch and check header and index.
 *
 * @throws Problem in a sentence about the file.
 */
export async function openFile(url: string, options: OpenOptions = {}): Promise<OpenFile> {
  const source = await persist(() => Source.open(url, options.signal, options.onProgress, options.fetch));
  const { name } = source;
  const headBytes = await atLeast(source, headLength(source.head, name), options.signal);
  return { source, container: parseContainer(headBytes, name, source.size) };
}

/** Bytes of a chunk, with all before it; that they are the right ones is not yet checked. */
export async function chunkOf(
  { source, container }: OpenFile,
  number: number,
  signal?: AbortSignal,
): Promise<Uint8Array> {
  const first = container.starts[number]!;
  const end = first + container.lengths[number]!;
  return (await atLeast(source, end, signal)).subarray(first, end);
}

/** The file's first bytes up to `end`, the missing ones fetched. */
async function atLeast(source: Source, end: number, signal?: AbortSignal): Promise<Uint8Array> {
  const have = source.head;
  if (end <= have.length) return have;
  if (source.size !== null && end > source.size) throw damaged(source.name);
  const rest = await persist(() => source.read(have.length, end, signal));
  const all = new Uint8Array(end);
  all.set(have);
  all.set(rest, have.length);
  source.head = all;
  return all;
}

/** Try again, ever later, what may pass. */
export async function persist<T>(work: () => Promise<T>, tries = TRIES, firstPause = 300): Promise<T> {
  for (let attempt = 1; ; attempt++) {
    try {
      return await work();
    } catch (error) {
      if (!(error instanceof Passing) || attempt >= tries) throw error;
      await new Promise((resolve) => setTimeout(resolve, firstPause * 2 ** (attempt - 1)));
    }
  }
}
