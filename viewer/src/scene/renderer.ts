/** The WebGL2 renderer, or a sentence where there can be none. */
import { WebGLRenderer } from "three";
import { Problem } from "../format/problem";

/** @throws Problem if the browser has no WebGL2. */
export function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const sentence =
    "This browser does not give WebGL2, which the picture needs. Try a current browser, or switch hardware acceleration on.";
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) throw new Problem("webgl", sentence);
  // Where the processor draws, four samples a pixel cost four times as much; smooth motion is worth more.
  const isSoftware = /swiftshader|llvmpipe|software|basic render/i.test(rendererOf(probe));
  probe.getExtension("WEBGL_lose_context")?.loseContext(); // browsers allow few contexts at a time
  try {
    return new WebGLRenderer({ canvas, antialias: !isSoftware, powerPreference: "high-performance" });
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
