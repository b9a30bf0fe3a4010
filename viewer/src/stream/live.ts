/**
 * A refinement by the server (spec/wire.md): one request under way, the newest camera wins.
 *
 * A request is sent when the one before was answered, so it always has the camera of the picture being drawn, and
 * it acknowledges what was applied; the server computes while the page draws. What does not fit together (a gap, a
 * damaged message) has all sent anew. A connection that is lost is made again, ever later.
 */
import { Problem, sentenceOf } from "../format/problem";
import { Gap, parseMessage, SlotBuffers } from "../format/wire";
import type { RefinementFigures, RefinementListener, RefinementSource, Wish } from "./refinement";

/** The part of a WebSocket that is used, so that tests need no network. */
export interface SocketLike {
  binaryType: string;
  send(text: string): void;
  close(): void;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
}

const FIRST_PAUSE_MS = 500;
const LONGEST_PAUSE_MS = 15_000;

type Phase = "connecting" | "open" | "waiting" | "refused";

export class LiveSource implements RefinementSource {
  readonly slots = new SlotBuffers();
  #listener: RefinementListener = { onChange: () => {}, onProblem: () => {} };
  #socket: SocketLike | undefined;
  #phase: Phase = "waiting";
  #timer: ReturnType<typeof setTimeout> | undefined;
  #pause = FIRST_PAUSE_MS;
  /** What is wanted, as it will be sent; and what the server was last asked for. */
  #wish: Wish | null = null;
  #wanted = "";
  #asked = "";
  /** The server owes an answer. */
  #isUnderWay = false;
  /** A message was applied and not yet acknowledged. */
  #isUnseen = false;
  #isServerSettled = false;
  #isTroubled = false;
  #figures: RefinementFigures = { triangles: 0, milliseconds: 0, threshold: 1, updates: 0, receivedBytes: 0 };

  /** @param url - Where the WebSocket is, with `ws:` or `wss:`. */
  constructor(
    private readonly url: string,
    private readonly connect: (url: string) => SocketLike = (address) => new WebSocket(address),
  ) {
    this.#connect();
  }

  get figures(): RefinementFigures {
    return this.#figures;
  }

  get isSettled(): boolean {
    if (this.#phase === "waiting" || this.#phase === "refused") return true; // no picture waits for it
    return this.#isServerSettled && !this.#isUnseen && !this.#isUnderWay && this.#wanted === this.#asked;
  }

  listen(listener: RefinementListener): void {
    this.#listener = listener;
  }

  request(wish: Wish, drawnMs: number): void {
    this.#wish = wish;
    this.#wanted = JSON.stringify(wish);
    if (this.#phase !== "open" || this.#isUnderWay) return;
    const isOther = this.#wanted !== this.#asked;
    if (isOther || this.#isUnseen) this.#send(Math.min(1e4, Math.round(10 * drawnMs) / 10));
  }

  retry(): void {
    if (this.#phase === "open" || this.#phase === "connecting") return;
    clearTimeout(this.#timer);
    this.#connect();
  }

  dispose(): void {
    clearTimeout(this.#timer);
    this.#leave();
    this.#phase = "refused";
  }

  #send(drawnMs: number): void {
    const isOther = this.#wanted !== this.#asked;
    this.#socket?.send(JSON.stringify({ ...this.#wish, drawn_ms: drawnMs, seen: this.slots.sequence }));
    this.#asked = this.#wanted;
    this.#isUnseen = false;
    // a settled server answers nothing but another wish
    this.#isUnderWay = isOther || !this.#isServerSettled;
  }

  #connect(): void {
    this.#phase = "connecting";
    let socket: SocketLike;
    try {
      socket = this.connect(this.url);
    } catch (error) {
      this.#refuse(new Problem("network", sentenceOf(error)));
      return;
    }
    this.#socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.#open();
    socket.onmessage = ({ data }) => this.#take(data);
    socket.onclose = () => this.#lose();
  }

  #open(): void {
    this.#phase = "open";
    this.#pause = FIRST_PAUSE_MS;
    this.#askForAll();
    if (this.#isTroubled) this.#listener.onProblem(null);
    this.#isTroubled = false;
  }

  /** Have everything sent anew; what is shown stays until it comes. */
  #askForAll(): void {
    this.slots.sequence = 0;
    this.#asked = "";
    this.#isUnderWay = false;
    this.#isUnseen = false;
    this.#isServerSettled = false;
    if (this.#wish) this.#send(0);
  }

  #take(data: unknown): void {
    if (typeof data === "string") this.#refuse(new Problem("damaged", errorOf(data)));
    else if (data instanceof ArrayBuffer) this.#apply(data);
  }

  #apply(data: ArrayBuffer): void {
    let changes: ReturnType<SlotBuffers["apply"]>;
    let message: ReturnType<typeof parseMessage>;
    try {
      message = parseMessage(data);
      changes = this.slots.apply(message);
    } catch (error) {
      if (!(error instanceof Gap || error instanceof Problem)) throw error;
      // what is sent from nothing would come again as it was
      if (this.slots.sequence > 0) this.#askForAll();
      else this.#refuse(new Problem("damaged", DAMAGED));
      return;
    }
    this.#isUnderWay = false;
    this.#isUnseen = true;
    this.#isServerSettled = message.isSettled;
    const { triangles, milliseconds, threshold } = message;
    const updates = this.#figures.updates + 1;
    const receivedBytes = this.#figures.receivedBytes + data.byteLength;
    this.#figures = { triangles, milliseconds, threshold, updates, receivedBytes };
    this.#listener.onChange(changes);
  }

  /** The connection is gone: make it again, ever later. */
  #lose(): void {
    if (this.#phase === "refused") return;
    this.#leave();
    this.#phase = "waiting";
    this.#timer = setTimeout(() => this.#connect(), this.#pause);
    this.#pause = Math.min(2 * this.#pause, LONGEST_PAUSE_MS);
    if (!this.#isTroubled) this.#listener.onProblem(new Problem("network", LOST));
    this.#isTroubled = true;
  }

  /** The server says no, or nothing that can be understood: only the visitor may try again. */
  #refuse(problem: Problem): void {
    this.#leave();
    this.#phase = "refused";
    this.#isTroubled = true;
    this.#listener.onProblem(problem);
  }

  #leave(): void {
    const socket = this.#socket;
    this.#socket = undefined;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }
}

const LOST =
  "The server does not answer, so the surface no longer follows the view. It is tried again; if the server was started anew, reload the page.";
const DAMAGED = "The server's messages cannot be read. Is it of the same version? Reload the page.";

function errorOf(text: string): string {
  try {
    const data: unknown = JSON.parse(text);
    if (typeof data === "object" && data !== null && "error" in data && typeof data.error === "string")
      return data.error;
  } catch {
    // said below
  }
  return DAMAGED;
}
