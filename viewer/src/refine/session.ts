/**
 * A refinement that follows the camera of this page: says what changed, as a server's live session does.
 *
 * - It knows requests and messages (spec/wire.md), not how they travel. A request is answered by one message at
 *   most, so the newest camera is the one that counts; a page that draws slowly asks less often.
 * - Work is done in slices: what is not done when time is out is shown as far as it is, and goes on with the next
 *   request. It ends in the same mesh.
 * - Budget and rate act by the threshold alone (`pace.ts`).
 *
 * The same as `src/foveal/refine/session.py`.
 *
 * @module refine/session
 */
import { REGIONS } from "../format/cage";
import type { Triple } from "../format/graph";
import type { Wish } from "../stream/refinement";
import { coarser, factor, Pace } from "./pace";
import { NO_SLOTS, type SlotWords, slotMessage, slotWords } from "./slotMessage";
import { Sqrt3 } from "./sqrt3";
import type { ControlMesh } from "./surface";
import { limitsOf, viewOf } from "./view";

/** All that a page wants, as on the wire. */
export interface Request extends Wish {
  /** Milliseconds that the page took for its last picture. */
  readonly drawn_ms: number;
  /** Of the last message that was applied, 0 if none was or all is to be sent anew. */
  readonly seen: number;
}

/** The page's own limit: 200 MB of refinement, and what a phone still draws. */
const MOST_TRIANGLES = 1_000_000;

/** How long is refined before what there is is shown; after a leap longer, since little of it is of use. */
const SLICE_MS = 40;
const LEAP_MS = 200;

/** Between two looks at the clock and at the budget: 2 ms on a desktop, and some 10 on a phone. */
const SPLITS = 2000;
const FEWEST = 32;

/** Of the distance to the target: a camera that moved further is somewhere else. */
const LEAP = 0.25;

export class RefinementSession {
  readonly #refined: Sqrt3;
  readonly #pace: Pace;
  readonly #least: number;
  /** What the refinement stands at. */
  #last: Request | null = null;
  #wanted = "";
  #view: Float64Array = new Float64Array(24);
  /** The last update had nothing left to split. */
  #isWhole = true;
  #triangles = 0;
  /** Triangles of all updates for one message. */
  #work = 0;
  #sent: SlotWords = NO_SLOTS;
  #sequence = 0;

  /**
   * @param origin - What positions are told relative to.
   * @param clock - Milliseconds; for tests.
   * @throws Problem if the mesh is no oriented surface.
   */
  constructor(
    mesh: ControlMesh,
    private readonly origin: Triple,
    name: string,
    private readonly clock: () => number = () => performance.now(),
  ) {
    this.#refined = new Sqrt3(mesh, name);
    this.#least = mesh.faces.length / 3;
    this.#pace = new Pace(this.#least, MOST_TRIANGLES);
  }

  /** The next message, or null if there is none before another request. */
  answer(request: Request): ArrayBuffer | null {
    const isAnew = request.seen !== this.#sequence || this.#sequence === 0;
    const wanted = JSON.stringify({ ...request, drawn_ms: 0, seen: 0 });
    const isNew = wanted !== this.#wanted;
    const isDone = !isNew && this.#isSettled;
    if (isDone && !isAnew) return null;
    const begin = this.clock();
    this.#work = 0;
    this.#wanted = wanted;
    if (!isDone) this.#refine(request, begin, isNew);
    const milliseconds = this.clock() - begin;
    const message = this.#message(request, milliseconds, isAnew);
    if (isNew && this.#sequence > 1) {
      const spent = (this.clock() - begin) / Math.max(1, this.#work);
      this.#pace.spent(spent + request.drawn_ms / Math.max(1, this.#triangles));
    }
    return message;
  }

  get #isSettled(): boolean {
    return this.#isWhole && this.#pace.isSettled;
  }

  /** Bring the mesh to what is wanted, as near as the budget and a slice of time let it come. */
  #refine(request: Request, begin: number, isNew: boolean): void {
    const pace = this.#pace;
    const { criteria, budget, rate } = request;
    const isLeap = isNew && this.#isRisky(request) && isElsewhere(this.#last, request);
    if (isNew) {
      pace.begin(criteria, { budget, rate, isLeap });
      this.#last = request;
      this.#view = viewOf(request.camera);
    } else if (this.#isWhole) {
      pace.finer();
    }
    const slice = isLeap && this.#sequence > 0 ? LEAP_MS : SLICE_MS;
    for (;;) {
      const done = this.#update(request);
      const isLate = this.clock() - begin > slice;
      if (!this.#isWhole && done <= pace.budget) {
        if (isLate) return;
        continue;
      }
      pace.tell(done);
      if (!pace.isFit) continue;
      // In motion the step is as the last frame was; whether a finer one fits is tried at rest.
      const isEnough = isNew && !(isLeap && pace.isAmple);
      if (isLate || pace.isSettled || isEnough) return;
      pace.finer(isNew);
    }
  }

  /** Refine on by some splits, hardly beyond the budget; returns the triangles that there are then. */
  #update({ criteria }: Request): number {
    const { step, budget } = this.#pace;
    const splits = Math.min(SPLITS, Math.max(FEWEST, (budget - this.#triangles) >> 1));
    const { faces, isDone } = this.#refined.update(this.#view, limitsOf(coarser(criteria, step)), splits);
    this.#triangles = faces;
    this.#isWhole = isDone;
    this.#work += faces;
    return faces;
  }

  /** Whether a step for another view could give far more than the budget, and take as long. */
  #isRisky({ criteria, budget }: Request): boolean {
    const most = Math.max(...REGIONS.map((name) => criteria[name].iterations));
    // an iteration is at most four triangles for one
    return this.#least * 4 ** most > 4 * Math.min(budget || MOST_TRIANGLES, MOST_TRIANGLES);
  }

  #message({ positions }: Request, milliseconds: number, isAnew: boolean): ArrayBuffer {
    const isLimit = positions === "limit";
    const now = slotWords(this.#refined, isLimit, this.origin);
    const head = {
      sequence: this.#sequence + 1,
      base: isAnew ? 0 : this.#sequence,
      isSettled: this.#isSettled,
      isLimit,
      triangles: this.#triangles,
      milliseconds,
      threshold: factor(this.#pace.step),
    };
    const message = slotMessage(head, now, isAnew ? NO_SLOTS : this.#sent);
    this.#sent = now;
    this.#sequence = head.sequence;
    return message;
  }
}

/** Whether what the last view had refined says little of what this one will. */
function isElsewhere(last: Request | null, { camera, criteria }: Request): boolean {
  if (last === null || JSON.stringify(criteria) !== JSON.stringify(last.criteria)) return true;
  const away = distance(camera.position, camera.target);
  const before = last.camera;
  return distance(camera.position, before.position) + distance(camera.target, before.target) > LEAP * away;
}

function distance(a: Triple, b: Triple): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
