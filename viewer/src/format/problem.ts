/** What can go wrong for a visitor, always with a sentence that can be shown as it is. */
export type ProblemKind =
  | "missing" // no such file
  | "network" // no answer, or a server that fails
  | "foreign" // not a .fov, or not a scene
  | "version" // made by a newer foveal
  | "damaged" // checksum, offsets, counts
  | "changed" // the file was replaced while it was being read
  | "webgl"; // no WebGL2, or it was lost

/** An error whose message is a sentence for the visitor: the file, the fault, the remedy. */
export class Problem extends Error {
  override readonly name = "Problem";

  constructor(
    readonly kind: ProblemKind,
    message: string,
  ) {
    super(message);
  }
}

/** The sentence of any thrown thing. */
export function sentenceOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** Last part of a path or URL, for sentences. */
export function nameOf(url: string): string {
  const path = url.split(/[?#]/, 1)[0] ?? url;
  return decodeURI(path.slice(path.lastIndexOf("/") + 1)) || url;
}
