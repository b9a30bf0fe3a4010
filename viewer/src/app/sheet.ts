/** A dialog of settings: rows of one look, brought up to date whenever it is opened. */
import { makeDialog } from "./dialogs";
import { make } from "./dom";
import { makeSlider, type NumberSetting } from "./slider";

/** One of several. */
export interface Selection<T extends string> {
  readonly id: string;
  readonly label: string;
  readonly options: readonly (readonly [value: T, name: string])[];
  readonly get: () => T;
  readonly set: (value: T) => void;
}

/** On or off. */
export interface Switch {
  readonly name: string;
  readonly get: () => boolean;
  readonly set: (isOn: boolean) => void;
}

export class Sheet {
  readonly dialog: HTMLDialogElement;
  readonly #body: HTMLElement;
  readonly #refreshers: (() => void)[] = [];

  constructor(id: string, title: string) {
    const { dialog, body } = makeDialog(id, title);
    dialog.classList.add("sheet");
    this.dialog = dialog;
    this.#body = body;
  }

  open(): void {
    this.refresh();
    this.dialog.showModal();
  }

  /** Show what is so now. */
  refresh(): void {
    for (const refresh of this.#refreshers) refresh();
  }

  onRefresh(refresh: () => void): void {
    this.#refreshers.push(refresh);
  }

  add(...nodes: Node[]): void {
    this.#body.append(...nodes);
  }

  addSlider(setting: NumberSetting): void {
    this.add(makeSlider(setting, this.#refreshers));
  }

  addSelection<T extends string>({ id, label, options, get, set }: Selection<T>): void {
    const select = make("select", { id: `set-${id}` });
    for (const [value, name] of options) select.append(make("option", { value }, name));
    select.addEventListener("change", () => set(select.value as T));
    this.onRefresh(() => {
      select.value = get();
    });
    this.add(make("div", { class: "setting" }, make("label", { for: select.id }, label), select));
  }

  addHeading(text: string): void {
    this.add(make("h3", {}, text));
  }

  addSwitch({ name, get, set }: Switch, parent?: HTMLElement): void {
    const box = make("input", { type: "checkbox" });
    box.addEventListener("change", () => set(box.checked));
    this.onRefresh(() => {
      box.checked = get();
    });
    (parent ?? this.#body).append(make("label", { class: "switch" }, box, name));
  }

  addSwitches(legend: string, switches: readonly Switch[]): void {
    const group = make("fieldset", {}, make("legend", {}, legend));
    for (const one of switches) this.addSwitch(one, group);
    this.add(group);
  }

  /** A button that changes what is shown here. */
  addReset(name: string, run: () => void): void {
    const reset = make("button", { type: "button" }, name);
    reset.addEventListener("click", () => {
      run();
      this.refresh();
    });
    this.add(reset);
  }
}
