/** The page: scene and tools put together. */
import type { Problem } from "../format/problem";
import { defaultBudgets, deviceHints } from "../scene/device";
import { UP } from "../scene/frame";
import { Stage } from "../scene/stage";
import type { Asset } from "../stream/asset";
import type { DecoderPool } from "../stream/pool";
import { Streamer } from "../stream/streamer";
import type { Stats } from "./api";
import { makeHelp } from "./dialogs";
import { byId, make } from "./dom";
import { watchPointer } from "./gestures";
import { isField, pressKey } from "./keys";
import { announce, note, showWarning } from "./notices";
import { settingsOf } from "./ownSettings";
import type { SceneFile } from "./sceneFile";
import { makeSettings } from "./settings";
import { copyLink, savePicture } from "./sharing";
import { formatState, INITIAL, parseState, type State } from "./state";
import { StatusLine } from "./statusLine";
import { applyTheme, backgroundOf, onDeviceTheme, resolveTheme } from "./theme";
import { type Tool, Toolbar } from "./toolbar";
import { makeTools } from "./tools";
import { directionWords, WORDS } from "./words";

const ADDRESS_PAUSE_MS = 400;
const stillQuery = matchMedia("(prefers-reduced-motion: reduce)");

export class App {
  readonly stage: Stage;
  readonly #streamer: Streamer;
  readonly #status: StatusLine;
  readonly #toolbar: Toolbar;
  readonly #tools: readonly Tool[];
  readonly #help = makeHelp();
  #settings: HTMLDialogElement | undefined;
  #state: State = INITIAL;
  #addressTimer = 0;
  #spokenTimer = 0;
  #lostStrip: HTMLElement | undefined;
  #frames = 0;
  #firstPicture: (() => void) | undefined;
  #noPicture: ((problem: Problem) => void) | undefined;
  /** Settles with the first picture; fails if there can be none. */
  readonly firstPicture = new Promise<void>((resolve, reject) => {
    this.#firstPicture = resolve;
    this.#noPicture = reject;
  });

  /** @throws Problem if the browser has no WebGL2. */
  constructor(
    private readonly scene: SceneFile,
    pool: DecoderPool,
  ) {
    const budgets = defaultBudgets(deviceHints());
    this.stage = new Stage(byId("picture"), {
      errorPx: budgets.errorPx,
      triangleBudget: budgets.triangles,
      isStill: stillQuery.matches,
      onFrame: () => this.#onFrame(),
      onLost: () => this.#onLost(),
      onRestored: () => this.#onRestored(),
    });
    this.#streamer = new Streamer({
      pool,
      budgetBytes: budgets.bytes,
      onChange: () => this.stage.invalidate(),
      onProblem: (problem, { node }) => this.#onProblem(problem, node),
    });
    this.#status = new StatusLine(() => this.change({ isStatusOn: false }));
    this.#tools = makeTools(this);
    this.#toolbar = new Toolbar(byId("tools"), this.#tools);
    document.title = scene.title;
    byId("title").textContent = scene.title;
    byId("picture").setAttribute("aria-label", WORDS.canvas(scene.title));
    byId("instructions").textContent = WORDS.instructions;
    this.#applyState();
    this.#listen();
  }

  get state(): State {
    return { ...this.#state, camera: this.stage.navigation.getCamera() };
  }

  get help(): HTMLDialogElement {
    return this.#help;
  }

  /** Show the scene's assets; settles when all are opened. */
  async open(opening: Promise<readonly Asset[]>): Promise<void> {
    const assets = await opening;
    const { layers } = this.scene;
    const parts = assets.map((asset, i) => ({
      asset,
      name: layers[i]!.name,
      isVisible: layers[i]!.isVisible,
    }));
    this.stage.open(this.#streamer, parts);
    this.stage.navigation.setUp(UP[assets[0]!.info.up]);
    this.stage.navigation.home(false);
    this.#readAddress();
    const triangles = assets.reduce((sum, { info }) => sum + info.triangles, 0);
    byId("subtitle").textContent = triangles ? `${triangles.toLocaleString("en")} ${WORDS.triangles}` : "";
    this.#makeViews();
    this.#toolbar.update();
    if (assets.some(({ source }) => source.whole)) note(WORDS.wholeFile);
    this.stage.invalidate();
  }

  /** Change part of the state and show it. */
  change(change: Partial<State>): void {
    this.#state = { ...this.#state, ...change };
    this.#applyState();
    this.#rememberSoon();
  }

  home(): void {
    this.stage.navigation.home(true);
    this.stage.invalidate();
    announce(WORDS.home);
  }

  /** y, z, x and round again. */
  turnUp(): void {
    const next = { y: "z", z: "x", x: "y" } as const;
    const axis = next[this.upName()];
    this.stage.navigation.setUp(UP[axis]);
    this.stage.navigation.home(false);
    this.stage.invalidate();
    this.#toolbar.update();
    announce(WORDS.upAxis(axis.toUpperCase()));
  }

  /** The axis nearest to up. */
  upName(): "x" | "y" | "z" {
    const up = this.stage.navigation.camera.up.toArray().map(Math.abs);
    return (["x", "y", "z"] as const)[up.indexOf(Math.max(...up))] ?? "y";
  }

  async savePicture(): Promise<void> {
    await savePicture(await this.stage.screenshot(), this.scene.title);
    note(WORDS.pictureSaved);
  }

  async copyLink(): Promise<void> {
    this.#remember();
    await copyLink(location.href);
  }

  async toggleFullscreen(): Promise<void> {
    if (document.fullscreenElement) await document.exitFullscreen();
    else await document.documentElement.requestFullscreen?.();
  }

  toggleTheme(): void {
    const theme = resolveTheme(this.#state.theme) === "dark" ? "light" : "dark";
    this.change({ theme });
    announce(WORDS.themeIs(theme));
  }

  openSettings(): void {
    this.#settings ??= makeSettings(settingsOf(this));
    this.#settings.showModal();
  }

  setErrorPx(errorPx: number): void {
    this.change({ errorPx });
  }

  setBudgets({ triangles, bytes }: { triangles?: number; bytes?: number }): void {
    if (triangles !== undefined) this.stage.triangleBudget = triangles;
    if (bytes !== undefined) this.#streamer.budgetBytes = bytes;
    this.stage.invalidate();
  }

  stats(): Stats {
    const { stage } = this;
    const { memory, programs } = stage.renderer.info;
    return {
      triangles: stage.drawnTriangles,
      patches: stage.drawnPatches,
      receivedBytes: this.#streamer.receivedBytes,
      allBytes: stage.layers.reduce((sum, layer) => sum + layer.fileBytes, 0),
      cacheBytes: this.#streamer.cachedBytes,
      cacheNodes: this.#streamer.cachedNodes,
      memoryBudgetBytes: this.#streamer.budgetBytes,
      triangleBudget: stage.triangleBudget,
      errorPx: stage.errorPx,
      targetPx: stage.targetPx,
      motionTriangles: stage.motion.triangles,
      inFlight: this.#streamer.inFlight,
      frameTimes: [...stage.frameTimes],
      frames: this.#frames,
      gpu: { geometries: memory.geometries, textures: memory.textures, programs: programs?.length ?? 0 },
      moments: stage.moments,
      isWholeFile: stage.layers.some((layer) => layer.asset.source.whole !== null),
    };
  }

  #applyState(): void {
    const { stage } = this;
    const state = this.#state;
    stage.areColoursOn = state.areColoursOn;
    stage.arePatchesTinted = state.arePatchesTinted;
    stage.isWireframe = state.isWireframe;
    stage.areSpheresOn = state.areSpheresOn;
    stage.targetPx = state.errorPx ?? defaultBudgets(deviceHints()).errorPx;
    stage.layers.forEach((layer, i) => {
      layer.group.visible = this.scene.layers[i]!.isVisible !== state.toggledLayers.includes(i);
    });
    applyTheme(state.theme);
    stage.background = backgroundOf(state.background, state.theme, this.scene.background);
    this.#status.isShown = state.isStatusOn;
    this.#toolbar.update();
    stage.invalidate();
  }

  #listen(): void {
    onDeviceTheme(() => this.#applyState());
    stillQuery.addEventListener("change", () => {
      this.stage.isStill = stillQuery.matches;
    });
    addEventListener("hashchange", () => this.#readAddress());
    addEventListener("online", () => this.#streamer.retry());
    document.addEventListener("fullscreenchange", () => this.#toolbar.update());
    document.addEventListener("keydown", (event) => this.#onKey(event));
    watchPointer(this.stage, (x, y) => this.#setPivot(x, y));
  }

  #onKey(event: KeyboardEvent): void {
    if (isField(event.target) || document.querySelector("dialog[open]")) return;
    const { navigation } = this.stage;
    const isDone = pressKey(event, {
      orbit: (right, up) => navigation.orbit(right, up),
      pan: (right, up) => navigation.pan(right, up),
      zoom: (factor) => navigation.zoom(factor),
      view: (number) => {
        const button = byId("views").querySelectorAll("button")[number - 1];
        button?.click();
        return button !== undefined;
      },
      tool: (letter) => {
        const tool = this.#tools.find(({ key }) => key === letter);
        if (!tool?.isDisabled?.()) tool?.run();
        return tool !== undefined;
      },
    });
    if (isDone) {
      event.preventDefault();
      this.#sayDirectionSoon();
    } else if (event.code === "Enter" && event.target === this.stage.canvas) {
      const box = this.stage.canvas.getBoundingClientRect();
      this.#setPivot(box.left + box.width / 2, box.top + box.height / 2);
    }
  }

  #setPivot(clientX: number, clientY: number): void {
    const point = this.stage.pick(clientX, clientY);
    if (point) this.stage.navigation.focus(point);
    announce(point ? WORDS.pivot : WORDS.nothingThere);
    this.stage.invalidate();
  }

  #onFrame(): void {
    this.#frames++;
    const { stage } = this;
    if (stage.moments.firstPicture !== undefined) this.#firstPicture?.();
    const recent = stage.frameTimes.slice(-20);
    const mean = recent.reduce((sum, time) => sum + time, 0) / (recent.length || 1);
    this.#status.update({
      triangles: stage.drawnTriangles,
      receivedBytes: this.#streamer.receivedBytes,
      allBytes: stage.layers.reduce((sum, layer) => sum + layer.fileBytes, 0),
      errorPx: stage.errorPx,
      framesPerSecond: stage.isIdle || !recent.length ? null : 1000 / mean,
    });
    const progress = byId("progress");
    if (stage.layers.length) progress.hidden = stage.isIdle;
    if (stage.isIdle) this.#rememberSoon();
  }

  /** Without its first node an asset cannot be shown at all; without any other it is only coarser. */
  #onProblem(problem: Problem, node: number): void {
    const isFatal = node === 0 && this.stage.moments.firstPicture === undefined;
    if (isFatal) this.#noPicture?.(problem);
    else showWarning(problem.message, () => this.#streamer.retry());
  }

  #onLost(): void {
    this.#lostStrip = showWarning(WORDS.lost);
  }

  #onRestored(): void {
    this.#lostStrip?.remove();
    note(WORDS.restored);
  }

  #makeViews(): void {
    const nav = byId("views");
    nav.hidden = this.scene.views.length === 0;
    for (const view of this.scene.views) {
      const button = make("button", { type: "button" }, view.name);
      button.addEventListener("click", () => {
        this.stage.setCamera(view.camera, true);
        announce(view.name);
      });
      nav.append(button);
    }
  }

  toggleLayer(index: number): void {
    const { toggledLayers } = this.#state;
    const isToggled = toggledLayers.includes(index);
    this.change({
      toggledLayers: isToggled
        ? toggledLayers.filter((i) => i !== index)
        : [...toggledLayers, index].sort((a, b) => a - b),
    });
  }

  /** After a key turned the view: from where it is seen now, once it rests. */
  #sayDirectionSoon(): void {
    clearTimeout(this.#spokenTimer);
    this.#spokenTimer = window.setTimeout(() => {
      const words = this.stage.navigation.direction();
      announce(directionWords(...words));
    }, 700);
  }

  #readAddress(): void {
    if (location.hash.length < 2) return;
    const state = parseState(location.hash);
    if (!state) {
      note(WORDS.foreignLink);
      return;
    }
    this.#state = state;
    if (state.camera) this.stage.setCamera(state.camera);
    this.#applyState();
  }

  #rememberSoon(): void {
    clearTimeout(this.#addressTimer);
    this.#addressTimer = window.setTimeout(() => this.#remember(), ADDRESS_PAUSE_MS);
  }

  #remember(): void {
    if (!this.stage.layers.length) return;
    const hash = `#${formatState(this.state)}`;
    if (hash !== location.hash) history.replaceState(history.state, "", hash);
  }
}
