/** The row of tools: one tab stop, arrow keys move within it (the ARIA toolbar pattern). */
import { make } from "./dom";
import { type IconName, icon } from "./icons";

export interface Tool {
  readonly icon: IconName;
  readonly name: string;
  /** The key that does the same, for the tooltip. */
  readonly key: string;
  readonly run: () => void;
  /** For what is on or off. */
  readonly isPressed?: () => boolean;
  /** For what this scene does not have; it stays reachable, and says so. */
  readonly isDisabled?: () => boolean;
  /** For what makes no sense in this scene. */
  readonly isAbsent?: () => boolean;
  /** Short text over the icon, such as the axis. */
  readonly badge?: () => string;
  /** Name that changes with the state. */
  readonly label?: () => string;
  /** A thin line before it. */
  readonly startsGroup?: boolean;
}

export class Toolbar {
  readonly #buttons = new Map<Tool, HTMLButtonElement>();

  constructor(root: HTMLElement, tools: readonly Tool[]) {
    for (const tool of tools) {
      const button = this.#makeButton(tool);
      this.#buttons.set(tool, button);
      root.append(button);
    }
    this.#setStop(0);
    root.addEventListener("keydown", (event) => this.#move(event));
    root.addEventListener("focusin", (event) => {
      const at = this.#list().indexOf(event.target as HTMLButtonElement);
      if (at >= 0) this.#setStop(at);
    });
    this.update();
  }

  /** Bring pressed states, names and badges up to date. */
  update(): void {
    for (const [tool, button] of this.#buttons) {
      button.hidden = tool.isAbsent?.() ?? false;
      const isDisabled = tool.isDisabled?.() ?? false;
      if (tool.isPressed) button.setAttribute("aria-pressed", String(!isDisabled && tool.isPressed()));
      if (tool.isDisabled) button.setAttribute("aria-disabled", String(isDisabled));
      const name = tool.label?.() ?? tool.name;
      button.setAttribute("aria-label", name);
      button.querySelector(".tip")?.replaceChildren(name, make("kbd", {}, tool.key));
      if (tool.badge) button.dataset.badge = tool.badge();
    }
  }

  #makeButton(tool: Tool): HTMLButtonElement {
    const tip = make("span", { class: "tip", "aria-hidden": "true" });
    const className = tool.startsGroup ? "starts-group" : null;
    const button = make("button", { type: "button", class: className }, icon(tool.icon), tip);
    button.dataset.tool = tool.icon;
    button.setAttribute("aria-keyshortcuts", tool.key);
    button.addEventListener("click", () => {
      if (!tool.isDisabled?.()) tool.run();
    });
    return button;
  }

  #list(): HTMLButtonElement[] {
    return [...this.#buttons.values()].filter((button) => !button.hidden);
  }

  #setStop(at: number): void {
    this.#list().forEach((button, i) => {
      button.tabIndex = i === at ? 0 : -1;
    });
  }

  #move(event: KeyboardEvent): void {
    const list = this.#list();
    const at = list.indexOf(document.activeElement as HTMLButtonElement);
    const next = {
      ArrowRight: at + 1,
      ArrowDown: at + 1,
      ArrowLeft: at - 1,
      ArrowUp: at - 1,
      Home: 0,
      End: list.length - 1,
    }[event.code];
    if (next === undefined || at < 0) return;
    event.preventDefault();
    event.stopPropagation();
    list.at(next % list.length)?.focus();
  }
}
