/** The light of a scene, if it has one: what is shown does not wait for it. */
import { sentenceOf } from "../format/problem";
import type { App } from "./app";
import { showWarning } from "./notices";
import type { SceneLightFile } from "./sceneFile";

export async function openLight(app: App, light: SceneLightFile | null): Promise<void> {
  app.stage.isLightComing = light !== null;
  if (!light) return;
  try {
    const { LightControl } = await import("./light");
    app.light = new LightControl(app, light);
  } catch (error) {
    app.stage.isLightComing = false;
    showWarning(sentenceOf(error), () => void openLight(app, light));
  }
  app.change({}); // its tool, and what the state says of it
}
