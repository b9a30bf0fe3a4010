import { describe, expect, it } from "vitest";
import { ByteCache } from "./cache";
import { packedBytes, packPatch } from "./pack";
import { ChecksumError, DecoderPool, type WorkerLike } from "./pool";

describe("cache", () => {
  it("lets go what was unused for longest, then what matters least, and stops at the lower mark", () => {
    const cache = new ByteCache();
    cache.add(1, 100, 9, 1);
    cache.add(2, 100, 1, 1);
    cache.add(3, 100, 5, 2);
    cache.add(4, 100, 5, 3);
    expect(cache.evict(400, 0, 3)).toEqual([]);
    expect(cache.evict(390, 0, 3)).toEqual([2]);
    expect(cache.bytes).toBe(300);
    expect(cache.evict(400, 200, 3)).toEqual([1, 3]);
  });

  it("never lets go what the present frame uses, even over the budget", () => {
    const cache = new ByteCache();
    for (let key = 0; key < 10; key++) cache.add(key, 100, 1, 7);
    expect(cache.evict(300, 500, 7)).toEqual([]);
    for (let key = 0; key < 5; key++) cache.touch(key, 8);
    expect(cache.evict(300, 0, 8).sort()).toEqual([5, 6, 7, 8, 9]);
    expect(cache.bytes).toBe(500);
  });

  it("counts a node once", () => {
    const cache = new ByteCache();
    cache.add(1, 100, 1, 1);
    cache.add(1, 150, 1, 2);
    expect([cache.bytes, cache.size]).toEqual([150, 1]);
    cache.remove(1);
    cache.remove(1);
    expect(cache.bytes).toBe(0);
  });
});

describe("packing", () => {
  const patch = (positions: number[]) => ({
    positions: Int32Array.from(positions),
    indices: Uint32Array.from([0, 1, 2]),
    normals: new Int16Array(6),
    colours: Uint8Array.from([1, 2, 3, 4, 5, 6, 7, 8, 9]),
  });

  it("keeps every grid position exactly, small or wide", () => {
    for (const scale of [1, 1000, 10_000]) {
      const positions = [7, -3, 5, 107, 50, -60, 2_000_000, 8, 9].map(
        (x) => Math.trunc((x * scale) / 1000) || 0,
      );
      const packed = packPatch(patch(positions));
      const back = positions.map(
        (_, i) => packed.positions[4 * Math.floor(i / 3) + (i % 3)]! + packed.centre[i % 3]!,
      );
      expect(back).toEqual(positions);
    }
  });

  it("takes the bytes that are foreseen for it", () => {
    const packed = packPatch(patch([0, 0, 0, 10, 0, 0, 0, 10, 0]));
    expect(packed.positions).toBeInstanceOf(Int16Array);
    expect(packedBytes(packed)).toBe(3 * (8 + 4 + 4) + 6);
    expect([...packed.colours!]).toEqual([1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255]);
  });

  it("copes with nothing and refuses what floats cannot hold", () => {
    const empty = { positions: new Int32Array(0), indices: new Uint32Array(0), normals: null, colours: null };
    expect(packPatch(empty).radius).toBe(0);
    expect(() => packPatch(patch([-(2 ** 30), 0, 0, 2 ** 30, 0, 0, 0, 0, 0]))).toThrow(/wider/);
  });
});

describe("pool", () => {
  function bench(size: number) {
    const workers: (WorkerLike & { jobs: number[]; isAlive: boolean })[] = [];
    const pool = new DecoderPool(() => {
      const worker: (typeof workers)[number] = {
        jobs: [],
        isAlive: true,
        onmessage: null,
        onerror: null,
        postMessage: (message) => void (message.type === "decode" && worker.jobs.push(message.job)),
        terminate: () => {
          worker.isAlive = false;
        },
      };
      workers.push(worker);
      return worker;
    }, size);
    const decode = () =>
      pool.decode({ asset: 0, bytes: new Uint8Array(4), patchBytes: new Uint32Array([4]), checksum: 0 });
    return { pool, workers, decode };
  }

  it("gives each job to the worker with the least to do", async () => {
    const { workers, decode } = bench(2);
    const jobs = [decode(), decode(), decode()];
    expect(workers.map(({ jobs: own }) => own)).toEqual([[0, 2], [1]]);
    for (const job of [0, 1])
      workers[job]!.onmessage!({ data: { job, patches: [] } } as unknown as MessageEvent);
    const wrong = { job: 2, error: "A checksum does not agree.", isChecksum: true };
    workers[0]!.onmessage!({ data: wrong } as MessageEvent);
    await expect(Promise.all(jobs.slice(0, 2))).resolves.toEqual([[], []]);
    await expect(jobs[2]).rejects.toBeInstanceOf(ChecksumError);
  });

  it("replaces a worker that died and says so for its jobs", async () => {
    const { workers, decode } = bench(1);
    const job = decode();
    workers[0]!.onerror!({ message: "out of memory" } as ErrorEvent);
    await expect(job).rejects.toThrow(/out of memory/);
    expect([workers.length, workers[0]!.isAlive]).toEqual([2, false]);
    void decode();
    expect(workers[1]!.jobs.length).toBe(1);
  });

  it("leaves a core to the page", () => {
    expect([undefined, 1, 2, 4, 64].map((n) => DecoderPool.sizeFor(n))).toEqual([1, 1, 1, 3, 4]);
  });
});
