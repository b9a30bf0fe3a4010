/** Sessions of the page: what comes out, applied as a server's messages are, is the refinement that was wished for. */
import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import text from "../../../spec/golden/sqrt3.json?raw";
import { type Criteria, parseCage } from "../format/cage";
import { parseContainer } from "../format/container";
import { Problem } from "../format/problem";
import { parseMessage, SlotBuffers, type WireMessage } from "../format/wire";
import type { OpenFile } from "../stream/file";
import type { WireCamera } from "../stream/refinement";
import { controlMeshOf, readControlMesh } from "./controlMesh";
import type { Request } from "./dialogue";
import { RefinementSession } from "./session";
import { slotWords } from "./slotMessage";
import { Sqrt3 } from "./sqrt3";
import { type ControlMesh, surfaceOf } from "./surface";
import { limitsOf, viewOf } from "./view";

const golden = JSON.parse(text);
const ORIGIN = [0.25, -0.5, 0] as const;
const CAMERAS: WireCamera[] = golden.walks[3].steps.map((step: { camera: WireCamera }) => step.camera);
const FINE: Criteria = golden.criteria.fine;

function meshOf(name: string): ControlMesh {
  const { positions, faces } = golden.cages[name];
  return { positions: Float64Array.from(positions), faces: Int32Array.from(faces) };
}

/** A page in few words: it applies what comes, and acknowledges it. */
class Page {
  readonly slots = new SlotBuffers();
  /** Each look at the clock is so much later; 0 for one that stands still. */
  tick = 0;
  #now = 0;
  readonly session = new RefinementSession(meshOf("bumpy"), ORIGIN, "bumpy.fov", () => {
    this.#now += this.tick;
    return this.#now;
  });

  /** One request; what it brought. */
  ask(wish: Partial<Request>): WireMessage | null {
    const request: Request = {
      camera: CAMERAS[0]!,
      criteria: FINE,
      budget: 0,
      positions: "control",
      rate: 0,
      drawn_ms: 5,
      seen: this.slots.sequence,
      ...wish,
    };
    const answer = this.session.answer(request);
    if (!answer) return null;
    const message = parseMessage(answer);
    this.slots.apply(message);
    return message;
  }

  /** Until it is settled; all messages. */
  rest(wish: Partial<Request>): WireMessage[] {
    const messages: WireMessage[] = [];
    for (let message = this.ask(wish); message; message = this.ask(wish)) {
      messages.push(message);
      if (messages.length > 500) throw new Error("It does not come to rest.");
    }
    expect(messages.at(-1)!.isSettled).toBe(true);
    return messages;
  }

  /** Triangles with their corners' places, sorted. */
  get triangles(): string[] {
    return trianglesOf(this.slots.faces.subarray(0, 3 * this.slots.faceCount), this.slots.positions);
  }
}

function trianglesOf(faces: Uint32Array, positions: Float32Array): string[] {
  const triangles: string[] = [];
  for (let i = 0; i < faces.length; i += 3) {
    if (faces[i] === faces[i + 1]) continue;
    const corners = [...faces.subarray(i, i + 3)].map((v) => `${positions.subarray(3 * v, 3 * v + 3)}`);
    const first = corners.indexOf(corners.toSorted()[0]!);
    triangles.push([0, 1, 2].map((k) => corners[(first + k) % 3]).join(" "));
  }
  return triangles.sort();
}

function fresh(camera: WireCamera, isLimit = false): string[] {
  const refined = new Sqrt3(meshOf("bumpy"));
  refined.update(viewOf(camera), limitsOf(FINE));
  const [faces, positions] = slotWords(refined, isLimit, ORIGIN);
  return trianglesOf(faces, new Float32Array(positions.buffer));
}

test("a walk shows at each rest what a fresh refinement shows", () => {
  const page = new Page();
  for (const camera of CAMERAS) {
    page.rest({ camera });
    expect(page.triangles).toEqual(fresh(camera));
  }
  page.rest({ camera: CAMERAS[0]!, positions: "limit" });
  expect(page.triangles).toEqual(fresh(CAMERAS[0]!, true));
});

test("who asks twice is answered once, and from nothing if all was lost", () => {
  const page = new Page();
  page.rest({});
  expect(page.ask({})).toBeNull();
  const before = page.triangles;
  expect(page.ask({ seen: 0 })!.base).toBe(0);
  expect(page.triangles).toEqual(before);
  expect(page.ask({})).toBeNull();
});

test("where time is out the mesh is shown as it is, and ends the same", () => {
  const page = new Page();
  page.tick = 1000;
  const messages = page.rest({ criteria: golden.criteria.everywhere });
  const counts = messages.map(({ triangles }) => triangles);
  expect(counts.length).toBeGreaterThan(2);
  expect(counts).toEqual(counts.toSorted((a, b) => a - b));
  expect(counts.at(-1)).toBe(80 * 3 ** 5);
  expect(messages.map(({ isSettled }) => isSettled).indexOf(true)).toBe(messages.length - 1);
});

test("a budget is kept at each rest, by the same threshold from wherever it comes", () => {
  const direct = new Page();
  const [last] = direct.rest({ camera: CAMERAS[4]!, budget: 2500 }).slice(-1);
  const page = new Page();
  page.tick = 3;
  for (const camera of CAMERAS) {
    const settled = page.rest({ camera, budget: 2500 }).at(-1)!;
    expect(settled.triangles).toBeLessThanOrEqual(2500);
    if (camera === CAMERAS[4]) {
      expect(settled.threshold).toBe(last!.threshold);
      expect(page.triangles).toEqual(direct.triangles);
    }
  }
  expect(last!.threshold).toBeGreaterThan(1);
});

test("a rate has fewer triangles than none", () => {
  const page = new Page();
  const free = page.rest({}).at(-1)!.triangles;
  page.tick = 50;
  for (const camera of CAMERAS) page.ask({ camera, rate: 60, drawn_ms: 40 });
  expect(page.rest({ rate: 60, drawn_ms: 40 }).at(-1)!.triangles).toBeLessThan(free);
});

describe("what is no surface is refused in a sentence", () => {
  const square = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1];
  const cases: [sentence: string, faces: number[]][] = [
    ["triangle 1 has the same vertex twice", [0, 1, 2, 3, 3, 0]],
    ["the edge between vertices 1 and 0 has more than two triangles", [0, 1, 2, 1, 0, 3, 1, 0, 4]],
    ["the two triangles at the edge between vertices 0 and 1 face opposite sides", [0, 1, 2, 0, 1, 3]],
    ["at vertex 0 several fans of triangles touch", [0, 1, 2, 0, 3, 4]],
  ];
  test.each(cases)("%s", (sentence, faces) => {
    const mesh = { positions: Float64Array.from(square), faces: Int32Array.from(faces) };
    expect(() => surfaceOf(mesh, "odd.fov")).toThrow(Problem);
    expect(() => surfaceOf(mesh, "odd.fov")).toThrow(
      `odd.fov holds no surface that can be refined: ${sentence}`,
    );
  });
});

test("the control mesh of the golden file is read as it was written, and a damaged one is not", async () => {
  const folder = new URL("../../../spec/golden/", import.meta.url);
  const written = JSON.parse(readFileSync(new URL("cage.json", folder), "utf8"));
  const bytes = new Uint8Array(readFileSync(new URL("cage.fov", folder)));
  const container = parseContainer(bytes, "cage.fov", bytes.length);
  const info = parseCage(container.header, "cage.fov");
  const fileOf = (head: Uint8Array) =>
    ({ source: { head, name: "cage.fov" }, container }) as unknown as OpenFile;
  const { positions, faces } = await readControlMesh(fileOf(bytes), info);
  expect([...positions]).toEqual(written.positions.flat());
  expect([...faces]).toEqual(written.faces.flat());
  const damaged = bytes.slice();
  damaged[bytes.length - 5]! ^= 1;
  await expect(readControlMesh(fileOf(damaged), info)).rejects.toThrow("cage.fov is damaged");
});

test("sharp edges of the golden file are read, and one that is no edge is refused", async () => {
  const folder = new URL("../../../spec/golden/", import.meta.url);
  const written = JSON.parse(readFileSync(new URL("cage_sharp.json", folder), "utf8"));
  const bytes = new Uint8Array(readFileSync(new URL("cage_sharp.fov", folder)));
  const container = parseContainer(bytes, "cage_sharp.fov", bytes.length);
  const info = parseCage(container.header, "cage_sharp.fov");
  const file = { source: { head: bytes, name: "cage_sharp.fov" }, container } as unknown as OpenFile;
  const mesh = await readControlMesh(file, info);
  expect([...mesh.sharp!]).toEqual(written.sharp.flat());
  const { twins, isCorner, positions } = surfaceOf(mesh, "cage_sharp.fov");
  // the tip, where both end, has a vertex on each side of them; so has nothing else, as they end at the border
  expect(positions.length / 3 - mesh.positions.length / 3).toBe(3);
  expect([twins.filter((v) => v >= 0).length, isCorner.filter((is) => is === 1).length]).toEqual([2, 4]);
  const odd = { ...mesh, sharp: Int32Array.of(3, 1) };
  expect(() => surfaceOf(odd, "odd.fov")).toThrow("the edge between vertices 1 and 3 is to be sharp");
});

test("a control mesh is read from its bytes, or not at all", () => {
  const { positions, faces } = meshOf("two_triangles");
  const chunk = new Uint8Array(positions.byteLength + faces.byteLength);
  chunk.set(new Uint8Array(positions.buffer));
  chunk.set(new Uint8Array(faces.buffer), positions.byteLength);
  const info = { vertices: 4, triangles: 2, sharpEdges: [2, 0] } as unknown as Parameters<
    typeof controlMeshOf
  >[1];
  expect(controlMeshOf(chunk, info)).toEqual({ positions, faces, sharp: Int32Array.of(2, 0) });
  for (let length = 0; length < chunk.length; length++) {
    expect(controlMeshOf(chunk.subarray(0, length), info)).toBeNull();
  }
  const far = chunk.slice();
  far[chunk.length - 4] = 4; // there is no vertex 4
  expect(controlMeshOf(far, info)).toBeNull();
  const odd = chunk.slice();
  odd.set([0, 0, 0, 0, 0, 0, 0xf0, 0x7f]); // infinity
  expect(controlMeshOf(odd, info)).toBeNull();
});
