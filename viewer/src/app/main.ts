/** Start: fetch the scene, show it, and say so when that cannot be done. */
import { sentenceOf } from "../format/problem";
import type { FovealApi } from "./api";
import { App } from "./app";
import { byId } from "./dom";
import { announce, showFailure } from "./notices";
import { fetchScene } from "./sceneFile";
import { applyTheme } from "./theme";
import { WORDS } from "./words";

let app: App | undefined;

async function start(): Promise<void> {
  applyTheme("auto");
  const progress = byId("progress");
  progress.hidden = false;
  try {
    const scene = await fetchScene(new URL("scene.json", document.baseURI).href);
    app = new App(scene);
    await app.open((share) => {
      progress.style.setProperty("--share", String(share));
      progress.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    });
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
