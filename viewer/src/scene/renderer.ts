/** The WebGL2 renderer and what draws with it, or a sentence where there can be none. */
import { WebGLRenderer } from "three";
import { Problem } from "../format/problem";

export interface Graphics {
  readonly renderer: WebGLRenderer;
  /** The processor draws. */
  readonly isSoftware: boolean;
}

/** @throws Problem if the browser has no WebGL2. */
export function makeGraphics(canvas: HTMLCanvasElement): Graphics {
  const sentence =
    "This browser does not give WebGL2, which the picture needs. Try a current browser, or switch hardware acceleration on.";
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) throw new Problem("webgl", sentence);
  // Where the processor draws, four samples a pixel cost four times as much; smooth motion is worth more.
  const isSoftware = /swiftshader|llvmpipe|software|basic render/i.test(rendererOf(probe));
  probe.getExtension("WEBGL_lose_context")?.loseContext(); // browsers allow few contexts at a time
  try {
    const renderer = new WebGLRenderer({
      canvas,
      antialias: !isSoftware,
      powerPreference: "high-performance",
    });
    return { renderer, isSoftware };
  } catch {
    throw new Problem("webgl", sentence);
  }
}

/** The name of the graphics; some browsers give it only by an extension. */
function rendererOf(context: WebGL2RenderingContext): string {
  const name = String(context.getParameter(context.RENDERER));
  if (!name.startsWith("WebKit")) return name;
  const extension = context.getExtension("WEBGL_debug_renderer_info");
  return extension ? String(context.getParameter(extension.UNMASKED_RENDERER_WEBGL)) : name;
}

/**
 * Return when all is drawn that was asked for.
 *
 * Browsers let a page run two pictures ahead. Where the processor draws, that evens out nothing, since page and
 * graphics share it: a flight over the dragon had intervals of 17 and 117 ms in turn, and a visitor's drag showed
 * up to two pictures late. Waiting makes them 67 ms, every one; the longest of a flight came down from 200 ms to
 * 117. A graphics card works beside the page and must not be waited for.
 */
export function waitUntilDrawn(renderer: WebGLRenderer): void {
  const gl = renderer.getContext();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, PIXEL); // finish() only asks
}
const PIXEL = new Uint8Array(4);
