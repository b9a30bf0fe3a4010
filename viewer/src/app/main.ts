/** Start: fetch the scene, show it, and say so when that cannot be done. */
import { CAGE } from "../format/cage";
import { sentenceOf } from "../format/problem";
import type { Cage } from "../refine/cage";
import { type Asset, assetOf } from "../stream/asset";
import { openFile } from "../stream/file";
import { DecoderPool } from "../stream/pool";
import type { FovealApi } from "./api";
import { App } from "./app";
import { byId } from "./dom";
import { announce, showFailure } from "./notices";
import { fetchScene, type SceneFile, type SceneLayer } from "./sceneFile";
import { applyTheme } from "./theme";
import { WORDS } from "./words";

let app: App | undefined;

async function start(): Promise<void> {
  applyTheme("auto");
  const progress = byId("progress");
  progress.hidden = false;
  try {
    const scene = await fetchScene(new URL("scene.json", document.baseURI).href);
    // Files and workers come while the graphics start, which takes the longest (software: 0.4 s).
    const assets = openAll(scene, (share) => {
      progress.style.setProperty("--share", String(share));
      progress.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    });
    assets.catch(() => {}); // told below, unless the graphics fail before
    app = new App(scene, startDecoders());
    await app.open(assets);
    await app.firstPicture;
    document.documentElement.dataset.phase = "shown";
    announce(WORDS.loaded(scene.title));
  } catch (error) {
    progress.hidden = true;
    document.documentElement.dataset.phase = "failed";
    showFailure(error);
    throw new Error(sentenceOf(error), { cause: error });
  }
}

/** Begin to fetch all layers of the scene; `onProgress` hears the share of all that is there, 0 to 1. */
function openAll({ layers }: SceneFile, onProgress: (share: number) => void): Promise<(Asset | Cage)[]> {
  const shares = layers.map(() => 0);
  const open = (layer: SceneLayer, i: number): Promise<Asset | Cage> =>
    openLayer(layer, (share) => {
      shares[i] = share;
      onProgress(shares.reduce((sum, s) => sum + s, 0) / shares.length);
    });
  return Promise.all(layers.map(open));
}

async function openLayer(
  { url, live, rest }: SceneLayer,
  onProgress: (share: number) => void,
): Promise<Asset | Cage> {
  const file = await openFile(url, { onProgress });
  if (file.container.header.kind !== CAGE) return assetOf(file);
  const { openCage } = await import("./refinement");
  return openCage(file, live, rest);
}

function startDecoders(): DecoderPool {
  const start = (): Worker => new Worker(new URL("../stream/worker.ts", import.meta.url), { type: "module" });
  return new DecoderPool(start, DecoderPool.sizeFor(navigator.hardwareConcurrency));
}

const ready = start();
ready.catch(() => {}); // said on the page; who embeds it learns from `ready`

function shown(): App {
  if (!app) throw new Error("The viewer has nothing to show yet; wait for foveal.ready.");
  return app;
}

const api: FovealApi = {
  ready,
  idle: async () => {
    await ready;
    await shown().stage.idle();
  },
  stats: () => shown().stats(),
  getState: () => shown().state,
  setCamera: (camera, isSmooth) => shown().stage.setCamera(camera, isSmooth),
  setErrorPx: (errorPx) => shown().setErrorPx(errorPx),
  setBudgets: (budgets) => shown().setBudgets(budgets),
};
window.foveal = api;
