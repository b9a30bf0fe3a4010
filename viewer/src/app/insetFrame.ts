/** The frame of the picture from elsewhere: where it is on the page, and how it is turned and closed. */
import type { InsetPlace } from "../scene/inset";
import { make } from "./dom";
import { icon } from "./icons";
import { WORDS } from "./words";

export interface InsetEvents {
  /** It is elsewhere, or of another size. */
  readonly onPlace: () => void;
  /** Turn by degrees. */
  readonly onTurn: (right: number, up: number) => void;
  readonly onClose: () => void;
}

const DEGREES_PER_PIXEL = 0.6;
const DEGREES_PER_KEY = 15;

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

export class InsetFrame {
  readonly #root = make("section", { id: "inset", "aria-label": WORDS.inset, hidden: "" });

  constructor(private readonly events: InsetEvents) {
    const view = make("div", { role: "application", tabindex: "0", "aria-label": WORDS.insetTurns });
    const close = make(
      "button",
      { type: "button", class: "icon", "aria-label": `${WORDS.close}: ${WORDS.inset}` },
      icon("close"),
    );
    close.addEventListener("click", events.onClose);
    this.#root.append(view, close);
    document.body.append(this.#root);
    this.#listen(view);
    new ResizeObserver(events.onPlace).observe(this.#root);
    addEventListener("resize", events.onPlace);
  }

  set isShown(isShown: boolean) {
    this.#root.hidden = !isShown;
  }

  /** In CSS pixels of the page, which the canvas fills; null while it has no size. */
  get place(): InsetPlace | null {
    const { left, top, width, height } = this.#root.getBoundingClientRect();
    return width > 1 && height > 1 ? { left, top, width, height } : null;
  }

  #listen(view: HTMLElement): void {
    view.addEventListener("pointerdown", (event) => view.setPointerCapture(event.pointerId));
    view.addEventListener("pointermove", (event) => {
      if (!view.hasPointerCapture(event.pointerId)) return;
      // the model goes with the pointer, so the eye goes the other way
      this.events.onTurn(-DEGREES_PER_PIXEL * event.movementX, DEGREES_PER_PIXEL * event.movementY);
    });
    view.addEventListener("keydown", (event) => {
      const arrow = ARROWS[event.code];
      if (!arrow || event.ctrlKey || event.altKey || event.metaKey) return;
      event.preventDefault();
      event.stopPropagation(); // the picture itself stays
      this.events.onTurn(arrow[0] * DEGREES_PER_KEY, arrow[1] * DEGREES_PER_KEY);
    });
  }
}
