/**
 * A tessellation of Catmull-Clark patches that follows the camera of this page: says what changed, as a server's live
 * session does, at limit points with limit normals.
 *
 * Rows stay where they are, and the tessellation knows which it wrote; so a message costs what changed, and nothing is
 * compared. The same as `src/foveal/refine/patch_session.py`.
 *
 * @module refine/patchSession
 */
import { USUAL_DEPTHS } from "../format/cage";
import type { Triple } from "../format/graph";
import type { PolygonMesh } from "../format/polygons";
import { Problem } from "../format/problem";
import { Dialogue, MOST_TRIANGLES, type Request } from "./dialogue";
import { longer } from "./slates/arena";
import type { Blocks } from "./slates/blocks";
import { FrameRate } from "./slates/rate";
import { Slates } from "./slates/slates";
import type { View } from "./slates/views";
import { changedParts, type SlotParts, type SlotWords } from "./slotMessage";

/**
 * Points are kept as deep as they were ever wanted, for all that was ever looked at. From here on they are forgotten,
 * and all is told anew: 36 MB here, and as much again where they are drawn.
 */
const MOST_ROWS = 1_500_000;
const MOST_SINGLE = 3.4028234663852886e38;

export class PatchSession extends Dialogue {
  protected override readonly hasNormals = true;
  protected override readonly threshold = 1;
  readonly #mesh: PolygonMesh;
  #surface: Slates;
  /** Of all rows, or none at all. */
  #colours: Uint32Array | null = null;
  /** 0 before the first view: what one needs may be more already. */
  #mostRows = 0;
  #rate: FrameRate | null = null;
  #isForgotten = false;

  /**
   * @param origin - What positions are told relative to: the middle of the control mesh.
   * @param clock - Milliseconds; for tests, as is `mostRows`.
   * @throws Problem if the mesh is no oriented surface, or too large for numbers of 32 bits.
   */
  constructor(
    mesh: PolygonMesh,
    private readonly origin: Triple,
    private readonly name: string,
    clock: () => number = () => performance.now(),
    private readonly mostRows = MOST_ROWS,
  ) {
    super(clock);
    // About its own middle, so that rows are what is told.
    const positions = mesh.positions.map((p, i) => p - origin[i % 3]!);
    if (!positions.every((p) => Math.abs(p) < MOST_SINGLE)) {
      throw new Problem("damaged", `${name} is too large to be drawn. Scale it down.`);
    }
    this.#mesh = { ...mesh, positions, uvs: undefined }; // which nobody draws
    this.#surface = this.#begun();
  }

  #begun(): Slates {
    this.#colours = this.#mesh.colours ? new Uint32Array(0) : null;
    return new Slates(this.#mesh, { isSingle: true, name: this.name });
  }

  /** Each update brings all. */
  protected override get isSettled(): boolean {
    return this.last !== null;
  }

  protected override refine(request: Request): void {
    if (this.#surface.blocks.rows > this.#mostRows) {
      this.#surface = this.#begun();
      this.#isForgotten = true;
      this.#mostRows = 0;
    }
    const rules = request.depths ?? USUAL_DEPTHS;
    this.#surface.update(this.#viewOf(request), rules, this.#budget(request));
    if (this.#mostRows === 0) this.#mostRows = Math.max(this.mostRows, 2 * this.#surface.blocks.rows);
    if (this.#colours) this.#colours = packedColours(this.#surface.blocks, this.#colours);
    this.last = request;
    this.triangles = this.#surface.shown.triangles;
  }

  #viewOf({ camera }: Request): View {
    const [x, y, z] = camera.position;
    const eye: Triple = [x - this.origin[0], y - this.origin[1], z - this.origin[2]];
    return { eye, pixels: camera.height / (2 * Math.tan(camera.fov / 2)) };
  }

  /** Triangles at most: what was asked for, what we allow, and what keeps to the rate. */
  #budget({ budget, rate }: Request): number {
    const allowed = Math.min(budget || MOST_TRIANGLES, MOST_TRIANGLES);
    if (!rate) this.#rate = null;
    else if (this.#rate?.rate !== rate) {
      this.#rate = new FrameRate(rate, 2 * this.#surface.cage.patches, MOST_TRIANGLES);
    }
    return Math.min(allowed, this.#rate?.budget ?? allowed);
  }

  protected override spent({ drawn_ms }: Request, milliseconds: number): void {
    this.#rate?.tell(milliseconds + drawn_ms, this.triangles);
  }

  protected override parts(_request: Request, isAnew: boolean): SlotParts {
    const words = this.#words();
    const isFresh = isAnew || this.#isForgotten;
    this.#isForgotten = false;
    if (isFresh) return changedParts(words, null);
    const { blocks, shown } = this.#surface;
    const [rows, faces] = [timesThree(blocks.changed), timesThree(shown.changed)];
    const bounds = [faces, rows, rows, wordsOf(shown.changed), blocks.changed];
    return { isFresh, words, bounds: bounds.slice(0, words.length) };
  }

  /** Faces, positions, normals, depths, and colours if there are any. */
  #words(): SlotWords {
    const { blocks, shown } = this.#surface;
    const [positions, normals] = [blocks.columns[0]!, blocks.columns.at(-1)!].map(
      ({ buffer }) => new Uint32Array(buffer, 0, 3 * blocks.rows),
    );
    const faces = shown.faces.subarray(0, 3 * shown.rows);
    const levels = new Uint32Array(shown.levels.buffer, 0, Math.ceil(shown.rows / 4));
    const words = [faces, positions!, normals!, levels] as const;
    return this.#colours ? [...words, this.#colours.subarray(0, blocks.rows)] : words;
  }
}

/** Colours of all rows as words, red lowest and 255 highest, of those before the last update. */
function packedColours({ columns, rows, changed }: Blocks, before: Uint32Array): Uint32Array {
  const words = rows > before.length ? longer(before, Math.max(rows, before.length * 1.5)) : before;
  const bytes = new Uint8Array(words.buffer);
  const colours = columns[1]!;
  for (let i = 0; i < changed.length; i += 2) {
    for (let v = changed[i]!; v < changed[i + 1]!; v++) {
      for (let k = 0; k < 3; k++) bytes[4 * v + k] = byteOf(colours[3 * v + k]!);
      bytes[4 * v + 3] = 255;
    }
  }
  return words;
}

/** The nearest of 0 to 255, the even one of two that are as near. */
function byteOf(value: number): number {
  const up = Math.round(Math.min(Math.max(value, 0), 255));
  return up - value === 0.5 ? up & ~1 : up;
}

/** Of words where there are three a row. */
function timesThree(bounds: readonly number[]): number[] {
  return bounds.map((row) => 3 * row);
}

/** Of words where four rows are one. */
function wordsOf(bounds: readonly number[]): number[] {
  const out: number[] = [];
  for (let i = 0; i < bounds.length; i += 2) {
    const [begin, end] = [bounds[i]! >> 2, (bounds[i + 1]! + 3) >> 2];
    if (out.length > 0 && begin <= out.at(-1)!) out[out.length - 1] = end;
    else out.push(begin, end);
  }
  return out;
}
