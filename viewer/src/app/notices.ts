/** What the page says: politely to screen readers, as a passing note, or as an error with a way out. */
import { sentenceOf } from "../format/problem";
import { byId, make } from "./dom";
import { icon } from "./icons";
import { WORDS } from "./words";

const NOTE_MS = 4000;
let noteTimer = 0;

/** For screen readers only. */
export function announce(sentence: string): void {
  const said = byId("said");
  // the same sentence twice would not be read twice
  said.textContent = said.textContent === sentence ? `${sentence}\u00a0` : sentence;
}

/** A note that goes by itself; read out too. */
export function note(sentence: string): void {
  const toast = byId("toast");
  toast.hidden = false;
  toast.textContent = sentence;
  clearTimeout(noteTimer);
  noteTimer = window.setTimeout(() => {
    toast.hidden = true;
  }, NOTE_MS);
}

/** Nothing can be shown: a card in the middle of the page. */
export function showFailure(error: unknown): void {
  const again = make("button", { type: "button", class: "primary" }, WORDS.tryAgain);
  again.addEventListener("click", () => location.reload());
  const heading = make("h2", {}, WORDS.failed);
  byId("alerts").replaceChildren(
    make("div", { class: "card" }, heading, make("p", {}, sentenceOf(error)), again),
  );
}

/** Something is wrong, but the picture stays: a strip that can be closed. */
export function showWarning(sentence: string, retry?: () => void): HTMLElement {
  const strip = make("div", { class: "strip" }, make("p", {}, sentence));
  const dismiss = (): void => strip.remove();
  if (retry) {
    const again = make("button", { type: "button" }, WORDS.tryAgain);
    again.addEventListener("click", () => {
      dismiss();
      retry();
    });
    strip.append(again);
  }
  const close = make("button", { type: "button", "aria-label": WORDS.close, class: "icon" }, icon("close"));
  close.addEventListener("click", dismiss);
  strip.append(close);
  byId("alerts").replaceChildren(strip);
  return strip;
}
