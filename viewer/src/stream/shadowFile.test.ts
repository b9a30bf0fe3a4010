import { describe, expect, it } from "vitest";
import { INNER, LEAF } from "../format/shadowTree";
import type { OpenFile } from "./file";
import { type ShadowEvents, type ShadowFile, ShadowLoad, type ShadowWorker } from "./shadowFile";
import type { FromShadowWorker, ToShadowWorker } from "./shadowMessages";
import { MOST_LEVELS, type ShadowStage, stageOf } from "./shadowStage";

const STAGE = {} as ShadowStage;

/** A worker that answers chunks in turn, and what it was given. */
function workerOf(answers: FromShadowWorker[]): {
  worker: ShadowWorker;
  chunks: string[];
  isEnded: () => boolean;
} {
  const chunks: string[] = [];
  let isEnded = false;
  const worker: ShadowWorker = {
    onmessage: null,
    onerror: null,
    postMessage(message: ToShadowWorker) {
      if (message.type === "open") return;
      chunks.push(`${message.bytes}${message.isLast ? "." : ""}`);
      const data = answers.shift()!;
      queueMicrotask(() => worker.onmessage!({ data } as MessageEvent<FromShadowWorker>));
    },
    terminate() {
      isEnded = true;
    },
  };
  return { worker, chunks, isEnded: () => isEnded };
}

/** Three chunks of one byte: 1, 2, 3; 9 in place of the second until it is asked for past all caches. */
function fileOf(isSpoilt = false): ShadowFile {
  const source = {
    name: "light.fov",
    size: 100,
    read: async (start: number, _end: number, _signal: undefined, isFresh: boolean) =>
      Uint8Array.of(isSpoilt && start === 20 && !isFresh ? 9 : start / 10),
  };
  const container = {
    starts: Float64Array.of(10, 20, 30, 34),
    lengths: Uint32Array.of(1, 1, 1),
    checksums: new Uint32Array(3),
  };
  return { file: { source, container } as unknown as OpenFile } as ShadowFile;
}

function run(file: ShadowFile, worker: ShadowWorker): Promise<{ load: ShadowLoad; told: string[] }> {
  return new Promise((resolve) => {
    const told: string[] = [];
    const events: ShadowEvents = {
      onStage: () => told.push("stage"),
      onProblem: ({ message }) => told.push(message),
      onEnd: () => resolve({ load, told }),
    };
    const load = new ShadowLoad(file, events, () => worker);
    load.start();
    expect(load.isSettled).toBe(false);
  });
}

describe("a shadow map on its way", () => {
  it("comes chunk by chunk, and each map as soon as it is whole", async () => {
    const { worker, chunks, isEnded } = workerOf([{ stage: null }, { stage: STAGE }, { stage: STAGE }]);
    const { load, told } = await run(fileOf(), worker);
    expect(chunks).toEqual(["1", "2", "3."]);
    expect(told).toEqual(["stage", "stage"]);
    expect([load.isSettled, load.hasFailed, isEnded()]).toEqual([true, false, true]);
  });

  it("fetches a chunk of a wrong checksum once more past all caches", async () => {
    const wrong = { error: "A checksum does not agree.", isChecksum: true };
    const { worker, chunks } = workerOf([{ stage: null }, wrong, { stage: STAGE }, { stage: STAGE }]);
    const { told } = await run(fileOf(true), worker);
    expect(chunks).toEqual(["1", "9", "2", "3."]);
    expect(told).toEqual(["stage", "stage"]);
  });

  it("tells what is damaged, keeps what came before, and can begin again", async () => {
    const bad = { error: "It does not hold together.", isChecksum: false };
    const { worker, isEnded } = workerOf([{ stage: STAGE }, bad, { stage: null }]);
    const { load, told } = await run(fileOf(), worker);
    expect(told).toEqual(["stage", expect.stringMatching(/^The shadows in light\.fov .* hold together\.$/)]);
    expect([load.hasFailed, isEnded()]).toEqual([true, true]);
  });
});

describe("words for the graphics", () => {
  it("lie tree after tree in whole rows, roots and scales beside", () => {
    const tree = (count: number, root: number, scale: number) => ({
      words: new Uint32Array(count).fill(count),
      scales: [1, scale],
      levels: 2,
      children: 4,
      root,
    });
    const stage = stageOf([tree(1, LEAF, 1), tree(5000, INNER, 7), tree(3, INNER, 1)]);
    expect(stage.widthBits).toBe(7);
    expect(stage.words.length % 128).toBe(0);
    expect([0, 1, 5000, 5001, 5004].map((i) => stage.words[i])).toEqual([1, 5000, 5000, 3, 0]);
    expect([...stage.roots.subarray(0, 6)]).toEqual([0, LEAF, 1, INNER, 5001, INNER]);
    expect(stage.scales[MOST_LEVELS + 1]).toBe(7);
  });
});
