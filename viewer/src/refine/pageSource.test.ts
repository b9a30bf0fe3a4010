/** The page as its own server: a worker at the other end of the protocol. */
import { expect, test, vi } from "vitest";
import text from "../../../spec/golden/sqrt3.json?raw";
import type { Problem } from "../format/problem";
import type { SlotChanges } from "../format/wire";
import type { Wish } from "../stream/refinement";
import type { Dialogue } from "./dialogue";
import { PageSource, type WorkerLike } from "./pageSource";
import { sessionOf } from "./sessions";
import type { StartMessage } from "./worker";

const golden = JSON.parse(text);
const { positions, faces } = golden.cages.torus;
const START: StartMessage = {
  cage: {
    scheme: "sqrt3",
    mesh: { positions: Float64Array.from(positions), faces: Int32Array.from(faces) },
  },
  origin: [0, 0, 0],
  name: "torus.fov",
};
const WISH: Wish = {
  camera: golden.walks[4].steps[0].camera,
  criteria: golden.criteria.usual,
  budget: 0,
  positions: "control",
  rate: 0,
};

/** Answers as the worker does, in the same thread and a task later. */
class FakeWorker implements WorkerLike {
  onmessage: ((event: MessageEvent) => void) | null = null;
  onerror: ((event: ErrorEvent) => void) | null = null;
  session: Dialogue | undefined;
  isTerminated = false;

  postMessage(message: StartMessage | string): void {
    if (typeof message !== "string") {
      this.session = sessionOf(message.cage, message.origin, message.name);
      return;
    }
    const data = this.session!.answer(JSON.parse(message));
    if (data) setTimeout(() => this.onmessage?.(new MessageEvent("message", { data })));
  }

  terminate(): void {
    this.isTerminated = true;
  }
}

async function settle(source: PageSource, wish: Wish): Promise<void> {
  await vi.waitFor(() => {
    source.request(wish, 4);
    expect(source.figures.updates > 0 && source.isSettled).toBe(true);
  });
}

test("a wish is granted, and only the file counts as received", async () => {
  const source = new PageSource(START, 1234, () => new FakeWorker());
  const heard: SlotChanges[] = [];
  source.listen({ onChange: (changes) => heard.push(changes), onProblem: () => {} });
  await settle(source, WISH);
  expect(source.figures.triangles).toBe(golden.walks[4].steps[0].faces);
  expect(source.slots.faceCount).toBeGreaterThanOrEqual(source.figures.triangles);
  expect(source.figures.receivedBytes).toBe(1234);
  expect(heard[0]!.isFresh).toBe(true);
  source.dispose();
});

test("a worker that fails says so, and is made anew when asked to", async () => {
  const workers: FakeWorker[] = [];
  const source = new PageSource(START, 1234, () => {
    workers.push(new FakeWorker());
    return workers.at(-1)!;
  });
  const problems: (Problem | null)[] = [];
  source.listen({ onChange: () => {}, onProblem: (problem) => problems.push(problem) });
  await settle(source, WISH);
  workers[0]!.onerror?.({ message: "out of memory" } as ErrorEvent);
  expect(problems.at(-1)!.message).toContain("The refinement stopped (out of memory)");
  expect(workers[0]!.isTerminated).toBe(true);
  source.retry();
  await settle(source, WISH);
  expect(workers.length).toBe(2);
  expect(problems.at(-1)).toBeNull();
  source.dispose();
  expect(workers[1]!.isTerminated).toBe(true);
});
