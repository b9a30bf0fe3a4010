/** Where a ray through a pixel meets the scene: one pixel of depth, drawn by the GPU from what is shown. */
import {
  Color,
  NearestFilter,
  type PerspectiveCamera,
  type Scene,
  Vector3,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";

export class Picker {
  readonly #target = new WebGLRenderTarget(1, 1, { minFilter: NearestFilter, magFilter: NearestFilter });

  constructor(private readonly renderer: WebGLRenderer) {}

  /**
   * The point under (x, y), or null over the background.
   *
   * @param x, y - Share of the picture's width and height, 0 to 1, from its top left corner.
   * @param scene - All that is visible in it may be hit; it is dressed to draw its depth over the camera's far plane.
   */
  pick(x: number, y: number, scene: Scene, camera: PerspectiveCamera): Vector3 | null {
    const { renderer } = this;
    const clear = renderer.getClearColor(new Color());
    const height = 4096; // of a picture that is only thought of: one pixel of it is drawn
    const width = height * camera.aspect; // three takes the aspect from here
    camera.setViewOffset(width, height, x * width - 0.5, y * height - 0.5, 1, 1);
    renderer.setRenderTarget(this.#target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    renderer.render(scene, camera);
    const bytes = new Uint8Array(4);
    renderer.readRenderTargetPixels(this.#target, 0, 0, 1, 1, bytes);
    renderer.setRenderTarget(null);
    renderer.setClearColor(clear, 1);
    camera.clearViewOffset();
    const share = bytes.reduce((sum, byte, i) => sum + byte / 255 / 255 ** i, 0);
    if (share <= 0) return null;
    return pointAt(x, y, share * camera.far, camera);
  }
}

function pointAt(x: number, y: number, depth: number, camera: PerspectiveCamera): Vector3 {
  const tanY = Math.tan((camera.fov * Math.PI) / 360);
  const point = new Vector3((2 * x - 1) * tanY * camera.aspect, (1 - 2 * y) * tanY, -1).multiplyScalar(depth);
  return point.applyQuaternion(camera.quaternion).add(camera.position);
}
