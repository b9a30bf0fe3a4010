/** The row of views that the scene names. */
import type { CameraState } from "../scene/navigation";
import { byId, make } from "./dom";
import { announce } from "./notices";
import type { NamedView } from "./sceneFile";

/** Make their buttons; `go` is called with the camera of the one that is pressed. */
export function showViews(views: readonly NamedView[], go: (camera: CameraState) => void): void {
  const nav = byId("views");
  nav.hidden = views.length === 0;
  for (const view of views) {
    const button = make("button", { type: "button" }, view.name);
    button.addEventListener("click", () => {
      go(view.camera);
      announce(view.name);
    });
    nav.append(button);
  }
}

/** Press the view of this number, from 1; whether there is one. */
export function pressView(number: number): boolean {
  const button = byId("views").querySelectorAll("button")[number - 1];
  button?.click();
  return button !== undefined;
}
