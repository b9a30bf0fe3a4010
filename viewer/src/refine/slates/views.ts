/**
 * How deep each patch shall be for a view: by curvature, class, projected size, and a budget of triangles.
 *
 * Based on: Settgast, Müller, Fünfzig, Fellner, section 3.1.
 *
 * @module refine/slates/views
 */
import type { DepthRules } from "../../format/cage";
import type { Triple } from "../../format/graph";
import { ballsOf, bends, curvatureOf } from "./bends";
import { countTriangles, rise } from "./counts";
import type { Limits } from "./limits";
import type { SlateCage } from "./net";
import type { Placements } from "./placements";
import { workOf } from "./work";

/** From where one looks, in the space of the placements; and pixels of a unit length at unit distance. */
export interface View {
  readonly eye: Triple;
  readonly pixels: number;
}

const BACK = 0;
const FRONT = 1;
const SILHOUETTE = 2;

/** The rules' answers for placements of a control mesh; what depends on the mesh alone is kept. */
export class Views {
  readonly #isOpen: boolean;
  #cosines: Float64Array | null = null;
  #levels = 0;
  #curvature: Int8Array | null = null;
  #key = "";
  #balls: Float64Array | null = null;

  constructor(
    private readonly cage: SlateCage,
    private readonly limits: Limits,
  ) {
    this.#isOpen = cage.net.mates.some((mate) => mate < 0) || cage.isShown.includes(0);
  }

  /** Of one view, for each placement: by the rules, and within a budget where that is not null. */
  depths(view: View, rules: DepthRules, placements: Placements, budget: number | null): Int8Array {
    const classes = this.#classes(view, rules.epsilon, placements);
    const sizes = this.#sizes(view, placements);
    const byRules = (most: number) => this.#choose(rules, classes, sizes, most);
    const upper = byRules(rules.most);
    return budget === null ? upper : this.#within(budget, upper, rules.most, sizes, byRules);
  }

  /**
   * As deep as a budget of triangles allows too.
   *
   * First the maximum depth is lowered until the budget holds, then patches rise to the next, those that look largest
   * first, as many as may: a function of the view alone. More triangles than the budget only where nothing is
   * subdivided.
   */
  #within(
    budget: number,
    deepest: Int8Array,
    most: number,
    sizes: Float64Array,
    byRules: (most: number) => Int8Array,
  ): Int8Array {
    const { net } = this.cage;
    let upper = deepest;
    if (countTriangles(net, upper) <= budget) return upper;
    for (let less = most - 1; less >= 0; less--) {
      const lower = byRules(less);
      const total = countTriangles(net, lower);
      if (total <= budget) {
        const rising: number[] = [];
        for (let entry = 0; entry < lower.length; entry++) {
          if (upper[entry]! > lower[entry]!) rising.push(entry);
        }
        const looks = sizes.map((size, entry) => size / (1 << Math.max(0, lower[entry]!)));
        // Where both are infinite the difference is no number, and they stay in order as equals do.
        rising.sort((a, b) => (looks[a] === looks[b] ? a - b : looks[b]! - looks[a]!));
        rise(net, lower, rising, upper, budget, total);
        return lower;
      }
      upper = lower;
    }
    return upper;
  }

  /** The depth that each vertex needs, by the cone of normals. */
  #curvatureFor({ cone_degrees: cone, most }: DepthRules): Int8Array {
    const key = `${cone} ${most}`;
    if (this.#curvature && this.#key === key) return this.#curvature;
    const { net } = this.cage;
    let levels: Int8Array = new Int8Array(net.fans.length).fill(most);
    if (cone !== null) {
      if (this.#cosines === null || this.#levels <= most) {
        this.#levels = most + 1;
        this.#cosines = bends(net, workOf(net, 0), this.limits, this.#levels);
      }
      levels = curvatureOf(this.#cosines, this.#levels, Math.cos(cone * (Math.PI / 180)), most);
    }
    this.#key = key;
    this.#curvature = levels;
    return levels;
  }

  /** From each eye, of each vertex: BACK or FRONT if all its normals agree on it, else SILHOUETTE. */
  #classes({ eye }: View, epsilon: number, placements: Placements): Uint8Array {
    const { net } = this.cage;
    const { cornerPoints, cornerNormals } = this.limits;
    const count = net.fans.length;
    const out = new Uint8Array(placements.count * count);
    for (let i = 0; i < placements.count; i++) {
      const [ex, ey, ez] = placements.inside(i, eye);
      for (let v = 0; v < count; v++) {
        const x = cornerPoints[3 * v]! - ex;
        const y = cornerPoints[3 * v + 1]! - ey;
        const z = cornerPoints[3 * v + 2]! - ez;
        const near = epsilon * Math.sqrt(x * x + y * y + z * z);
        let [isBack, isFront] = [true, true];
        for (let j = 3 * net.normalStarts[v]!; j < 3 * net.normalStarts[v + 1]!; j += 3) {
          const dot = cornerNormals[j]! * x + cornerNormals[j + 1]! * y + cornerNormals[j + 2]! * z;
          isBack &&= dot > near;
          isFront &&= dot < -near;
        }
        out[i * count + v] = isBack ? BACK : isFront ? FRONT : SILHOUETTE;
      }
    }
    return out;
  }

  /** Of each ball its radius in pixels, as each placement places it; infinite where the eye is in it. */
  #sizes({ eye, pixels }: View, { count, matrices, scales }: Placements): Float64Array {
    const { net, patches } = this.cage;
    this.#balls ??= ballsOf(net, workOf(net, 0), this.limits);
    const balls = this.#balls;
    const out = new Float64Array(count * patches);
    for (let i = 0; i < count; i++) {
      for (let f = 0; f < patches; f++) {
        let away = 0;
        for (let x = 0; x < 3; x++) {
          const row = 16 * i + 4 * x;
          let d = matrices[row + 3]! - eye[x]!;
          for (let y = 0; y < 3; y++) d += matrices[row + y]! * balls[4 * f + y]!;
          away += d * d;
        }
        const radius = scales[i]! * balls[4 * f + 3]!;
        out[i * patches + f] = away > radius * radius ? (pixels * radius) / Math.sqrt(away) : Infinity;
      }
    }
    return out;
  }

  #choose(rules: DepthRules, classes: Uint8Array, sizes: Float64Array, most: number): Int8Array {
    const { patches, isShown } = this.cage;
    const curvature = this.#curvatureFor(rules);
    const count = curvature.length;
    const [smallest, largest] = rules.size_px ?? [0, Infinity];
    const words = {
      most,
      smallest,
      largest,
      hasBacks: rules.backs && !this.#isOpen,
      hasSilhouettes: rules.silhouettes,
    };
    const out = new Int8Array(sizes.length).fill(-1);
    for (let entry = 0; entry < out.length; entry++) {
      const f = entry % patches;
      if (!isShown[f]) continue;
      const first = count * ((entry - f) / patches);
      out[entry] = byRules(this.cage.net.corners, f, curvature, classes, first, sizes[entry]!, words);
    }
    return out;
  }
}

interface Words {
  readonly most: number;
  readonly smallest: number;
  readonly largest: number;
  readonly hasBacks: boolean;
  readonly hasSilhouettes: boolean;
}

/** A patch's depth; classes of its placement are from `first` on. */
function byRules(
  corners: Int32Array,
  f: number,
  curvature: Int8Array,
  classes: Uint8Array,
  first: number,
  looks: number,
  words: Words,
): number {
  const { most, smallest, largest } = words;
  let [depth, backs, fronts] = [0, 0, 0];
  for (let h = 4 * f; h < 4 * f + 4; h++) {
    const v = corners[h]!;
    depth = Math.max(depth, Math.min(curvature[v]!, most));
    if (classes[first + v] === BACK) backs++;
    else if (classes[first + v] === FRONT) fronts++;
  }
  if (backs === 4 && words.hasBacks) return 0;
  if (words.hasSilhouettes && backs < 4 && fronts < 4) depth = (most + depth + 1) >> 1;
  let size = looks / (1 << depth);
  while (size > largest && depth < most) {
    depth++;
    size *= 0.5;
  }
  while (size < smallest && depth > 0) {
    depth--;
    size *= 2;
  }
  return depth;
}
