/** The small print: what is drawn, what was loaded, how exact, how fast. */

import { byId, make } from "./dom";
import { icon } from "./icons";
import { WORDS } from "./words";

export interface Figures {
  readonly triangles: number;
  readonly receivedBytes: number;
  readonly allBytes: number;
  readonly errorPx: number;
  /** Null while the picture is still. */
  readonly framesPerSecond: number | null;
}

const INTERVAL_MS = 200;

export class StatusLine {
  readonly #root = byId("status");
  readonly #parts = ["triangles", "bytes", "error", "frames"].map((name) =>
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
    const { triangles, receivedBytes, allBytes, errorPx, framesPerSecond } = this.#figures;
    const frames =
      framesPerSecond === null ? WORDS.still : `${Math.round(framesPerSecond)} ${WORDS.framesPerSecond}`;
    const texts = [
      `${triangles.toLocaleString("en")} ${WORDS.triangles}`,
      WORDS.loadedOf(formatBytes(Math.min(receivedBytes, allBytes)), formatBytes(allBytes)),
      `${WORDS.error} ${formatPixels(errorPx)}`,
      frames,
    ];
    this.#parts.forEach((part, i) => {
      if (part.textContent !== texts[i]) part.textContent = texts[i]!;
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
