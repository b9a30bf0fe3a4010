/**
 * What is refined where it is looked at: its layers, its panel and its picture from elsewhere.
 *
 * Loaded when a scene has such a layer, so that others need not wait for it.
 */
import type { Refinement as Wants } from "../format/cage";
import type { Problem } from "../format/problem";
import type { Cage } from "../refine/cage";
import { deviceHints, refinedTriangles } from "../scene/device";
import { AIM_MS } from "../scene/motionBudget";
import { RefinedLayer } from "../scene/refinedLayer";
import type { Part } from "../scene/stage";
import { type Turn, turned } from "../scene/turn";
import type { App } from "./app";
import { addKeys } from "./dialogs";
import { InsetFrame } from "./insetFrame";
import { note, showWarning } from "./notices";
import { type DeviceChoice, NO_CHOICE, type RefinementChoice, refinementWith } from "./refinementChoice";
import { makeRefinementPanel } from "./refinementPanel";
import type { Sheet } from "./sheet";
import { INITIAL } from "./state";
import { REFINEMENT_KEYS, WORDS } from "./words";

/** A frame may take so much more than wanted: one that comes at the screen's own pace is in time. */
const RATE_MARGIN = 1.1;

export { openCage } from "../refine/cage";

export class RefinementControl {
  readonly #layers: RefinedLayer[] = [];
  readonly #cages: Cage[] = [];
  readonly #inset: InsetFrame;
  #device: DeviceChoice = { budget: null, rate: null };
  #panel: Sheet | undefined;
  #strip: HTMLElement | undefined;

  constructor(private readonly app: App) {
    addKeys(app.help, REFINEMENT_KEYS);
    this.#inset = new InsetFrame({
      onPlace: () => this.apply(),
      onTurn: (right, up) => this.turn(right, up),
      onClose: () => this.toggleInset(),
    });
  }

  /** The part of the picture that this control mesh is. */
  partOf(cage: Cage, name: string, isVisible: boolean): Part {
    const { file, info, refinement, source } = cage;
    const { stage } = this.app;
    this.#cages.push(cage);
    return {
      name,
      isVisible,
      box: info.box,
      makeLayer: (frame) => {
        const fileBytes = file.container.size;
        const asset = { name, origin: info.origin, box: info.box, fileBytes, source, refinement };
        const layer = new RefinedLayer(asset, frame, {
          onChange: () => stage.invalidate(),
          onProblem: (problem) => this.#onProblem(problem),
          drawnMs: () => stage.clock.spent,
        });
        this.#layers.push(layer);
        return layer;
      },
    };
  }

  get layers(): readonly RefinedLayer[] {
    return this.#layers;
  }

  get cages(): readonly Cage[] {
    return this.#cages;
  }

  /** What is wanted of the first layer now; the panel shows it for all. */
  get wants(): Wants {
    return this.#wantsOf(this.#cages[0]!.refinement);
  }

  get isInsetOn(): boolean {
    return this.app.state.isInsetOn ?? !deviceHints().isCoarse;
  }

  /** Do what the state says. */
  apply(): void {
    const { stage, state } = this.app;
    this.#layers.forEach((layer, i) => {
      layer.wants = this.#wantsOf(this.#cages[i]!.refinement);
    });
    const rate = Math.max(0, ...this.#layers.map((layer) => layer.wants.rate));
    stage.motion.aimMs = rate > 0 ? (1000 * RATE_MARGIN) / rate : AIM_MS;
    this.#inset.isShown = this.isInsetOn;
    stage.setInset(this.isInsetOn ? this.#inset.place : null, state.insetTurn);
  }

  choose(change: Partial<RefinementChoice>): void {
    this.app.change({ refinement: { ...this.app.state.refinement, ...change } });
  }

  chooseForDevice(change: Partial<DeviceChoice>): void {
    this.#device = { ...this.#device, ...change };
    this.apply();
  }

  reset(): void {
    this.#device = { budget: null, rate: null };
    const { faceColours, isInsetOn, insetTurn } = INITIAL;
    this.app.change({ refinement: NO_CHOICE, faceColours, isInsetOn, insetTurn });
  }

  openPanel(): void {
    this.#panel ??= makeRefinementPanel(this.app, this);
    this.#panel.open();
  }

  toggleInset(): void {
    this.app.change({ isInsetOn: !this.isInsetOn });
  }

  turn(right: number, up: number): void {
    const insetTurn: Turn = turned(this.app.state.insetTurn, right, up);
    this.app.change({ insetTurn });
  }

  retry(): void {
    for (const layer of this.#layers) layer.retry();
  }

  #wantsOf(own: Wants): Wants {
    const budget = own.budget || refinedTriangles(deviceHints());
    return refinementWith({ ...own, budget }, this.app.state.refinement, this.#device);
  }

  #onProblem(problem: Problem | null): void {
    if (problem && this.app.stage.moments.firstPicture === undefined) {
      this.app.fail(problem);
    } else if (problem) {
      this.#strip = showWarning(problem.message, () => this.retry());
    } else {
      this.#strip?.remove();
      note(WORDS.answersAgain);
    }
  }
}
