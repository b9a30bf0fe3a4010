import { readFileSync } from "node:fs";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Problem } from "../format/problem";
import type { SlotChanges } from "../format/wire";
import { freshMessage, nextMessage, type Parts, SPLIT, TETRAHEDRON } from "../format/wire.fixture";
import { LiveSource, type SocketLike } from "./live";
import type { Wish } from "./refinement";

const LIMITS = { iterations: 4, edge_px: 8, bend: 0 };

/** What a page wants that looks from this far. */
function wish(distance: number): Wish {
  return {
    camera: {
      position: [0, 0, distance],
      target: [0, 0, 0],
      up: [0, 1, 0],
      fov: 0.7,
      width: 640,
      height: 480,
      near: 0.1,
      far: 100,
    },
    criteria: { front: LIMITS, silhouette: LIMITS, back: LIMITS },
    budget: 1000,
    positions: "control",
    rate: 0,
  };
}

/** A server in the test's hands. */
class FakeSocket implements SocketLike {
  binaryType = "";
  readonly sent: Record<string, unknown>[] = [];
  isClosed = false;
  onopen: SocketLike["onopen"] = null;
  onmessage: SocketLike["onmessage"] = null;
  onclose: SocketLike["onclose"] = null;

  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }

  close(): void {
    this.isClosed = true;
  }

  open(): void {
    this.onopen?.(new Event("open"));
  }

  say(data: unknown): void {
    this.onmessage?.(new MessageEvent("message", { data }));
  }

  drop(): void {
    this.onclose?.(new Event("close") as CloseEvent);
  }

  get seen(): unknown[] {
    return this.sent.map(({ seen }) => seen);
  }

  get distances(): number[] {
    return this.sent.map(({ camera }) => (camera as Wish["camera"]).position[2]);
  }
}

function start() {
  const sockets: FakeSocket[] = [];
  const source = new LiveSource("ws://here/live/a.fov", () => {
    sockets.push(new FakeSocket());
    return sockets.at(-1)!;
  });
  const changes: SlotChanges[] = [];
  const problems: (Problem | null)[] = [];
  source.listen({ onChange: (c) => changes.push(c), onProblem: (p) => problems.push(p) });
  return { source, sockets, changes, problems };
}

const UNSETTLED: Partial<Parts> = { flags: 0 };

describe("a live refinement", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("asks when it is connected, and again only when something changed", () => {
    const { source, sockets, changes } = start();
    source.request(wish(5), 3);
    expect(sockets[0]!.sent).toEqual([]);
    sockets[0]!.open();
    expect(sockets[0]!.seen).toEqual([0]);
    source.request(wish(5), 3);
    expect(source.isSettled).toBe(false);
    sockets[0]!.say(freshMessage(TETRAHEDRON));
    expect(changes.length).toBe(1);
    expect(source.isSettled).toBe(false); // not yet acknowledged
    source.request(wish(5), 3.14);
    expect(sockets[0]!.seen).toEqual([0, 1]);
    expect(sockets[0]!.sent[1]!.drawn_ms).toBe(3.1);
    expect(source.isSettled).toBe(true);
    source.request(wish(5), 3);
    expect(sockets[0]!.sent.length).toBe(2);
    source.request(wish(6), 3);
    expect(sockets[0]!.distances).toEqual([5, 5, 6]);
    expect(source.isSettled).toBe(false);
  });

  it("asks in the words of the wire", () => {
    const golden = JSON.parse(
      readFileSync(new URL("../../../spec/golden/wire.json", import.meta.url), "utf8"),
    ).request;
    const { source, sockets } = start();
    sockets[0]!.open();
    source.request(wish(5), 3.5);
    const shape = (value: unknown): unknown =>
      typeof value === "object" && value !== null && !Array.isArray(value)
        ? Object.fromEntries(
            Object.entries(value)
              .sort()
              .map(([k, v]) => [k, shape(v)]),
          )
        : typeof value;
    expect(shape(sockets[0]!.sent[0])).toEqual(shape(golden));
  });

  it("has one request under way, and the newest camera is the next", () => {
    const { source, sockets } = start();
    const [socket] = sockets as [FakeSocket];
    socket.open();
    for (let distance = 1; distance < 9; distance++) source.request(wish(distance), 1);
    expect(socket.distances).toEqual([1]);
    socket.say(freshMessage(TETRAHEDRON));
    source.request(wish(9), 1);
    expect(socket.distances).toEqual([1, 9]);
    expect(socket.seen).toEqual([0, 1]);
  });

  it("acknowledges what is on its way to settle, picture by picture", () => {
    const { source, sockets } = start();
    const [socket] = sockets as [FakeSocket];
    socket.open();
    source.request(wish(5), 1);
    socket.say(freshMessage(TETRAHEDRON, 1, UNSETTLED));
    source.request(wish(5), 1);
    source.request(wish(5), 1);
    expect(socket.seen).toEqual([0, 1]);
    expect(source.isSettled).toBe(false);
    socket.say(nextMessage(TETRAHEDRON, SPLIT, 2));
    source.request(wish(5), 1);
    expect(socket.seen).toEqual([0, 1, 2]);
    expect(source.isSettled).toBe(true);
    expect(source.figures).toMatchObject({ triangles: 6, updates: 2 });
  });

  it("asks for all after a gap and after a message that is damaged", () => {
    for (const bad of [nextMessage(TETRAHEDRON, SPLIT, 9), new ArrayBuffer(40)]) {
      const { source, sockets, changes } = start();
      const [socket] = sockets as [FakeSocket];
      socket.open();
      source.request(wish(5), 1);
      socket.say(freshMessage(TETRAHEDRON));
      source.request(wish(6), 1);
      socket.say(bad);
      expect(socket.seen).toEqual([0, 1, 0]);
      expect(changes.length).toBe(1);
      expect(source.slots.faceCount).toBe(4); // what is shown stays until all came
      socket.say(freshMessage(SPLIT, 10));
      expect(changes.at(-1)!.isFresh).toBe(true);
      expect(source.slots.faceCount).toBe(6);
    }
  });

  it("gives up where all that comes is damaged, and tries again when told to", () => {
    const { source, sockets, problems } = start();
    sockets[0]!.open();
    source.request(wish(5), 1);
    sockets[0]!.say(new ArrayBuffer(44));
    expect(problems.map((p) => p?.kind)).toEqual(["damaged"]);
    expect(sockets[0]!.isClosed).toBe(true);
    expect(source.isSettled).toBe(true); // nobody shall wait for it
    vi.advanceTimersByTime(1e6);
    expect(sockets.length).toBe(1);
    source.retry();
    sockets[1]!.open();
    expect(sockets[1]!.seen).toEqual([0]);
    expect(problems.at(-1)).toBeNull();
  });

  it("says what the server says", () => {
    const { sockets, problems } = start();
    sockets[0]!.open();
    sockets[0]!.say('{"error": "The refinement failed."}');
    sockets[0]!.drop();
    expect(problems.map((p) => p?.message)).toEqual(["The refinement failed."]);
  });

  it("connects again ever later, says so once, and begins anew", () => {
    const { source, sockets, problems } = start();
    sockets[0]!.open();
    source.request(wish(5), 1);
    sockets[0]!.say(freshMessage(TETRAHEDRON));
    sockets[0]!.drop();
    expect(problems.length).toBe(1);
    const pauses = [500, 1000, 2000, 4000, 8000, 15_000, 15_000];
    pauses.forEach((pause, i) => {
      vi.advanceTimersByTime(pause - 1);
      expect(sockets.length).toBe(i + 1);
      vi.advanceTimersByTime(1);
      expect(sockets.length).toBe(i + 2);
      sockets.at(-1)!.drop();
    });
    expect(problems.length).toBe(1);
    vi.advanceTimersByTime(15_000);
    sockets.at(-1)!.open();
    expect(problems.at(-1)).toBeNull();
    expect(sockets.at(-1)!.seen).toEqual([0]);
    source.dispose();
    expect(sockets.at(-1)!.isClosed).toBe(true);
    vi.advanceTimersByTime(1e6);
    expect(sockets.length).toBe(pauses.length + 2);
  });
});
