/**
 * A √3 refinement that follows the camera of this page: says what changed, as a server's live session does.
 *
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
import { Dialogue, MOST_TRIANGLES, type Request } from "./dialogue";
import { coarser, factor, Pace } from "./pace";
import { changedParts, type SlotParts, type SlotWords, slotWords } from "./slotMessage";
import { Sqrt3 } from "./sqrt3";
import type { ControlMesh } from "./surface";
import { limitsOf, viewOf } from "./view";

/** How long is refined before what there is is shown; after a leap longer, since little of it is of use. */
const SLICE_MS = 40;
const LEAP_MS = 200;

/** Between two looks at the clock and at the budget: 2 ms on a desktop, and some 10 on a phone. */
const SPLITS = 2000;
const FEWEST = 32;

/** Of the distance to the target: a camera that moved further is somewhere else. */
const LEAP = 0.25;

export class RefinementSession extends Dialogue {
  readonly #refined: Sqrt3;
  readonly #pace: Pace;
  readonly #least: number;
  #view: Float64Array = new Float64Array(24);
  /** The last update had nothing left to split. */
  #isWhole = true;
  /** Triangles of all updates for one message. */
  #work = 0;
  #sent: SlotWords | null = null;

  /**
   * @param origin - What positions are told relative to.
   * @param clock - Milliseconds; for tests.
   * @throws Problem if the mesh is no oriented surface.
   */
  constructor(
    mesh: ControlMesh,
    private readonly origin: Triple,
    name: string,
    clock: () => number = () => performance.now(),
  ) {
    super(clock);
    this.#refined = new Sqrt3(mesh, name);
    this.#least = mesh.faces.length / 3;
    this.#pace = new Pace(this.#least, MOST_TRIANGLES);
  }

  protected override get isSettled(): boolean {
    return this.#isWhole && this.#pace.isSettled;
  }

  protected override get threshold(): number {
    return factor(this.#pace.step);
  }

  protected override spent(request: Request, milliseconds: number): void {
    const spent = milliseconds / Math.max(1, this.#work);
    this.#pace.spent(spent + request.drawn_ms / Math.max(1, this.triangles));
  }

  /** Bring the mesh to what is wanted, as near as the budget and a slice of time let it come. */
  protected override refine(request: Request, begin: number, isNew: boolean): void {
    this.#work = 0;
    const pace = this.#pace;
    const { criteria, budget, rate } = request;
    const isLeap = isNew && this.#isRisky(request) && isElsewhere(this.last, request);
    if (isNew) {
      pace.begin(criteria, { budget, rate, isLeap });
      this.last = request;
      this.#view = viewOf(request.camera);
    } else if (this.#isWhole) {
      pace.finer();
    }
    const slice = isLeap && this.#sent ? LEAP_MS : SLICE_MS;
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
    const splits = Math.min(SPLITS, Math.max(FEWEST, (budget - this.triangles) >> 1));
    const { faces, isDone } = this.#refined.update(this.#view, limitsOf(coarser(criteria, step)), splits);
    this.triangles = faces;
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

  protected override parts({ positions }: Request, isAnew: boolean): SlotParts {
    const now = slotWords(this.#refined, positions === "limit", this.origin);
    const parts = changedParts(now, isAnew ? null : this.#sent);
    this.#sent = now;
    return parts;
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
