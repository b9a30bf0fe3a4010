/** Keys pressed on the page: what they do, and what is said to those who do not see it. */
import type { App } from "./app";
import { isField, type KeyActions, pressKey } from "./keys";
import { pressView } from "./namedViews";
import { announce } from "./notices";
import type { Tool } from "./toolbar";
import { directionWords } from "./words";

const SPEAK_PAUSE_MS = 700;

export function watchKeys(app: App, tools: readonly Tool[]): void {
  const { navigation, canvas } = app.stage;
  const actions: KeyActions = {
    orbit: (right, up) => navigation.orbit(right, up),
    pan: (right, up) => navigation.pan(right, up),
    zoom: (factor) => navigation.zoom(factor),
    view: pressView,
    tool: (letter) => {
      const tool = tools.find(({ key, isAbsent }) => key === letter && !isAbsent?.());
      if (!tool?.isDisabled?.()) tool?.run();
      return tool !== undefined;
    },
  };
  let timer = 0;
  // After a key turned the view: from where it is seen now, once it rests.
  const sayDirectionSoon = (): void => {
    clearTimeout(timer);
    timer = window.setTimeout(() => announce(directionWords(...navigation.direction())), SPEAK_PAUSE_MS);
  };
  document.addEventListener("keydown", (event) => {
    if (isField(event.target) || document.querySelector("dialog[open]")) return;
    if (pressKey(event, actions)) {
      event.preventDefault();
      sayDirectionSoon();
    } else if (event.code === "Enter" && event.target === canvas) {
      const box = canvas.getBoundingClientRect();
      app.setPivot(box.left + box.width / 2, box.top + box.height / 2);
    }
  });
}
