/** The page's address keeps the state, so that it can be copied, reloaded and gone back to. */
import { note } from "./notices";
import { formatState, parseState, type State } from "./state";
import { WORDS } from "./words";

/** Browsers refuse an address that changes with every frame. */
const PAUSE_MS = 400;

export class Address {
  #timer = 0;

  /**
   * @param get - The state as it is, or null while there is nothing to remember.
   * @param set - Show the state of an address that was opened.
   */
  constructor(
    private readonly get: () => State | null,
    private readonly set: (state: State) => void,
  ) {
    addEventListener("hashchange", () => this.read());
  }

  /** Take over what the address says, if anything. */
  read(): void {
    if (location.hash.length < 2) return;
    const state = parseState(location.hash);
    if (state) this.set(state);
    else note(WORDS.foreignLink);
  }

  writeSoon(): void {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.write(), PAUSE_MS);
  }

  write(): void {
    const state = this.get();
    if (!state) return;
    const hash = `#${formatState(state)}`;
    if (hash !== location.hash) history.replaceState(history.state, "", hash);
  }
}
