/** Out of the page: a link on the clipboard, a picture in a file. */
import { makeDialog } from "./dialogs";
import { make } from "./dom";
import { note } from "./notices";
import { WORDS } from "./words";

/** Copy the link; where the browser forbids that, show it, selected. */
export async function copyLink(href: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(href);
    note(WORDS.linkCopied);
  } catch {
    showLink(href);
  }
}

function showLink(href: string): void {
  const { dialog, body } = makeDialog("link", WORDS.linkHere);
  const field = make("input", { type: "text", readonly: "", value: href, "aria-label": WORDS.linkHere });
  body.append(field);
  dialog.addEventListener("close", () => dialog.remove());
  dialog.showModal();
  field.focus();
  field.select();
}

export async function savePicture(picture: Blob, title: string): Promise<void> {
  const url = URL.createObjectURL(picture);
  const link = make("a", { href: url, download: `${fileName(title)}.png` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** A title as a name that every file system takes. */
export function fileName(title: string): string {
  const plain = title
    .normalize("NFKD")
    .replace(/[^\w.-]+/g, "-")
    .replace(/^[-.]+|[-.]+$/g, "");
  return plain.slice(0, 80) || "picture";
}
