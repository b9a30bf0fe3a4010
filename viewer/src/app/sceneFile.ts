/** scene.json: which assets to show, and the views that somebody named. */
import type { Triple } from "../format/graph";
import { nameOf, Problem } from "../format/problem";
import type { CameraState } from "../scene/navigation";

export interface SceneLayer {
  readonly name: string;
  /** Address of the `.fov`, absolute. */
  readonly url: string;
  readonly isVisible: boolean;
  /** Address of the server's session for a control mesh, absolute, or null where the page refines by itself. */
  readonly live: string | null;
  /** What the layer says beside that, such as how it is refined. */
  readonly rest: Readonly<Record<string, unknown>>;
}

export interface NamedView {
  readonly name: string;
  readonly camera: CameraState;
}

/** A light whose shadows are precomputed. */
export interface SceneLightFile {
  /** Address of the `.fov`, absolute. */
  readonly url: string;
  /** Names of the layers that are not in it and cast by an ordinary shadow map. */
  readonly moving: readonly string[];
}

export interface SceneFile {
  readonly title: string;
  readonly layers: readonly SceneLayer[];
  readonly views: readonly NamedView[];
  readonly background: string | null;
  readonly light: SceneLightFile | null;
}

const VERSION = 1;
const DEFAULT_FIELD_OF_VIEW = 40;

/** @throws Problem if it is missing or is not such a file. */
export async function fetchScene(url: string): Promise<SceneFile> {
  let response: Response;
  try {
    response = await fetch(url, { cache: "no-cache" });
  } catch {
    throw new Problem("network", "The server does not answer. Is it still running?");
  }
  if (!response.ok) {
    throw new Problem(
      "missing",
      `${nameOf(url)} is not there (status ${response.status}). It belongs beside this page.`,
    );
  }
  let data: unknown;
  try {
    data = await response.json();
  } catch {
    throw new Problem("foreign", `${nameOf(url)} is not JSON. Write it again with: foveal publish`);
  }
  return parseScene(data, response.url || url);
}

/** @throws Problem in a sentence that names what is wrong. */
export function parseScene(data: unknown, url: string): SceneFile {
  const name = nameOf(url);
  if (!isObject(data) || !Array.isArray(data.layers) || data.layers.length === 0) {
    throw new Problem(
      "foreign",
      `${name} is not a scene: it names no layers. Write it again with: foveal publish`,
    );
  }
  if (data.version !== VERSION) {
    throw new Problem(
      "version",
      `${name} has version ${String(data.version)}; this viewer knows version ${VERSION}. Update foveal.`,
    );
  }
  const layers = data.layers.map((layer: unknown, i): SceneLayer => {
    if (!isObject(layer) || typeof layer.asset !== "string") {
      throw new Problem(
        "foreign",
        `${name}: layer ${i + 1} names no asset. Write it again with: foveal publish`,
      );
    }
    return {
      name: typeof layer.name === "string" ? layer.name : nameOf(layer.asset),
      url: new URL(layer.asset, url).href,
      isVisible: layer.visible !== false,
      live: typeof layer.live === "string" ? socketAddress(layer.live, url) : null,
      rest: layer,
    };
  });
  const views = Array.isArray(data.views) ? data.views.flatMap(viewOf) : [];
  const background = typeof data.background === "string" ? data.background : null;
  const title = typeof data.title === "string" && data.title ? data.title : layers[0]!.name;
  return { title, layers, views, background, light: lightOf(data.light, url) };
}

/** @throws Problem if there is a light that names no asset. */
function lightOf(light: unknown, url: string): SceneLightFile | null {
  if (light === undefined || light === null) return null;
  if (!isObject(light) || typeof light.asset !== "string") {
    throw new Problem(
      "foreign",
      `${nameOf(url)}: the light names no asset. Write it again with: foveal publish`,
    );
  }
  const names = Array.isArray(light.moving) ? light.moving : [];
  const moving = names.filter((name) => typeof name === "string");
  return { url: new URL(light.asset, url).href, moving };
}

/** The same place by the protocol of WebSockets. */
function socketAddress(live: string, base: string): string {
  const url = new URL(live, base);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  return url.href;
}

/** A named view; one that makes no sense is left out, since the scene is there without it. */
function viewOf(view: unknown): NamedView[] {
  if (!isObject(view) || typeof view.name !== "string" || !isObject(view.camera)) return [];
  const { position, target, up, field_of_view_degrees } = view.camera;
  if (!isTriple(position) || !isTriple(target)) return [];
  const camera: CameraState = {
    position,
    target,
    up: isTriple(up) ? up : [0, 1, 0],
    fieldOfViewDegrees:
      typeof field_of_view_degrees === "number" ? field_of_view_degrees : DEFAULT_FIELD_OF_VIEW,
  };
  return [{ name: view.name, camera }];
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}

function isTriple(value: unknown): value is Triple {
  return Array.isArray(value) && value.length === 3 && value.every((x) => Number.isFinite(x));
}
