import { describe, expect, it } from "vitest";
import { RequestQueue, type Want } from "./queue";
import { Passing } from "./source";

const want = (key: number, start: number, end: number, asset = 0): Want => ({ key, asset, start, end });
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

/** A queue whose answers come when the test says so. */
function bench(limit = 2, mergeBytes = 1000) {
  const asked: {
    start: number;
    end: number;
    isFresh: boolean;
    signal: AbortSignal;
    answer: (error?: Error) => void;
  }[] = [];
  const got: number[] = [];
  const failed: number[] = [];
  const queue = new RequestQueue({
    limit,
    mergeBytes,
    pause: settle as () => Promise<void>,
    read: (_asset, start, end, signal, isFresh) =>
      new Promise((resolve, reject) => {
        signal.addEventListener("abort", () => reject(new DOMException("aborted", "AbortError")));
        const answer = (error?: Error) =>
          error ? reject(error) : resolve(new Uint8Array(end - start).fill(start & 255));
        asked.push({ start, end, isFresh, signal, answer });
      }),
    deliver: ({ key }, bytes) => {
      got.push(key);
      expect(bytes.length).toBeGreaterThan(0);
    },
    fail: ({ key }) => failed.push(key),
  });
  return { queue, asked, got, failed };
}

describe("queue", () => {
  it("asks for the most urgent first, few at a time, and never twice", async () => {
    const { queue, asked, got } = bench();
    const wants = [want(5, 5000, 5100), want(1, 100, 200), want(9, 9000, 9100)];
    queue.want(wants);
    queue.want(wants);
    expect(asked.map(({ start }) => start)).toEqual([5000, 100]);
    asked[0]!.answer();
    await settle();
    expect(got).toEqual([5]);
    expect(asked.map(({ start }) => start)).toEqual([5000, 100, 9000]);
  });

  it("merges neighbours over their padding, up to a size", async () => {
    const { queue, asked, got } = bench(1, 300);
    queue.want([want(1, 0, 98), want(2, 100, 200), want(3, 200, 300), want(4, 300, 400)]);
    expect(asked[0]).toMatchObject({ start: 0, end: 300 });
    asked[0]!.answer();
    await settle();
    expect(got).toEqual([1, 2, 3]);
    expect(asked[1]).toMatchObject({ start: 300, end: 400 });
  });

  it("aborts what left the view, and only that", async () => {
    const { queue, asked, failed } = bench();
    queue.want([want(1, 0, 100), want(5, 5000, 5100)]);
    queue.want([want(5, 5000, 5100), want(7, 7000, 7100)]);
    expect(queue.inFlight).toBe(1);
    await settle();
    expect(queue.inFlight).toBe(2);
    expect(asked.map(({ signal }) => signal.aborted)).toEqual([true, false, false]);
    expect(asked[2]!.start).toBe(7000);
    expect(failed).toEqual([]);
  });

  it("tries again what may pass, gives up after five, and at once on what will not", async () => {
    const { queue, asked, failed } = bench(1);
    queue.want([want(1, 0, 100)]);
    for (let i = 0; i < 5; i++) {
      asked[i]!.answer(new Passing("no network"));
      await settle();
      await settle();
    }
    expect(asked.length).toBe(5);
    expect(failed).toEqual([1]);
    queue.want([want(2, 0, 100)]);
    asked[5]!.answer(new Error("damaged"));
    await settle();
    expect(failed).toEqual([1, 2]);
    expect(asked.length).toBe(6);
  });

  it("goes past caches, alone, after a wrong checksum", async () => {
    const { queue, asked } = bench(1);
    queue.refresh(1);
    queue.want([want(1, 0, 100), want(2, 100, 200)]);
    expect(asked[0]).toMatchObject({ end: 100, isFresh: true });
    asked[0]!.answer();
    await settle();
    expect(asked[1]).toMatchObject({ start: 100, isFresh: false });
  });
});
