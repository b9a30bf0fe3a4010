/** Help and settings, as the browser's own modal dialogs: focus stays in, Esc closes, focus returns. */
import { make } from "./dom";
import { icon } from "./icons";
import { HELP_KEYS, HELP_ROWS, WORDS } from "./words";

/** An empty dialog with a title and a close button, added to the page. */
export function makeDialog(id: string, title: string): { dialog: HTMLDialogElement; body: HTMLElement } {
  const heading = make("h2", { id: `${id}-title` }, title);
  const close = make("button", { type: "button", class: "icon", "aria-label": WORDS.close }, icon("close"));
  const body = make("div", { class: "body" });
  const dialog = make(
    "dialog",
    { id, "aria-labelledby": `${id}-title` },
    make("header", {}, heading, close),
    body,
  );
  close.addEventListener("click", () => dialog.close());
  // a press beside the sheet, on the backdrop, closes it too
  dialog.addEventListener("pointerdown", (event) => {
    const box = dialog.getBoundingClientRect();
    const isOutside =
      event.clientX < box.left ||
      event.clientX > box.right ||
      event.clientY < box.top ||
      event.clientY > box.bottom;
    if (isOutside && event.target === dialog) dialog.close();
  });
  document.body.append(dialog);
  return { dialog, body };
}

export function makeHelp(): HTMLDialogElement {
  const { dialog, body } = makeDialog("help", WORDS.help);
  const cell = (tag: "th" | "td", text: string, label?: string): HTMLElement =>
    make(tag, { scope: tag === "th" ? "row" : null, "data-label": label ?? null }, text);
  const columns = ["Mouse", "Touch", "Keys"];
  const head = make("tr", {}, make("td"), ...columns.map((text) => make("th", { scope: "col" }, text)));
  const rows = HELP_ROWS.map(([what, ...how]) =>
    make("tr", {}, cell("th", what), ...how.map((text, i) => cell("td", text, columns[i]))),
  );
  const table = make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows));
  body.append(table, make("h3", {}, "More keys"), make("dl", { class: "keys" }));
  addKeys(dialog, HELP_KEYS);
  return dialog;
}

/** Tell of more keys on the help page. */
export function addKeys(help: HTMLDialogElement, keys: typeof HELP_KEYS): void {
  const rows = keys.map(([key, what]) =>
    make("div", {}, make("dt", {}, make("kbd", {}, key)), make("dd", {}, what)),
  );
  help.querySelector(".keys")!.append(...rows);
}
