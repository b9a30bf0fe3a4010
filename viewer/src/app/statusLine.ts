/** The small print: what is drawn, what was loaded, how exact, how fast. */

import type { RefinementFigures } from "../stream/refinement";
import { byId, make } from "./dom";
import { icon } from "./icons";
import { WORDS } from "./words";

export interface Figures {
  readonly triangles: number;
  readonly receivedBytes: number;
  /** Null where what is received is no part of a file. */
  readonly allBytes: number | null;
  /** Null where nothing has an error. */
  readonly errorPx: number | null;
  readonly refinement: Pick<RefinementFigures, "milliseconds" | "threshold"> | null;
  /** Null while the picture is still. */
  readonly framesPerSecond: number | null;
}

const INTERVAL_MS = 200;

export class StatusLine {
  readonly #root = byId("status");
  readonly #parts = ["triangles", "bytes", "error", "update", "threshold", "frames"].map((name) =>
    make("span", { "data-part": name }),
  );
  #last = 0;
  #timer = 0;
  #figures: Figures | undefined;

  constructor(onClose: () => void) {
    const close = make(
      "button",
      { type: "button", class: "icon", "aria-label": `${WORDS.close}: ${WORDS.status}` },
      icon("close"),
    );
    close.addEventListener("click", onClose);
    this.#root.append(...this.#parts, close);
  }

  set isShown(isShown: boolean) {
    this.#root.hidden = !isShown;
  }

  /** Show these figures, at most five times a second. */
  update(figures: Figures): void {
    this.#figures = figures;
    clearTimeout(this.#timer);
    const wait = this.#last + INTERVAL_MS - performance.now();
    if (wait <= 0) this.#write();
    else this.#timer = window.setTimeout(() => this.#write(), wait);
  }

  #write(): void {
    if (!this.#figures) return;
    this.#last = performance.now();
    const { triangles, receivedBytes, allBytes, errorPx, refinement, framesPerSecond } = this.#figures;
    const texts = [
      `${triangles.toLocaleString("en")} ${WORDS.triangles}`,
      allBytes === null
        ? `${formatBytes(receivedBytes)} ${WORDS.received}`
        : WORDS.loadedOf(formatBytes(Math.min(receivedBytes, allBytes)), formatBytes(allBytes)),
      errorPx === null ? "" : `${WORDS.error} ${formatPixels(errorPx)}`,
      refinement ? `${WORDS.update} ${refinement.milliseconds.toFixed(1)} ms` : "",
      // by how much edges are longer than wanted, to keep the budgets
      refinement && refinement.threshold > 1
        ? WORDS.threshold(Number(refinement.threshold.toPrecision(2)).toString())
        : "",
      framesPerSecond === null ? WORDS.still : `${Math.round(framesPerSecond)} ${WORDS.framesPerSecond}`,
    ];
    this.#parts.forEach((part, i) => {
      if (part.textContent !== texts[i]) part.textContent = texts[i]!;
      part.hidden = !texts[i];
    });
  }
}

/** Bytes in three figures, e.g. `3.21 MB`. */
export function formatBytes(bytes: number): string {
  const units = ["B", "kB", "MB", "GB"];
  let value = bytes;
  let unit = 0;
  while (value >= 999.5 && unit < units.length - 1) {
    value /= 1000;
    unit++;
  }
  return `${unit === 0 ? value : value.toPrecision(3)} ${units[unit]}`;
}

export function formatPixels(errorPx: number): string {
  if (!Number.isFinite(errorPx)) return "–";
  return `${errorPx >= 10 ? Math.round(errorPx) : errorPx.toFixed(1)} px`;
}
