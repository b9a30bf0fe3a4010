"""What tests of the page share: small scenes, and looking at what is shown."""

import base64
import json
from pathlib import Path

import numpy as np

from foveal.mesh.shapes import bumpy_sphere
from foveal.mesh.trimesh import TriMesh


def coloured_ball(shift=(0.0, 0.0, 0.0)):
    """A closed surface of 20,480 triangles with colours."""
    ball = bumpy_sphere(5)
    colours = np.clip(128 + 90 * ball.positions, 0, 255).astype(np.uint8)
    return TriMesh.of(ball.positions + np.array(shift), ball.faces, colours=colours)


def build(mesh, path):
    from foveal import multires

    multires.build(mesh, path, cell_triangles=1500, workers=2)
    return path


def scene_of(*assets, **more):
    layers = [{"name": Path(asset).stem, "asset": asset, "visible": True} for asset in assets]
    return json.dumps(
        {"version": 1, "title": "A ball with bumps", "layers": layers, "views": [], **more}
    ).encode()


def stats(page):
    return page.evaluate("foveal.stats()")


def idle(page):
    page.evaluate("foveal.idle()")


PIXELS = """async (base64) => {
  const blob = await (await fetch("data:image/png;base64," + base64)).blob();
  const image = await createImageBitmap(blob);
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  let text = "";
  for (let i = 0; i < data.length; i += 8190) text += String.fromCharCode(...data.subarray(i, i + 8190));
  return [image.width, image.height, btoa(text)];
}"""


def picture(page):
    """(h, w, 3) uint8: the canvas as it is on the screen, without the page's panels."""
    style = page.add_style_tag(
        content="#label, #bar, #inset, #toast, #alerts, #progress { visibility: hidden !important }"
    )
    page.evaluate("new Promise(resolve => requestAnimationFrame(() => requestAnimationFrame(resolve)))")
    # without animations: the picture comes in over 0.3 s, and may be settled before
    encoded = base64.b64encode(page.screenshot(animations="disabled")).decode()
    style.evaluate("style => style.remove()")
    width, height, data = page.evaluate(PIXELS, encoded)
    pixels = np.frombuffer(base64.b64decode(data), dtype=np.uint8).reshape(height, width, 4)
    return pixels[..., :3].copy()
