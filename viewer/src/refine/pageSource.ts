/**
 * A refinement by the page itself: the same protocol as with a server (spec/wire.md), spoken with a worker.
 *
 * So there is one way in which slots reach the picture, and one that is tested. Nothing goes over the network.
 */
import { LiveSource, type SocketLike } from "../stream/live";
import type { RefinementFigures } from "../stream/refinement";
import type { StartMessage } from "./worker";

/** The part of a Worker that is used, so that tests need none. */
export interface WorkerLike {
  postMessage(message: StartMessage | string): void;
  onmessage: ((event: MessageEvent) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  terminate(): void;
}

export class PageSource extends LiveSource {
  /** @param fileBytes - All that comes over the network. */
  constructor(
    start: StartMessage,
    private readonly fileBytes: number,
    make: () => WorkerLike = makeWorker,
  ) {
    super("", () => new WorkerSocket(make(), start));
  }

  override get figures(): RefinementFigures {
    return { ...super.figures, receivedBytes: this.fileBytes };
  }
}

/** A worker as the other end of a socket. */
class WorkerSocket implements SocketLike {
  binaryType = "arraybuffer";
  onopen: ((event: Event) => void) | null = null;
  onmessage: ((event: MessageEvent) => void) | null = null;
  onclose: ((event: CloseEvent) => void) | null = null;

  constructor(
    private readonly worker: WorkerLike,
    start: StartMessage,
  ) {
    worker.onmessage = (event) => this.onmessage?.(event);
    worker.onerror = ({ message }) => {
      const error = `The refinement stopped (${message || "its program could not be loaded"}). Reload the page.`;
      this.onmessage?.(new MessageEvent("message", { data: JSON.stringify({ error }) }));
    };
    worker.postMessage(start);
    queueMicrotask(() => this.onopen?.(new Event("open")));
  }

  send(text: string): void {
    this.worker.postMessage(text);
  }

  close(): void {
    this.worker.terminate();
  }
}

function makeWorker(): WorkerLike {
  return new Worker(new URL("./worker.ts", import.meta.url), { type: "module", name: "refinement" });
}
